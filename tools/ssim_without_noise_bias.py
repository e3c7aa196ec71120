#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures the error of SSIM* (core/image/metrics.h, ssim_without_noise) with the noise of given references.

    ./fieldcast bench quality --scene sponza --size 640x360 --frames 29 --spp 64 --scored-views --presets default --out q
    ./fieldcast bench flip q    # installs the Python packages
    .cache/bench-python/bin/python tools/ssim_without_noise_bias.py q/quality.json q/default/frame29_r2_c3.exr \
        .cache/references/SCENE/640x360/frame29_row0_col2_halves

The picture itself serves as the truth. Two noisy halves are made from it with the difference of the references' halves,
whose sign is drawn anew for each pixel. Pictures with increasing blur are then compared twice: with the truth, and with
both halves as the benchmark does. Scaling the noise shows the effect of more samples.
"""
import argparse
import json
import pathlib
import sys

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "bench" / "quality"))
import flip

LUMINANCE = numpy.array([0.2126, 0.7152, 0.0722])
BLURS = (0.0, 0.5, 0.8, 1.2)  # standard deviations, pixels
WINDOW = numpy.exp(-0.5 * (numpy.arange(-5, 6) / 1.5) ** 2)
WINDOW /= WINDOW.sum()


def smooth(image, weights):
    """`image` (rows, columns) with a separable filter of odd length."""
    for axis in (0, 1):
        image = numpy.apply_along_axis(numpy.convolve, axis, image, weights, mode="same")
    return image


def blurred(picture, deviation):
    if deviation == 0.0:
        return picture
    weights = numpy.exp(-0.5 * (numpy.arange(-6, 7) / deviation) ** 2)
    return numpy.stack([smooth(picture[..., c], weights / weights.sum()) for c in range(3)], axis=-1)


def ssim(picture, first, second):
    """Mean SSIM of display-referred pictures; the reference's variance is the covariance of its halves, at least 0."""
    x, a, b = (p @ LUMINANCE for p in (picture, first, second))
    y = (a + b) / 2
    mean_x, mean_y = smooth(x, WINDOW), smooth(y, WINDOW)
    variance_x = smooth(x * x, WINDOW) - mean_x**2
    variance_y = numpy.maximum(0.0, smooth(a * b, WINDOW) - smooth(a, WINDOW) * smooth(b, WINDOW))
    covariance = smooth(x * y, WINDOW) - mean_x * mean_y
    means = (2 * mean_x * mean_y + 1e-4) / (mean_x**2 + mean_y**2 + 1e-4)
    structure = (2 * covariance + 9e-4) / (variance_x + variance_y + 9e-4)
    return (means * structure)[5:-5, 5:-5].mean()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("result", help="quality.json of the run, for the exposure")
    parser.add_argument("picture", help="a picture of the run (EXR)")
    parser.add_argument("halves", help="references of the same view: the name without .exr and _second.exr")
    arguments = parser.parse_args()
    exposure = json.loads(pathlib.Path(arguments.result).read_text())["exposure"]
    truth = flip.read_exr(arguments.picture)
    noise = (flip.read_exr(arguments.halves + ".exr") - flip.read_exr(arguments.halves + "_second.exr")) / 2**0.5
    random = numpy.random.default_rng(1)
    shown = flip.display(truth, exposure)
    print("samples  blur  SSIM   SSIM*")
    for samples in (1, 2, 4, 8):
        halves = [flip.display(truth + random.choice([-1, 1], size=truth.shape[:2])[..., None] * noise / samples**0.5,
                               exposure) for _ in range(2)]
        for deviation in BLURS:
            picture = flip.display(blurred(truth, deviation), exposure)
            print(f"{samples:6}x  {deviation:.1f}  {ssim(picture, shown, shown):.3f}  {ssim(picture, *halves):.3f}")


if __name__ == "__main__":
    main()
