# SPDX-License-Identifier: Apache-2.0
"""Procedural images of the atelier: float arrays (height, width, channels), sRGB encoded unless they are data."""

import numpy as np


def noise(rng, shape, cycles, falloff=1.0):
    """Tileable noise, zero mean and unit deviation. `cycles` = highest frequencies (vertical, horizontal) per image."""
    fy = np.fft.fftfreq(shape[0])[:, None] * shape[0] / cycles[0]
    fx = np.fft.rfftfreq(shape[1])[None, :] * shape[1] / cycles[1]
    f = np.sqrt(fx**2 + fy**2)
    f[0, 0] = 1
    spectrum = np.fft.rfft2(rng.standard_normal(shape)) * np.exp(-(f**2)) / (f + 0.05) ** falloff
    spectrum[0, 0] = 0
    n = np.fft.irfft2(spectrum, s=shape)
    return n / n.std()


def mixed(a, b, t):
    t = np.clip(t, 0, 1)
    t = t[..., None] if np.ndim(t) else t
    return np.asarray(a, dtype=float) * (1 - t) + np.asarray(b, dtype=float) * t


def step(edge, x, width=0.01):
    return np.clip((x - edge) / width + 0.5, 0, 1)


def normal_map(height, strength):
    """Tangent-space normals of a tileable height field, +Y towards the top of the image."""
    dx = (np.roll(height, -1, 1) - np.roll(height, 1, 1)) * strength
    dy = (np.roll(height, -1, 0) - np.roll(height, 1, 0)) * strength
    n = np.stack([-dx, dy, np.ones_like(height)], -1)
    return n / np.linalg.norm(n, axis=-1, keepdims=True) * 0.5 + 0.5


def halved(image):
    return (image[::2, ::2] + image[1::2, ::2] + image[::2, 1::2] + image[1::2, 1::2]) / 4


def rough_metal(roughness, metallic=0.0):
    """glTF packing: roughness in green, metalness in blue."""
    return np.stack([np.ones_like(roughness), roughness, np.full_like(roughness, metallic)], -1)


def planks(rng, size=1024, count=16):
    """Floor boards along the image's height: colour, roughness and normals."""
    width = size // count
    y, x = np.mgrid[0:size, 0:size]
    board = x // width
    joint = rng.integers(0, size, count)[board]
    along = (y - joint) % size
    half = (along >= size * 5 // 9).astype(int)
    tone = rng.normal(0, 1, (count, 2))[board, half]
    hue = rng.normal(0, 1, (count, 2))[board, half]
    slide = rng.integers(0, size, (count, 2))[board, half]
    grain = noise(rng, (size, size), (5, 160), 0.6)[(y + slide) % size, (x + slide) % size]
    rings = noise(rng, (size, size), (2.5, 40), 1.0)[(y + slide) % size, (x + slide) % size]
    figure = 0.5 + 0.5 * np.sin(rings * 7) * 0.8 + 0.22 * grain
    color = mixed([0.50, 0.345, 0.215], [0.70, 0.53, 0.36], 0.48 + 0.16 * tone + 0.30 * (figure - 0.5))
    color = color * (1 + 0.025 * hue[..., None] * np.array([1, 0, -1.2]))
    side = np.minimum(x % width, width - 1 - x % width)
    end = np.minimum(along, (along - size * 5 // 9) % size)
    gap = np.clip(np.minimum(side, np.minimum(end, (-along - 1) % size) + 0.5) / 2.2, 0, 1)
    color = color * (0.35 + 0.65 * gap[..., None])
    roughness = np.clip(0.36 + 0.05 * grain - 0.05 * tone + 0.3 * (1 - gap) + 0.05 * noise(rng, (size, size), (9, 9)), 0.18, 0.9)
    height = gap * 1.2 + 0.05 * figure + 0.035 * grain
    return color, halved(rough_metal(roughness)), halved(normal_map(height, 0.5))


def wood(rng, size=512):
    """Oiled board without joints, grain along the image's height."""
    rings = noise(rng, (size, size), (1.6, 9), 1.2)
    grain = noise(rng, (size, size), (4, 120), 0.5)
    figure = 0.5 + 0.42 * np.sin(rings * 9) + 0.2 * grain
    return mixed([0.43, 0.27, 0.155], [0.68, 0.49, 0.31], figure)


def plaster(rng, size=512):
    trowel = noise(rng, (size, size), (14, 22), 1.2)
    fine = noise(rng, (size, size), (120, 120), 0.3)
    color = np.array([0.885, 0.868, 0.835]) * (1 + 0.016 * noise(rng, (size, size), (5, 5)) + 0.012 * trowel + 0.006 * fine)[..., None]
    return color, normal_map(trowel * 0.5 + fine * 0.12, 0.55)


def weave(rng, size=256, threads=48):
    """Cloth: colour near white (tinted by the material) and normals."""
    y, x = np.mgrid[0:size, 0:size] / size * threads
    over = ((x.astype(int) + y.astype(int)) % 2).astype(float)
    bump = over * np.sin(np.pi * (x % 1)) + (1 - over) * np.sin(np.pi * (y % 1))
    color = np.ones(3) * (0.78 + 0.14 * bump + 0.03 * noise(rng, (size, size), (40, 40)))[..., None]
    return color, normal_map(bump, 0.28)


def speckle(rng, size=256):
    """Stoneware glaze with iron spots."""
    spots = step(2.5, noise(rng, (size, size), (60, 60), 0.2), 0.5)
    cloud = noise(rng, (size, size), (6, 6))
    return mixed(mixed([0.86, 0.83, 0.76], [0.80, 0.78, 0.73], 0.5 + 0.3 * cloud), [0.33, 0.24, 0.18], spots)


def brushed(rng, size=256):
    return rough_metal(np.clip(0.2 + 0.05 * noise(rng, (size, size), (3, 70), 0.4), 0.08, 0.5), 1.0)


def rug(rng, size=512):
    """One tile of a kilim: stepped diamonds between zigzag borders."""
    y, x = np.mgrid[0:size, 0:size] / size
    quantized = lambda t, n: np.floor(t * n) / n
    diamond = np.abs(quantized(x, 32) - 0.5 + 1 / 64) + np.abs(quantized(y, 32) - 0.5 + 1 / 64)
    color = mixed([0.58, 0.17, 0.13], [0.58, 0.17, 0.13], 0.0) * np.ones((size, size, 1))
    for limit, tint in ((0.47, [0.16, 0.20, 0.33]), (0.41, [0.84, 0.76, 0.62]), (0.35, [0.77, 0.47, 0.18]),
                        (0.25, [0.55, 0.15, 0.13]), (0.17, [0.84, 0.76, 0.62]), (0.11, [0.18, 0.36, 0.37])):
        color = mixed(color, tint, (diamond < limit).astype(float))
    zigzag = np.abs((quantized(x, 64) * 8) % 1 - 0.5) * 0.06
    edge = np.minimum(y, 1 - y)
    color = mixed(color, [0.16, 0.20, 0.33], (edge < 0.05 + zigzag).astype(float))
    color = mixed(color, [0.84, 0.76, 0.62], (edge < 0.018 + zigzag).astype(float))
    knots = 0.5 + 0.5 * np.sin(2 * np.pi * y * 128) * np.sin(2 * np.pi * x * 64)
    return color * (0.82 + 0.14 * knots + 0.05 * noise(rng, (size, size), (90, 30), 0.3))[..., None]


def frond(rng, height=512, width=256):
    """Palm leaf, tip at the top: colour bled past the outline, coverage in alpha."""
    y, x = np.mgrid[0:height, 0:width]
    s, t = (x + 0.5) / width * 2 - 1, 1 - (y + 0.5) / height
    reach = 0.97 * np.sin(np.pi * np.clip(t * 0.93 + 0.06, 0, 1) ** 0.8) ** 0.75
    side = np.abs(s)
    leaflet = ((t - side * 0.30 + 0.012 * np.sign(s)) * 17) % 1
    taper = 0.44 * np.sqrt(np.clip(1 - side / np.maximum(reach, 1e-3), 0, 1)) + 0.02
    blade = (np.abs(leaflet - 0.5) < taper) & (side < reach) & (t - side * 0.30 > 0.0)
    rib = side < 0.022 * (1.3 - t)
    shade = 0.5 + 0.25 * noise(rng, (height, width), (9, 9)) + 0.9 * (np.abs(leaflet - 0.5) - 0.25)
    color = mixed([0.13, 0.30, 0.10], [0.37, 0.52, 0.19], shade)
    color = mixed(color, [0.55, 0.60, 0.30], (side < 0.03).astype(float))
    return np.concatenate([color, (blade | rib)[..., None].astype(float)], -1)


def _canvas(rng, color):
    height, width = color.shape[:2]
    strokes = noise(rng, (height, width), (30, 90), 0.6)
    return color * (1 + 0.045 * strokes)[..., None]


def painting_hills(rng, height=512, width=512):
    """Evening hills in layers."""
    y, x = np.mgrid[0:height, 0:width]
    y, x = y / height, x / width
    color = mixed([0.93, 0.66, 0.42], [0.36, 0.50, 0.66], 1 - y * 1.5)
    color = mixed(color, [0.97, 0.90, 0.70], step(0, 0.11 - np.hypot(x - 0.64, y - 0.36), 0.008))
    tints = ([0.76, 0.50, 0.45], [0.58, 0.38, 0.43], [0.36, 0.31, 0.42], [0.20, 0.26, 0.34], [0.11, 0.17, 0.20])
    for i, tint in enumerate(tints):
        ridge = 0.44 + 0.11 * i + (0.05 - 0.005 * i) * np.sin(x * (5 + 2 * i) + 2.1 * i) + 0.02 * np.sin(x * (17 + 5 * i) + i)
        color = mixed(color, tint, step(0, y - ridge, 0.006))
    return _canvas(rng, color)


def painting_shapes(rng, height=480, width=384):
    """Discs, bars and arcs on cream."""
    y, x = np.mgrid[0:height, 0:width] / width
    color = np.ones((height, width, 1)) * np.array([0.90, 0.85, 0.74])
    bar = lambda angle, offset: np.abs(x * np.cos(angle) + y * np.sin(angle) - offset)
    color = mixed(color, [0.20, 0.33, 0.48], step(0, 0.30 - np.hypot(x - 0.36, y - 0.78)))
    color = mixed(color, [0.80, 0.26, 0.17], step(0, 0.21 - np.hypot(x - 0.62, y - 0.40)))
    color = mixed(color, [0.88, 0.64, 0.20], step(0, 0.19 - np.hypot(x - 0.68, y - 0.92)) * step(0, y - 0.92))
    color = mixed(color, [0.12, 0.12, 0.14], step(0, 0.012 - np.abs(np.hypot(x - 0.36, y - 0.78) - 0.38)) * step(0, x - 0.36))
    for angle, offset, half in ((0.5, 0.62, 0.014), (-0.65, -0.25, 0.02), (1.35, 1.02, 0.008)):
        color = mixed(color, [0.12, 0.12, 0.14], step(0, half - bar(angle, offset)))
    return _canvas(rng, color)


def painting_waves(rng, height=512, width=512):
    """Marbled blues and ochres."""
    flow = noise(rng, (height, width), (2.2, 3), 1.2) + 0.12 * noise(rng, (height, width), (9, 9), 1.0)
    band = (flow * 0.8) % 1
    palette = np.array([[0.12, 0.26, 0.40], [0.20, 0.47, 0.56], [0.83, 0.80, 0.70], [0.84, 0.60, 0.28], [0.12, 0.26, 0.40]])
    color = np.stack([np.interp(band, np.linspace(0, 1, 5), palette[:, k]) for k in range(3)], -1)
    return _canvas(rng, color)
