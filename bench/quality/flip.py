# SPDX-License-Identifier: Apache-2.0
"""Adds FLIP to a result of `fieldcast-bench quality|warp --out FOLDER`, and checks its RMSE and SSIM with scikit-image.

FLIP estimates the difference that people see when they alternate between two images: Andersson, Nilsson,
Akenine-Möller, Oskarsson, Åström, Fairchild. FLIP: A Difference Evaluator for Alternating Images. HPG 2020. 0 is no
difference, 1 the largest. The assumed resolution is 67 pixels per degree: 0.7 m from a display with a width of
3840 pixels and 0.7 m.

Packages: requirements.txt. `./fieldcast bench flip FOLDER` installs them into .cache/bench-python and runs this.
"""
import argparse
import csv
import io
import json
import os
import pathlib
import sys
import tempfile
import time

import numpy

PIXELS_PER_DEGREE = 67.0
# The program computes in double precision from single precision pixels; here the sRGB curve is evaluated in double
# precision, which differs from the program's by 1e-7 per pixel at most.
RMSE_TOLERANCE = 1e-6
SSIM_TOLERANCE = 1e-5


def read_exr(path):
    """Linear RGB, height x width x 3, single precision."""
    import OpenEXR

    with OpenEXR.File(str(path)) as file:
        channels = file.channels()
        if "RGB" in channels:
            return numpy.asarray(channels["RGB"].pixels, numpy.float32)
        return numpy.stack([numpy.asarray(channels[name].pixels, numpy.float32) for name in "RGB"], -1)


def display(linear, exposure):
    """clamp(exposure * linear, 0, 1) through the sRGB curve (IEC 61966-2-1), as the program displays pictures."""
    x = numpy.clip(linear.astype(numpy.float64) * exposure, 0.0, 1.0)
    return numpy.where(x <= 0.0031308, 12.92 * x, 1.055 * numpy.power(x, 1.0 / 2.4) - 0.055)


def read_png(path):
    """Display-referred, 0 to 1, height x width x 3, double precision."""
    from skimage import io as files

    return files.imread(str(path))[..., :3] / 255.0


def shown(folder, name, result):
    """The display-referred picture: pictures of `quality` are linear, those of `warp` are display-referred already."""
    if "exposure" in result:
        return display(read_exr(folder / f"{name}.exr"), result["exposure"])
    return read_png(folder / f"{name}.png")


def rows_by_input(result):
    """Rows by input: rows of `quality` are named after it, those of `warp` by mode and coding."""
    rows = result["rows"]
    return rows if isinstance(rows, dict) else {f"{row['mode']} {row['coding']}": row for row in rows}


def rmse(image, reference):
    return float(numpy.sqrt(numpy.mean((image - reference) ** 2)))


def ssim(image, reference):
    """SSIM of the Rec. 709 luma, with the parameters of Wang et al. 2004."""
    from skimage.metrics import structural_similarity

    luma = numpy.array([0.2126, 0.7152, 0.0722])
    return float(structural_similarity(image @ luma, reference @ luma, gaussian_weights=True, sigma=1.5,
                                       use_sample_covariance=False, data_range=1.0))


def flip(image, reference):
    """Mean LDR-FLIP of display-referred images."""
    import flip_evaluator

    _, mean, _ = flip_evaluator.evaluate(reference.astype(numpy.float32), image.astype(numpy.float32), "LDR",
                                         inputsRGB=True, applyMagma=False, computeMeanError=True,
                                         parameters={"ppd": PIXELS_PER_DEGREE})
    return float(mean)


def disagreements(picture, image, reference):
    """Differences between the numbers of the program and scikit-image's, as texts."""
    found = []
    for name, ours, tolerance in (("rmse", rmse, RMSE_TOLERANCE), ("ssim", ssim, SSIM_TOLERANCE)):
        expected = ours(image, reference)
        if not abs(picture[name] - expected) <= tolerance:
            found.append(f"{picture['file']}: {name} is {picture[name]:.8f}, scikit-image says {expected:.8f}")
    return found


def replace_file(path, text):
    """Writes a file that appears complete or not at all."""
    handle, part = tempfile.mkstemp(dir=path.parent or ".", prefix="." + path.name)
    with os.fdopen(handle, "w", encoding="utf-8", newline="") as file:
        file.write(text)
    os.chmod(part, 0o644)
    os.replace(part, path)


def show_progress(done, total, began):
    left = (time.monotonic() - began) / done * (total - done)
    end = "\n" if done == total else ""
    if sys.stderr.isatty():
        print(f"\rFLIP: {100 * done // total} %, {left / 60:.0f} min left   ", end=end, file=sys.stderr, flush=True)
    elif done == total:
        print(f"FLIP: {total} pictures", file=sys.stderr)


def evaluate(folder, result):
    """Adds "flip" to every picture; returns the differences between program and scikit-image."""
    found = []
    references = {}
    began = time.monotonic()
    for done, picture in enumerate(result["pictures"], 1):
        name = picture["reference"]
        if name not in references:
            references[name] = shown(folder, name, result)
        image = shown(folder, picture["file"], result)
        found += disagreements(picture, image, references[name])
        picture["flip"] = flip(image, references[name])
        show_progress(done, len(result["pictures"]), began)
    return found


def add_means(result):
    """Adds "flip", the mean over its pictures, to every row of the table that has pictures."""
    for name, row in rows_by_input(result).items():
        errors = [picture["flip"] for picture in result["pictures"] if picture["input"] == name]
        if errors:
            row["flip"] = float(numpy.mean(errors))


def fill_csv(text, result):
    """The table with a filled flip column in the lines of this result, which have the same command, scene and input."""
    table = list(csv.DictReader(io.StringIO(text)))
    if not table or "flip" not in table[0]:
        raise ValueError("no column flip: expected a table of `fieldcast-bench quality|warp --csv`")
    rows = rows_by_input(result)
    for line in table:
        row = rows.get(line["input"] if "input" in line else f"{line['mode']} {line['coding']}", {})
        if line["command"] == result["command"] and line["scene"] == result["scene"] and "flip" in row:
            line["flip"] = f"{row['flip']:.6g}"
    out = io.StringIO()
    writer = csv.DictWriter(out, table[0].keys(), lineterminator="\n")
    writer.writeheader()
    writer.writerows(table)
    return out.getvalue()


def print_table(rows):
    print(f"{'input':<26}{'RMSE':>10}{'SSIM':>10}{'FLIP':>10}")
    for name, row in rows.items():
        if "flip" in row:
            print(f"{name:<26}{row['rmse']:>10.4f}{row['ssim']:>10.4f}{row['flip']:>10.4f}")


def run(arguments):
    files = [arguments.folder / name for name in ("quality.json", "warp.json")]
    file = next((file for file in files if file.exists()), files[0])
    result = json.loads(file.read_text(encoding="utf-8"))
    problems = evaluate(arguments.folder, result)
    add_means(result)
    print_table(rows_by_input(result))
    replace_file(file, json.dumps(result, indent=2, ensure_ascii=False) + "\n")
    if arguments.csv:
        replace_file(arguments.csv, fill_csv(arguments.csv.read_text(encoding="utf-8"), result))
    if problems:
        print("\n".join(problems[:10]), file=sys.stderr)
        print(f"fieldcast: {len(problems)} numbers differ from those of scikit-image", file=sys.stderr)
        return 1
    print(f"RMSE and SSIM of {len(result['pictures'])} pictures agree with scikit-image")
    return 0


def main():
    parser = argparse.ArgumentParser(prog="./fieldcast bench flip", description=__doc__.split("\n\n")[0],
                                     epilog="Writes the numbers into FOLDER/quality.json or FOLDER/warp.json.")
    parser.add_argument("folder", type=pathlib.Path, help="Folder of `quality --out FOLDER` or `warp --out FOLDER`.")
    parser.add_argument("--csv", type=pathlib.Path, help="Also fill the flip column of this table of `--csv`.")
    try:
        return run(parser.parse_args())
    except (OSError, ValueError, KeyError) as error:
        print(f"./fieldcast bench flip: {error}: expected a folder that `quality --out` or `warp --out` wrote", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("\ninterrupted: nothing was written", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
