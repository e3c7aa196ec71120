#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the demo scene: an artist's studio in the late afternoon (glTF 2.0, metres, +Y up).

    python3 scenes/generate_atelier.py [--out DIR]      default: scenes/atelier beside this script

Needs Python 3.10, numpy and Pillow. The result is deterministic: the glTF and the buffer follow from the
numbers below, the images also from the version of Pillow's JPEG encoder.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

sys.dont_write_bytecode = True  # keeps the scene folder clean
from atelier.generator import shapes as sh
from atelier.generator import textures as tx
from atelier.generator.gltf_writer import GltfWriter
from atelier.generator.palette import Palette

FRAME_COUNT, FRAME_RATE = 30, 30
SPACING_M = 0.036  # about 7.5 px mean disparity per view step at 1280x720
VERTICAL_FOV = 0.7853981633974483
HALF_X, HALF_Z, HEIGHT, WALL = 2.5, 3.5, 3.2, 0.2  # of the room, metres
SUN_DIRECTION = (1.0, -0.62, -0.20)
FRAME_TIMES = np.arange(FRAME_COUNT) / FRAME_RATE


# --- rotations -----------------------------------------------------------------------------------

def turn(axis, degrees):
    """Quaternion (x, y, z, w) about a coordinate axis."""
    half = np.radians(degrees) / 2
    q = np.zeros(4)
    q[axis], q[3] = np.sin(half), np.cos(half)
    return q


def product(a, b):
    """Rotation b, then a."""
    return np.concatenate([a[3] * b[:3] + b[3] * a[:3] + np.cross(a[:3], b[:3]), [a[3] * b[3] - a[:3] @ b[:3]]])


def facing(direction):
    """Quaternion that turns -Z to `direction` without roll."""
    x, y, z = sh.normalized(direction)
    return product(turn(1, np.degrees(np.arctan2(-x, -z))), turn(0, np.degrees(np.arcsin(y))))


# --- the room ------------------------------------------------------------------------------------

def add_room(w, m):
    """Walls enter floor and ceiling by 5 cm, so nothing leaks at their edges. Window left, skylight above."""
    x, z, t, sunk = HALF_X, HALF_Z, WALL, 0.05
    floor = sh.pierced_slab((-x - t, -t, -z - t), (x + t, 0, z + t), 1)
    ceiling = sh.pierced_slab((-x - t, HEIGHT, -z - t), (x + t, HEIGHT + t, z + t), 1, ((0.1, 1.6), (-2.4, -0.9)))
    out = t - 0.02  # outer faces apart from those of floor and ceiling
    left = sh.pierced_slab((-x - out, -sunk, -z - out), (-x, HEIGHT + sunk, z + out), 0, ((0.5, 2.75), (-2.8, 0.4)))
    right = sh.pierced_slab((x, -sunk, -z - out), (x + out, HEIGHT + sunk, z + out), 0)
    far = sh.pierced_slab((-x - 0.1, -sunk, -z - out + 0.02), (x + 0.1, HEIGHT + sunk, -z), 2)
    near = sh.pierced_slab((-x - 0.1, -sunk, z), (x + 0.1, HEIGHT + sunk, z + out - 0.02), 2)
    w.add_node("Floor", mesh=w.add_mesh("Floor", (floor, m["floor"])))
    w.add_node("Walls", mesh=w.add_mesh("Walls", (sh.merged(ceiling, left, right, near), m["plaster"]), (far, m["plaster_sage"])))

    bar = lambda size, at: sh.moved(sh.rounded_box(size, 0.006, 1), at)
    xw = -x - 0.10
    bars = [bar((0.06, 2.31, 0.05), (xw, 1.625, zc)) for zc in (-2.8, -1.733, -0.667, 0.4)]
    bars += [bar((0.05, 0.05, 3.25), (xw, yc, -1.2)) for yc in (0.5, 2.05, 2.75)]
    bars += [bar((0.05, 0.06, 1.55), (0.85, HEIGHT + 0.1, -1.65)), bar((1.55, 0.05, 0.05), (0.85, HEIGHT + 0.1, -1.65))]
    w.add_node("WindowBars", mesh=w.add_mesh("WindowBars", (sh.merged(*bars), m["iron"])))

    sill = bar((0.34, 0.04, 3.5), (-x + 0.02, 0.487, -1.2))
    boards = [bar((0.03, 0.12, 2 * z), (x - 0.014, 0.055, 0)), bar((0.03, 0.12, 2 * z), (-x + 0.014, 0.055, 0)),
              bar((2 * x - 0.03, 0.116, 0.03), (0, 0.055, -z + 0.014)), bar((2 * x - 0.03, 0.116, 0.03), (0, 0.055, z - 0.014))]
    w.add_node("Skirting", mesh=w.add_mesh("Skirting", (sh.merged(sill, *boards), m["white_lacquer"])))

    beam = w.add_mesh("Beam", (sh.rounded_box((2 * x + 0.04, 0.2, 0.16), 0.012, 1, grain=0, tile_m=0.8), m["walnut"]))
    for i, zc in enumerate((-2.62, -0.68, 1.25)):
        w.add_node(f"Beam{i}", mesh=beam, translation=(0, HEIGHT - 0.09, zc))
    door = sh.merged(bar((0.9, 2.1, 0.06), (0, 1.05, 0)), *(bar((0.66, 0.8, 0.09), (0, yc, 0)) for yc in (0.6, 1.55)))
    w.add_node("Door", mesh=w.add_mesh("Door", (door, m["white_lacquer"])), translation=(-1.2, 0, z))


def add_curtains(w, m):
    """Two panels of one mesh, and the rod they hang from."""
    width, height = 0.62, 2.55

    def cloth(u, v):
        wave = np.sin(2 * np.pi * (4.5 * u + 0.08 * np.sin(5 * v))) * (0.022 + 0.035 * v) + 0.012 * np.sin(9 * u + 7 * v)
        return np.stack([wave, height * (1 - v), width * (u - 0.5) * (1 - 0.12 * np.sin(np.pi * v))], -1)

    panel = w.add_mesh("Curtain", (sh.surface(cloth, 64, 28, (3, 12)), m["curtain"]))
    w.add_node("CurtainFar", mesh=panel, translation=(-2.33, 0.33, -2.93))
    w.add_node("CurtainNear", mesh=panel, translation=(-2.33, 0.33, 0.52), rotation=turn(1, 180))
    rod = sh.tube([(-2.33, 2.9, -3.3), (-2.33, 2.9, 0.9)], 0.014, 12)
    ends = [sh.moved(sh.sphere(0.03, 20, 12), (-2.33, 2.9, zc)) for zc in (-3.3, 0.9)]
    w.add_node("CurtainRod", mesh=w.add_mesh("CurtainRod", (sh.merged(rod, *ends), m["brushed_brass"])))


# --- furniture -----------------------------------------------------------------------------------

def table_shape(width, height, depth, leg=0.055):
    top = sh.moved(sh.rounded_box((width, 0.04, depth), 0.01, 2, grain=0, tile_m=0.9), (0, height - 0.02, 0))
    parts = [top]
    for sx in (-1, 1):
        for sz in (-1, 1):
            at = (sx * (width / 2 - leg), (height - 0.03) / 2 - 0.001, sz * (depth / 2 - leg))
            parts.append(sh.moved(sh.rounded_box((leg, height - 0.03, leg), 0.008, 1, tile_m=0.9), at))
    for sz in (-1, 1):
        apron = sh.rounded_box((width - 2 * leg, 0.07, 0.022), 0.004, 1, grain=0, tile_m=0.9)
        parts.append(sh.moved(apron, (0, height - 0.07, sz * (depth / 2 - leg))))
    return sh.merged(*parts)


def add_furniture(w, m):
    w.add_node("Table", mesh=w.add_mesh("Table", (table_shape(1.7, 0.76, 0.8), m["oak"])), translation=(1.35, 0, 0.85))
    w.add_node("Bench", mesh=w.add_mesh("Bench", (table_shape(1.7, 0.40, 0.46), m["walnut"])), translation=(-2.08, 0, -1.85), rotation=turn(1, 90))
    cushion = sh.sphere(1.0, 36, 22, lambda d: (np.abs(d[..., 0]) ** 3.2 + np.abs(d[..., 1] / 0.42) ** 2 + np.abs(d[..., 2]) ** 3.2) ** (-1 / 2.6))
    for name, color, at, pitch in (("CushionOchre", "cloth_ochre", (-2.17, 0.588, -2.38), 68), ("CushionTeal", "cloth_teal", (-2.15, 0.58, -1.48), 62)):
        mesh = w.add_mesh(name, (cushion, m[color]))
        w.add_node(name, mesh=mesh, translation=at, rotation=product(turn(1, 90), turn(0, pitch)), scale=(0.2, 0.2, 0.2))

    seat = sh.moved(sh.lathe([(0, 0), (0.15, 0.004), (0.172, 0.02), (0.165, 0.036), (0.1, 0.034), (0, 0.030)], 32, 16, (2, 1)), (0, 0.45, 0))
    legs = [sh.tube([(0.10 * np.cos(a), 0.462, 0.10 * np.sin(a)), (0.19 * np.cos(a), -0.002, 0.19 * np.sin(a))], (0.017, 0.012), 10) for a in (0.3, 2.394, 4.489)]
    angle = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    hoop = sh.tube(np.stack([0.158 * np.cos(angle), 0 * angle + 0.17, 0.158 * np.sin(angle)], -1), 0.008, 8, closed=True)
    stool = w.add_mesh("Stool", (seat, m["oak"]), (sh.merged(hoop, *legs), m["iron"]))
    for i, (x, z, yaw) in enumerate(((0.62, 0.10, 20), (1.75, 0.05, 75), (0.42, -1.95, 140))):
        w.add_node(f"Stool{i}", mesh=stool, translation=(x, 0, z), rotation=turn(1, yaw))

    rug = sh.moved(sh.rounded_box((2.5, 0.016, 1.9), 0.006, 2), (0, 0.007, 0))
    rug_uv = np.stack([rug.positions[:, 0] / 2.5 + 0.5, rug.positions[:, 2] / 1.9 + 0.5], -1)
    rug = sh.Shape(rug.positions, rug.normals, rug_uv, rug.triangles)
    w.add_node("Rug", mesh=w.add_mesh("Rug", (rug, m["rug"])), translation=(-0.35, 0, -0.85), rotation=turn(1, 4))


def wrapped_canvas(width, height, depth=0.035):
    """Stretched canvas centred at the origin; the picture runs on around the edges."""
    box = sh.rounded_box((width, height, depth), 0.004, 1)
    uv = np.stack([box.positions[:, 0] / width + 0.5, 0.5 - box.positions[:, 1] / height], -1)
    return sh.Shape(box.positions, box.normals, uv, box.triangles)


def add_pictures(w, m):
    wall = -HALF_Z + 0.016
    for name, size, at in (("painting_waves", (0.95, 0.95), (-1.75, 1.62, wall)), ("painting_shapes", (0.60, 0.75), (-0.72, 1.58, wall))):
        title = name.title().replace("_", "")
        w.add_node(title, mesh=w.add_mesh(title, (wrapped_canvas(*size), m[name])), translation=at)

    lean = lambda size, at, tilt, roll=0: sh.moved(sh.rotated(sh.rotated(sh.rounded_box(size, 0.006, 1), 2, roll), 0, tilt), at)
    wood = sh.merged(lean((0.04, 1.85, 0.03), (-0.22, 0.90, 0), -10, -8), lean((0.04, 1.85, 0.03), (0.22, 0.90, 0), -10, 8),
                     lean((0.04, 1.75, 0.03), (0, 0.85, -0.33), 14), lean((0.80, 0.035, 0.09), (0, 0.72, 0.06), -10),
                     lean((0.44, 0.035, 0.025), (0, 1.25, -0.075), -10))
    canvas = sh.moved(sh.rotated(wrapped_canvas(0.78, 0.78), 0, -10), (0, 1.125, 0.0))
    yaw = np.radians(-14)
    c, s = np.cos(yaw), np.sin(yaw)
    matrix = [c, 0, -s, 0, 0, 1, 0, 0, s, 0, c, 0, 0.98, 0, -2.45, 1]  # column by column
    w.add_node("Easel", mesh=w.add_mesh("Easel", (wood, m["oak"]), (canvas, m["painting_hills"])), matrix=matrix)


def vase_meshes(w, m):
    """Glossy vessels by name; each stands on y = 0."""
    bottle = [(0, 0), (0.10, 0), (0.105, 0.01), (0.125, 0.12), (0.10, 0.22), (0.04, 0.28), (0.032, 0.36), (0.045, 0.385), (0.035, 0.38), (0.02, 0.28), (0, 0.26)]
    bowl = [(0, 0), (0.06, 0), (0.065, 0.012), (0.13, 0.05), (0.165, 0.10), (0.16, 0.103), (0.12, 0.06), (0.05, 0.025), (0, 0.02)]
    jar = [(0, 0), (0.07, 0), (0.075, 0.01), (0.10, 0.09), (0.095, 0.16), (0.06, 0.20), (0.07, 0.225), (0.062, 0.22), (0.05, 0.19), (0, 0.05)]
    glass = [(0, 0), (0.034, 0), (0.038, 0.01), (0.038, 0.17), (0.030, 0.20), (0.013, 0.23), (0.013, 0.29), (0.016, 0.295)]
    fade = sh.lathe(bottle, 40, 40)
    height = fade.positions[:, 1:2] / 0.385
    fade = sh.Shape(fade.positions, fade.normals, fade.uvs, fade.triangles, tx.mixed([[0.62, 0.28, 0.08]], [[0.08, 0.33, 0.36]], np.clip(height * 1.4 - 0.2, 0, 1)[:, 0]))
    return {
        "tall": w.add_mesh("VaseTall", (fade, m["glaze_fade"])),
        "blue": w.add_mesh("VaseBlue", (sh.lathe(jar, 44, 36), m["glaze_blue"])),
        "bowl": w.add_mesh("Bowl", (sh.lathe(bowl, 44, 30, (3, 1)), m["stoneware"])),
        "jar": w.add_mesh("Jar", (sh.lathe(jar, 36, 32, (3, 2)), m["stoneware"])),
        "glass": w.add_mesh("Bottle", (sh.lathe(glass, 36, 32), m["bottle_glass"])),
    }


def brush_jar(w, m):
    handles, tips = [], []
    for i, (tilt, yaw, length) in enumerate(((7, 20, 0.28), (9, 110, 0.25), (6, 200, 0.30), (10, 290, 0.26), (3, 330, 0.31))):
        pose = lambda s: sh.moved(sh.rotated(sh.rotated(s, 2, -tilt), 1, yaw), (0, 0.055, 0))
        handles.append(pose(sh.cylinder(0.004, length, 8, 0.006, 0.001)))
        tips.append(pose(sh.moved(sh.sphere(0.011, 12, 10, lambda d: 1 + 0.9 * np.maximum(d[..., 1], 0) ** 2), (0, length + 0.008, 0))))
    return w.add_mesh("Brushes", (sh.merged(*handles), m["oak"]), (sh.merged(*tips), m["walnut"]))


def add_still_life(w, m, vases):
    top = 0.759
    place = lambda name, mesh, x, z, y=top, **more: w.add_node(name, mesh=mesh, translation=(x, y, z), **more)
    place("TableVase", vases["tall"], 1.02, 0.68)
    place("TableBowl", vases["bowl"], 1.50, 0.98)
    place("TableJar", vases["jar"], 0.74, 0.98)
    place("TableBrushes", brush_jar(w, m), 0.74, 0.98)
    place("TableBottle", vases["glass"], 1.34, 0.66)
    steel = w.add_mesh("SteelBall", (sh.sphere(1.0, 52, 34), m["steel"]))
    place("TableBall", steel, 1.16, 1.06, top + 0.069, scale=(0.07, 0.07, 0.07))
    copper = w.add_mesh("CopperBall", (sh.sphere(1.0, 36, 22), m["copper"]))
    for i, (x, z, r) in enumerate(((1.46, 0.97, 0.042), (1.545, 0.99, 0.042), (1.505, 0.915, 0.038))):
        place(f"BowlBall{i}", copper, x, z, top + 0.03 + r, scale=(r, r, r))
    waves = lambda d: 1 + 0.085 * np.sin(6 * d[..., 0] + 2) * np.sin(7 * d[..., 1]) * np.sin(6 * d[..., 2] + 1) + 0.03 * np.sin(14 * d[..., 1] + 5 * d[..., 0])
    place("RedForm", w.add_mesh("RedForm", (sh.sphere(0.16, 90, 56, waves), m["glaze_red"])), 1.72, 0.56, top + 0.147)


def book_mesh(w, m, index, color):
    """Boards, spine and pages; origin at the middle of the foot, spine towards +Z."""
    w_m, h_m, d_m = 0.036, 0.235, 0.165
    parts = [sh.pierced_slab((x, 0, -d_m / 2), (x + 0.004, h_m, d_m / 2), 0) for x in (-w_m / 2, w_m / 2 - 0.004)]
    parts.append(sh.moved(sh.rounded_box((w_m + 0.001, h_m - 0.002, 0.006), 0.002, 1), (0, h_m / 2, d_m / 2)))
    parts.append(sh.pierced_slab((-w_m / 2 + 0.002, h_m * 0.78, d_m / 2), (w_m / 2 - 0.002, h_m * 0.84, d_m / 2 + 0.0036), 2))
    tints = [color, color, color, (0.70, 0.55, 0.22)]
    pages = sh.pierced_slab((-w_m / 2 + 0.003, 0.006, -d_m / 2 + 0.006), (w_m / 2 - 0.003, h_m - 0.006, d_m / 2 - 0.001), 1)
    shape = sh.merged(*(sh.colored(p, c) for p, c in zip(parts, tints)), sh.colored(pages, (0.76, 0.71, 0.60)))
    return w.add_mesh(f"Book{index}", (shape, m["book"]))


def add_shelf(w, m, rng, vases):
    """Against the right wall. Built along x, its back at z = 0, then turned to face the room."""
    width, depth, height, levels = 1.8, 0.32, 2.02, (0.10, 0.58, 1.06, 1.54, 2.0)
    board = lambda size, at, grain: sh.moved(sh.rounded_box(size, 0.004, 1, grain=grain, tile_m=0.9), at)
    parts = [board((0.03, height, depth), (sx * width / 2, height / 2 - 0.001, depth / 2), 1) for sx in (-1, 0, 1)]
    parts += [board((width - 0.02, 0.026, depth - 0.012), (0, y, depth / 2), 0) for y in levels]
    parts.append(board((width, height - 0.06, 0.012), (0, height / 2 + 0.02, 0.007), 1))
    shelf = w.add_node("Shelf", mesh=w.add_mesh("Shelf", (sh.merged(*parts), m["walnut"])), translation=(2.498, 0, -2.05), rotation=turn(1, -90))
    colors = ((0.45, 0.12, 0.09), (0.13, 0.24, 0.36), (0.55, 0.43, 0.20), (0.17, 0.30, 0.20), (0.62, 0.57, 0.48))
    books = [book_mesh(w, m, i, c) for i, c in enumerate(colors)]
    count = 0
    for level, (start, stop) in ((1, (-0.87, -0.35)), (1, (0.04, 0.62)), (2, (-0.55, -0.04)), (2, (0.04, 0.40)), (3, (-0.86, -0.45)), (3, (0.30, 0.86)), (0, (-0.86, -0.10))):
        x = start
        while True:
            scale = rng.uniform((0.7, 0.82, 0.85), (1.45, 1.22, 1.15))
            x += 0.019 * scale[0]
            if x + 0.02 * scale[0] > stop:
                break
            at = (x, levels[level] + 0.012, 0.17 + rng.uniform(-0.01, 0.02))
            w.add_node(f"Book{count:02}", shelf, mesh=books[rng.integers(len(books))], translation=at, scale=scale)
            x, count = x + 0.019 * scale[0] + 0.001, count + 1
    for name, mesh, x, level, s in (("ShelfVase0", "blue", -0.18, 1, 1.0), ("ShelfVase1", "tall", -0.72, 2, 0.95), ("ShelfVase2", "jar", 0.62, 2, 1.1),
                                    ("ShelfVase3", "bowl", -0.22, 3, 0.85), ("ShelfVase4", "blue", 0.15, 3, 1.15), ("ShelfVase5", "jar", 0.45, 0, 1.2),
                                    ("ShelfVase6", "tall", 0.5, 4, 1.1), ("ShelfVase7", "bowl", -0.35, 4, 1.2)):
        w.add_node(name, shelf, mesh=vases[mesh], translation=(x, levels[level] + 0.012, 0.17), scale=(s, s, s))


def add_plant(w, m, rng):
    """Palm in a pot: one frond (stalk and cut-out blade) in many places."""
    pot = sh.lathe([(0, 0), (0.13, 0), (0.14, 0.01), (0.165, 0.18), (0.185, 0.31), (0.20, 0.315), (0.20, 0.36), (0.19, 0.363), (0.175, 0.35), (0.168, 0.31), (0, 0.31)], 40, 40)
    soil = sh.moved(sh.cylinder(0.17, 0.02, 32), (0, 0.305, 0))
    plant = w.add_node("Plant", mesh=w.add_mesh("Pot", (pot, m["terracotta"]), (soil, m["soil"])), translation=(-1.78, -0.001, 0.0))
    bend = lambda s: np.stack([0 * s, 1.15 * np.sin(1.15 * s) / 1.15, 0.62 * (1 - np.cos(1.25 * s))], -1)  # s = metres along the stalk

    def blade(u, v):
        s, side = 1.42 - v * 0.95, (u - 0.5)
        return bend(s) + np.stack([side * 0.46, -0.16 * np.abs(side) * np.ones_like(v), 0.10 * np.abs(side) * np.ones_like(v)], -1)

    stalk = sh.tube(bend(np.linspace(0, 0.75, 12)), np.linspace(0.011, 0.005, 12), 8)
    frond = w.add_mesh("Frond", (stalk, m["stem"]), (sh.surface(blade, 6, 16), m["leaf"]))
    for i in range(15):
        rise = i / 14  # the outer fronds lean out and are the longer ones
        tilt = 34 - 32 * rise + rng.uniform(-4, 4)
        yaw = i * 137.508 + rng.uniform(-10, 10)
        size = rng.uniform(0.88, 1.0) * (0.84 + 0.16 * rise)
        w.add_node(f"Frond{i:02}", plant, mesh=frond, translation=(0.03 * np.sin(i), 0.31, 0.03 * np.cos(i)),
                   rotation=product(turn(1, yaw), turn(0, tilt)), scale=(size, size, size))


def add_lamps(w, m):
    shade = sh.moved(sh.cylinder(0.045, 0.07, 24, 0.02), (0, 0.105, 0))
    cord = sh.tube([(0, 0.16, 0), (0, 1.2, 0)], 0.004, 6)
    lamp = w.add_mesh("Pendant", (sh.sphere(0.115, 28, 18), m["lamp_globe"]), (sh.merged(shade, cord), m["brushed_brass"]))
    for i, (x, y, z) in enumerate(((0.95, 2.02, 0.35), (1.60, 2.15, 0.0))):
        w.add_node(f"Pendant{i}", mesh=lamp, translation=(x, y, z))
    ring = sh.ring(0.24, 0.011, 56, 8)
    pegs = [sh.rotated(sh.cylinder(0.007, 0.04, 8, bevel=0.001), 0, 90)]
    pegs = [sh.moved(pegs[0], (0.24 * np.cos(a), 0.24 * np.sin(a), -0.042)) for a in (0.5, 2.6, 4.71)]
    w.add_node("NeonRing", mesh=w.add_mesh("NeonRing", (ring, m["neon"]), (sh.merged(*pegs), m["iron"])), translation=(0.12, 1.72, -HALF_Z + 0.04))


# --- what moves ----------------------------------------------------------------------------------

def add_sculpture(w, m):
    """Polished knot on a turntable; 80 degrees per loop."""
    plinth = sh.moved(sh.rounded_box((0.42, 0.64, 0.42), 0.012, 2), (0, 0.319, 0))
    w.add_node("Plinth", mesh=w.add_mesh("Plinth", (plinth, m["white_lacquer"])), translation=(-0.42, 0, -0.75))
    disc = sh.cylinder(0.19, 0.035, 64)
    post = sh.moved(sh.cylinder(0.012, 0.14, 16), (0, 0.03, 0))
    knot = sh.moved(sh.torus_knot(2, 3, 0.20, 0.085, 0.046, 288, 24), (0, 0.43, 0))
    mesh = w.add_mesh("Sculpture", (sh.merged(disc, post), m["brushed_brass"]), (knot, m["copper"]))
    node = w.add_node("Turntable", mesh=mesh, translation=(-0.42, 0.638, -0.75), rotation=turn(1, -35))
    w.add_animation("Turntable", (node, "rotation", FRAME_TIMES, [turn(1, -35 + 80 * t / FRAME_TIMES[-1]) for t in FRAME_TIMES]))


def add_mobile(w, m):
    """Three arms below each other, each turning against the one above."""
    petal_shape = sh.sphere(1.0, 24, 16, lambda d: 1 + 0.25 * d[..., 0])
    petals = {c: w.add_mesh(f"Petal{c.title()}", (petal_shape, m[f"petal_{c}"])) for c in ("red", "yellow", "blue")}
    parent, at, tracks = None, (-0.15, HEIGHT, -1.25), []
    plan = ((0.66, 0.56, -0.50, ("red",)), (0.22, 0.34, -0.38, ("yellow",)), (0.20, 0.26, -0.30, ("blue", "red")))
    for i, (drop, left, right, colors) in enumerate(plan):
        arm = np.linspace(0, 1, 13)
        path = np.stack([right + (left - right) * arm, -drop - 0.05 + 0.05 * np.sin(np.pi * arm), 0 * arm], -1)
        wires = [sh.tube([(0, 0.002, 0), (0, -drop, 0)], 0.0025, 6), sh.tube(path, 0.0045, 8)]
        ends = [left] if len(colors) == 1 else [left, right]
        wires += [sh.tube([(x, -drop - 0.05, 0), (x, -drop - 0.12, 0)], 0.0025, 6) for x in ends]
        mesh = w.add_mesh(f"MobileArm{i}", (sh.merged(*wires), m["iron"]))
        yaw, swing = (-25, 30, -30)[i], (45, -75, 90)[i]
        node = w.add_node("Mobile" if i == 0 else f"Mobile{i}", parent, mesh=mesh, translation=at, rotation=turn(1, yaw))
        tracks.append((node, "rotation", FRAME_TIMES, [turn(1, yaw + swing * t / FRAME_TIMES[-1]) for t in FRAME_TIMES]))
        for x, color in zip(ends, colors):
            size = np.array([0.150, 0.105, 0.012]) * (1 - 0.13 * i)
            w.add_node(f"Petal{i}{color.title()}", node, mesh=petals[color], translation=(x, -drop - 0.115 - size[1], 0), scale=size)
        parent, at = node, (right, -drop - 0.05, 0)
    w.add_animation("Mobile", *tracks)


def add_light_and_cameras(w):
    w.use_extension("KHR_lights_punctual")
    sun = {"type": "directional", "name": "Sun", "color": [1.0, 0.90, 0.76], "intensity": 12.0}
    w.document["extensions"] = {"KHR_lights_punctual": {"lights": [sun]}}
    w.add_node("Sun", translation=(-6, 5, 0), rotation=facing(SUN_DIRECTION), extensions={"KHR_lights_punctual": {"light": 0}})
    lens = {"aspectRatio": 16 / 9, "yfov": VERTICAL_FOV, "znear": 0.05}
    s = FRAME_TIMES / FRAME_TIMES[-1]
    eyes = np.stack([0.62 - 0.42 * s, 1.46 + 0.05 * np.sin(np.pi * s), 2.95 - 0.22 * s + 0.05 * np.sin(np.pi * s)], -1)
    looks = [facing(np.array([-0.05 + 0.05 * k, 1.16, -1.2]) - eye) for eye, k in zip(eyes, s)]
    camera = w.add("cameras", {"type": "perspective", "name": "LightField", "perspective": lens})
    node = w.add_node("LightField", camera=camera, translation=eyes[0], rotation=looks[0], extras={"fieldcast": {"spacing_m": SPACING_M}})
    w.add_animation("LightField", (node, "translation", FRAME_TIMES, eyes), (node, "rotation", FRAME_TIMES, looks))
    eye = np.array([2.2, 2.65, 3.2])
    camera = w.add("cameras", {"type": "perspective", "name": "Overview", "perspective": {**lens, "yfov": 1.0471975511965976}})
    w.add_node("Overview", camera=camera, translation=eye, rotation=facing(np.array([-0.5, 0.75, -1.1]) - eye))


def build():
    rng = np.random.Generator(np.random.PCG64(20))
    w = GltfWriter("generate_atelier.py")
    m = Palette(w, rng)
    add_light_and_cameras(w)
    add_room(w, m)
    add_curtains(w, m)
    add_furniture(w, m)
    add_pictures(w, m)
    vases = vase_meshes(w, m)
    add_still_life(w, m, vases)
    add_shelf(w, m, rng, vases)
    add_plant(w, m, rng)
    add_lamps(w, m)
    add_sculpture(w, m)
    add_mobile(w, m)
    return w


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path(__file__).resolve().parent / "atelier")
    arguments = parser.parse_args()
    writer = build()
    writer.save(arguments.out, "atelier")
    print(f"{writer.triangle_count():,} triangles in {len(writer.document['nodes'])} nodes -> {arguments.out}")


if __name__ == "__main__":
    main()
