#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders the box of tests/render/test_scenes.cpp (cornell_box) with Mitsuba 3 into an EXR.

    python3 -m venv venv && venv/bin/pip install mitsuba
    venv/bin/python tools/make_cornell_reference.py tests/data/render/cornell_mitsuba.exr

Rays go through pixel centres, as in Fieldcast, so the integrator is called ray by ray instead of through a film.
Paths have eight bounces (Mitsuba counts the edges: 9). The metal is GGX without multiple scattering; at this roughness
that is 0.6 % of its light.
"""
import argparse
import math

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")
T = mi.ScalarTransform4f


def rgb(r, g, b):
    return {"type": "rgb", "value": [r, g, b]}


def diffuse(r, g, b):
    return {"type": "diffuse", "reflectance": rgb(r, g, b)}


def wall(centre, u, v, bsdf):
    """Corners centre ± u ± v, seen from cross(u, v); Mitsuba's rectangle spans ±1 in x and y and faces +z."""
    n = np.cross(u, v)
    m = np.eye(4)
    m[:3, 0], m[:3, 1], m[:3, 2], m[:3, 3] = u, v, n / np.linalg.norm(n), centre
    return {"type": "rectangle", "to_world": T(m), "bsdf": bsdf}


def cube(centre, angle, half, bsdf):
    to_world = T().translate(centre).rotate([0, 1, 0], math.degrees(angle)).scale(half)
    return {"type": "cube", "to_world": to_world, "bsdf": bsdf}


def cornell_box(size_px):
    white = diffuse(0.7, 0.7, 0.7)
    light = wall([0, 0.99, 0], [0.4, 0, 0], [0, 0, 0.4], diffuse(0, 0, 0))
    light["emitter"] = {"type": "area", "radiance": rgb(12, 10, 7)}
    metal = {"type": "roughconductor", "distribution": "ggx", "material": "none", "alpha": 0.1}
    return {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": 9, "rr_depth": 1000},
        "sensor": {
            "type": "perspective",
            "fov": 39.3,
            "fov_axis": "y",
            "to_world": T().look_at([0.06, 0.03, 3.9], [0.02, 0.01, 0], [0, 1, 0]),
            "film": {"type": "hdrfilm", "width": size_px, "height": size_px, "rfilter": {"type": "box"}},
        },
        "floor": wall([0, -1, 0], [1, 0, 0], [0, 0, -1], white),
        "ceiling": wall([0, 1, 0], [1, 0, 0], [0, 0, 1], white),
        "back": wall([0, 0, -1], [1, 0, 0], [0, 1, 0], white),
        "left": wall([-1, 0, 0], [0, 0, -1], [0, 1, 0], diffuse(0.6, 0.06, 0.05)),
        "right": wall([1, 0, 0], [0, 0, 1], [0, 1, 0], diffuse(0.12, 0.45, 0.1)),
        "light": light,
        "tall": cube([-0.35, -0.4, -0.35], 0.3, [0.3, 0.6, 0.3], metal),
        "low": cube([0.4, -0.7, 0.3], -0.3, [0.3, 0.3, 0.3], white),
    }


def render(size_px, samples, passes):
    """Mean of all samples, and its standard error from the spread of the passes."""
    scene = mi.load_dict(cornell_box(size_px))
    sensor, integrator = scene.sensors()[0], scene.integrator()
    sampler = mi.load_dict({"type": "independent"})
    image = np.zeros((passes, size_px, size_px, 3))
    for seed in range(passes):
        sampler.seed(seed)
        for y, x in np.ndindex(size_px, size_px):
            centre = mi.Point2f((x + 0.5) / size_px, (y + 0.5) / size_px)
            ray, _ = sensor.sample_ray_differential(0, 0, centre, mi.Point2f(0.5))
            total = mi.Color3f(0)
            for _ in range(samples):
                total += integrator.sample(scene, sampler, ray)[0]
            image[seed, y, x] = np.array(total) / samples
    return image.mean(axis=0), image.std(axis=0, ddof=1) / math.sqrt(passes)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("output")
    parser.add_argument("--size", type=int, default=48, help="pixels")
    parser.add_argument("--samples", type=int, default=128, help="per pixel and pass")
    parser.add_argument("--passes", type=int, default=16)
    options = parser.parse_args()
    image, error = render(options.size, options.samples, options.passes)
    print(f"mean {image.mean(axis=(0, 1))}, mean standard error of a pixel {error.mean(axis=(0, 1))}")
    bitmap = mi.Bitmap(np.ascontiguousarray(image.astype(np.float32)))
    bitmap.write(options.output)


if __name__ == "__main__":
    main()
