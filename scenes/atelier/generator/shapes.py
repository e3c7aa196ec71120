# SPDX-License-Identifier: Apache-2.0
"""Triangle shapes of the atelier: metres, +Y up, counter-clockwise front faces.

Texture coordinates have v = 0 at the top of the image. Wood textures have their grain along v.
"""

from dataclasses import dataclass, replace

import numpy as np


@dataclass(frozen=True)
class Shape:
    positions: np.ndarray  # (n, 3) float
    normals: np.ndarray  # (n, 3) unit length
    uvs: np.ndarray  # (n, 2)
    triangles: np.ndarray  # (m, 3) int
    colors: np.ndarray | None = None  # (n, 3) linear, multiplies the base colour


def normalized(v):
    v = np.asarray(v, dtype=float)
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-20)


def merged(*shapes):
    """One shape from many. Colours are kept only if every part has them."""
    offsets = np.cumsum([0] + [len(s.positions) for s in shapes[:-1]])
    has_colors = all(s.colors is not None for s in shapes)
    return Shape(
        np.concatenate([s.positions for s in shapes]),
        np.concatenate([s.normals for s in shapes]),
        np.concatenate([s.uvs for s in shapes]),
        np.concatenate([s.triangles + o for s, o in zip(shapes, offsets)]),
        np.concatenate([s.colors for s in shapes]) if has_colors else None,
    )


def moved(shape, offset):
    return replace(shape, positions=shape.positions + np.asarray(offset, dtype=float))


def rotated(shape, axis, degrees):
    """Turns about a coordinate axis (0, 1 or 2) through the origin."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    a, b = (axis + 1) % 3, (axis + 2) % 3
    m = np.eye(3)
    m[a, a], m[a, b], m[b, a], m[b, b] = c, -s, s, c
    return replace(shape, positions=shape.positions @ m.T, normals=shape.normals @ m.T)


def colored(shape, color):
    return replace(shape, colors=np.tile(np.asarray(color, dtype=float), (len(shape.positions), 1)))


def from_grid(positions, normals, uvs):
    """Joins a (rows, cols) grid of vertices; winding follows the normals, slivers at poles are left out."""
    rows, cols = positions.shape[:2]
    index = np.arange(rows * cols).reshape(rows, cols)
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
    tris = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    p, n = positions.reshape(-1, 3), normalized(normals.reshape(-1, 3))
    face = np.cross(p[tris[:, 1]] - p[tris[:, 0]], p[tris[:, 2]] - p[tris[:, 0]])
    backwards = np.einsum("ij,ij->i", face, n[tris].sum(axis=1)) < 0
    tris[backwards] = tris[backwards][:, ::-1]
    return Shape(p, n, uvs.reshape(-1, 2), tris[np.linalg.norm(face, axis=1) > 1e-10])


def surface(point, u_count, v_count, uv_scale=(1, 1)):
    """Samples point(u, v) -> (..., 3) on the unit square; normals are dP/du x dP/dv by differences."""
    v, u = np.meshgrid(np.linspace(0, 1, v_count + 1), np.linspace(0, 1, u_count + 1), indexing="ij")
    step = 1e-4
    inner = np.clip(v, 1e-3, 1 - 1e-3)  # derivatives vanish at poles
    du = point(u + step, inner) - point(u - step, inner)
    dv = point(u, inner + step) - point(u, inner - step)
    return from_grid(point(u, v), np.cross(du, dv), np.stack([u * uv_scale[0], v * uv_scale[1]], -1))


def sphere(radius, u_count=32, v_count=20, displace=None):
    """Ball at the origin; displace(direction) -> factor on the radius."""

    def point(u, v):
        phi, theta = 2 * np.pi * u, np.pi * v
        d = np.stack([np.cos(phi) * np.sin(theta), np.cos(theta), np.sin(phi) * np.sin(theta)], -1)
        return d * radius if displace is None else d * radius * displace(d)[..., None]

    return surface(point, u_count, v_count)


def smooth_profile(points, samples):
    """Catmull-Rom through (radius, height) points. A repeated point makes a crease."""
    p = np.asarray(points, dtype=float)
    p = np.concatenate([2 * p[:1] - p[1:2], p, 2 * p[-1:] - p[-2:-1]])
    t = np.linspace(0, len(p) - 3 - 1e-9, samples)
    i, f = t.astype(int), (t % 1)[:, None]
    a, b, c, d = p[i], p[i + 1], p[i + 2], p[i + 3]
    q = 0.5 * (2 * b + (c - a) * f + (2 * a - 5 * b + 4 * c - d) * f**2 + (3 * b - a - 3 * c + d) * f**3)
    return np.stack([np.maximum(q[:, 0], 0), q[:, 1]], -1)


def lathe(points, sides=40, samples=40, uv_scale=(1, 1)):
    """Turned body about +Y. The profile starts at the bottom centre and runs up the outside."""
    profile = smooth_profile(points, samples)
    tangent = normalized(np.gradient(profile, axis=0))
    angle = np.linspace(0, 2 * np.pi, sides + 1)
    around = np.stack([np.cos(angle), np.zeros_like(angle), np.sin(angle)], -1)
    up = np.array([0.0, 1.0, 0.0])
    p = profile[:, None, :1] * around + profile[:, None, 1:] * up
    n = tangent[:, None, 1:] * around - tangent[:, None, :1] * up
    u, v = np.meshgrid(angle / (2 * np.pi), np.linspace(1, 0, samples))
    return from_grid(p, n, np.stack([u * uv_scale[0], v * uv_scale[1]], -1))


def cylinder(radius, height, sides=24, top_radius=None, bevel=0.004):
    """Closed, slightly bevelled, standing on y = 0."""
    top = radius if top_radius is None else top_radius
    r = [0, radius - bevel, radius - bevel / 3, radius, top, top - bevel / 3, top - bevel, 0]
    y = [0, 0, bevel / 3, bevel, height - bevel, height - bevel / 3, height, height]
    rings = []
    for (r0, y0), (r1, y1) in zip(zip(r, y), zip(r[1:], y[1:])):
        tangent = normalized([r1 - r0, y1 - y0])
        angle = np.linspace(0, 2 * np.pi, sides + 1)
        around = np.stack([np.cos(angle), np.zeros_like(angle), np.sin(angle)], -1)
        p = np.stack([around * r0 + [0, y0, 0], around * r1 + [0, y1, 0]])
        n = np.broadcast_to(around * tangent[1] - np.array([0, tangent[0], 0]), p.shape)
        u = np.tile(angle / (2 * np.pi), (2, 1))
        v = np.array([[-y0 - 0.0], [-y1]]) + np.zeros_like(u)
        rings.append(from_grid(p, n, np.stack([u, v], -1)))
    return merged(*rings)


def tube(path, radius, sides=12, closed=False):
    """Round tube along (n, 3) points; `radius` may be an array. Closed tubes repeat no point."""
    path = np.asarray(path, dtype=float)
    if closed:
        tangent = normalized(np.roll(path, -1, axis=0) - np.roll(path, 1, axis=0))
        first = normalized(np.cross(tangent, path))
    else:
        tangent = normalized(np.gradient(path, axis=0))
        first = np.empty_like(path)
        first[0] = np.cross(tangent[0], np.eye(3)[np.argmin(np.abs(tangent[0]))])
        for i in range(1, len(path)):
            first[i] = first[i - 1] - tangent[i] * np.dot(first[i - 1], tangent[i])
        first = normalized(first)
    second = np.cross(tangent, first)
    if closed:
        path, first, second = (np.concatenate([a, a[:1]]) for a in (path, first, second))
    angle = np.linspace(0, 2 * np.pi, sides + 1)[None, :, None]
    normal = first[:, None] * np.cos(angle) + second[:, None] * np.sin(angle)
    radius = np.broadcast_to(np.asarray(radius, dtype=float), len(path))
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    v, u = np.meshgrid(length, np.linspace(0, 1, sides + 1), indexing="ij")
    return from_grid(path[:, None] + normal * radius[:, None, None], normal, np.stack([u, v], -1))


def torus_knot(p, q, major, minor, radius, steps, sides):
    """Knot about +Z that winds p times around the axis and q times through the hole."""
    t = np.linspace(0, 2 * np.pi, steps, endpoint=False)
    r = major + minor * np.cos(q * t)
    return tube(np.stack([r * np.cos(p * t), r * np.sin(p * t), minor * np.sin(q * t)], -1), radius, sides, closed=True)


def ring(major, minor, steps=64, sides=12):
    """Torus about +Z."""
    t = np.linspace(0, 2 * np.pi, steps, endpoint=False)
    return tube(np.stack([np.cos(t), np.sin(t), 0 * t], -1) * major, minor, sides, closed=True)


def _face_uvs(positions, axis, grain):
    others = [k for k in range(3) if k != axis]
    v_axis = grain if grain in others else (1 if 1 in others else 2)
    u_axis = next(k for k in others if k != v_axis)
    return np.stack([positions[..., u_axis], -positions[..., v_axis]], -1)


def rounded_box(size, radius=0.01, segments=2, grain=1, tile_m=1.0):
    """Box centred at the origin with round edges; texture laid on in metres, grain along one axis."""
    half = np.asarray(size, dtype=float) / 2
    radius = min(radius, *(half * 0.999))
    faces = []
    for axis in range(3):
        a, b = (axis + 1) % 3, (axis + 2) % 3
        corner = lambda h: np.concatenate([np.linspace(-h, radius - h, segments + 1), np.linspace(h - radius, h, segments + 1)])
        for side in (-1, 1):
            p = np.zeros((2 * segments + 2, 2 * segments + 2, 3))
            p[..., a], p[..., b] = corner(half[a])[:, None], corner(half[b])[None, :]
            p[..., axis] = side * half[axis]
            core = np.clip(p, radius - half, half - radius)
            n = normalized(p - core)
            p = core + radius * n
            faces.append(from_grid(p, n, _face_uvs(p, axis, grain) / tile_m))
    return merged(*faces)


def unit_card():
    """Square of one metre facing +Z, the image upright on it."""
    y, x = np.meshgrid([0.5, -0.5], [-0.5, 0.5], indexing="ij")
    p = np.stack([x, y, 0 * x], -1)
    return from_grid(p, np.broadcast_to([0, 0, 1.0], p.shape), np.stack([x + 0.5, 0.5 - y], -1))


def pierced_slab(lo, hi, axis, opening=None, tile_m=2.0):
    """Thick wall with one rectangular opening: closed, and no vertex on another triangle's edge.

    opening: ((lo, hi), (lo, hi)) along the two other axes in ascending order.
    """
    lo, hi = np.asarray(lo, dtype=float), np.asarray(hi, dtype=float)
    a, b = [k for k in range(3) if k != axis]
    cuts_a, cuts_b = [lo[a], hi[a]], [lo[b], hi[b]]
    if opening:
        cuts_a, cuts_b = sorted(cuts_a + list(opening[0])), sorted(cuts_b + list(opening[1]))
    solid = np.zeros((len(cuts_a) + 1, len(cuts_b) + 1), dtype=bool)  # with an empty border
    solid[1:-1, 1:-1] = True
    if opening:
        solid[2, 2] = False
    quads = []

    def quad(ranges, normal_axis, sign):
        p = np.zeros((2, 2, 3))
        free = [k for k in range(3) if k != normal_axis]
        p[..., free[0]], p[..., free[1]] = np.array(ranges[free[0]])[:, None], np.array(ranges[free[1]])[None, :]
        p[..., normal_axis] = ranges[normal_axis]
        uv = _face_uvs(p, normal_axis, 1 if normal_axis != 1 else 2) / tile_m
        quads.append(from_grid(p, np.broadcast_to(np.eye(3)[normal_axis] * sign, p.shape), uv))

    for i, j in np.argwhere(solid):
        span = {a: cuts_a[i - 1 : i + 1], b: cuts_b[j - 1 : j + 1], axis: (lo[axis], hi[axis])}
        for side, sign in ((lo[axis], -1), (hi[axis], 1)):
            quad({**span, axis: side}, axis, sign)
        for k, di, dj, end, sign in ((a, -1, 0, 0, -1), (a, 1, 0, 1, 1), (b, 0, -1, 0, -1), (b, 0, 1, 1, 1)):
            if not solid[i + di, j + dj]:
                quad({**span, k: span[k][end]}, k, sign)
    return merged(*quads)
