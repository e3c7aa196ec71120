# SPDX-License-Identifier: Apache-2.0
"""RMSE and SSIM of `fieldcast-bench compare` against scikit-image, on the same files.

    python3 tests/bench/scikit_image_test.py build/release/bench/fieldcast-bench

Uses the first Python that has scikit-image: the one that runs this, that of `./fieldcast bench flip`, or the system's (Debian:
python3-skimage). Without any it says so and exits with 77, which ctest shows as skipped.
"""
import importlib.util
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
OTHERS = [ROOT / ".cache/bench-python/bin/python", pathlib.Path("/usr/bin/python3")]
SKIPPED = 77


def run_where_scikit_image_is():
    """Goes on only where the package is; replaces this process if another Python has it."""
    if importlib.util.find_spec("skimage"):
        return
    for python in OTHERS:
        if not os.environ.get("FIELDCAST_TRIED") and python.exists() and subprocess.run(
                [python, "-c", "import skimage"], capture_output=True, check=False).returncode == 0:
            os.execve(python, [str(python), "-B", *sys.argv], {**os.environ, "FIELDCAST_TRIED": "1"})
    print("skipped: scikit-image is not installed (python3-skimage, or run `./fieldcast bench flip` once)")
    sys.exit(SKIPPED)


class Metrics(unittest.TestCase):
    """Pictures are 8-bit, so both sides read exactly the same numbers; they then compute in double precision, the program
    from single precision values: 3e-8 of a value near 1, of SSIM up to thirty times that where variances are differences
    of nearly equal numbers."""

    RMSE_TOLERANCE = 1e-7
    SSIM_TOLERANCE = 1e-6
    program = None

    def compare(self, image, reference):
        import skimage.io

        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            skimage.io.imsave(folder / "image.png", image, check_contrast=False)
            skimage.io.imsave(folder / "reference.png", reference, check_contrast=False)
            subprocess.run([self.program, "compare", "image.png", "reference.png", "--json", "scores.json"], cwd=folder,
                           check=True, stdout=subprocess.DEVNULL)
            return json.loads((folder / "scores.json").read_text())

    def expect_agreement(self, image, reference):
        x, y = image / 255.0, reference / 255.0
        scores = self.compare(image, reference)
        self.assertAlmostEqual(scores["rmse"], flip.rmse(x, y), delta=self.RMSE_TOLERANCE)
        self.assertAlmostEqual(scores["ssim"], flip.ssim(x, y), delta=self.SSIM_TOLERANCE)
        return scores

    def test_noise_against_noise(self):
        random = numpy.random.default_rng(1)
        for height, width in ((11, 11), (12, 40), (90, 160)):
            shape = (height, width, 3)
            self.expect_agreement(random.integers(0, 256, shape, numpy.uint8), random.integers(0, 256, shape, numpy.uint8))

    def test_noisy_picture(self):
        y, x = numpy.mgrid[0:180, 0:320]
        edges = 100 + 90 * numpy.sign(numpy.sin(x / 17.0) * numpy.cos(y / 11.0)) + x / 8.0
        reference = numpy.stack([edges, edges * 0.7, 255 - edges], -1).clip(0, 255).astype(numpy.uint8)
        noise = numpy.random.default_rng(2).normal(0.0, 20.0, reference.shape)
        image = (reference + noise).clip(0, 255).astype(numpy.uint8)
        scores = self.expect_agreement(image, reference)
        self.assertTrue(0.1 < scores["ssim"] < 0.9, scores)  # neither trivial case

    def test_equal_and_flat_pictures(self):
        flat = numpy.full((20, 30, 3), 77, numpy.uint8)
        self.assertEqual(1.0, self.expect_agreement(flat, flat)["ssim"])
        self.expect_agreement(flat, numpy.full((20, 30, 3), 200, numpy.uint8))

    def test_sizes_must_match(self):
        import skimage.io

        with tempfile.TemporaryDirectory() as name:
            for side in (20, 21):
                skimage.io.imsave(f"{name}/{side}.png", numpy.zeros((side, 20, 3), numpy.uint8), check_contrast=False)
            done = subprocess.run([self.program, "compare", f"{name}/20.png", f"{name}/21.png"], capture_output=True,
                                  check=False, text=True)
        self.assertEqual(2, done.returncode)
        self.assertIn("20x21", done.stderr)


class Tables(unittest.TestCase):
    """What bench/quality/flip.py does beside FLIP itself."""

    RESULT = {"command": "bench a", "scene": "Hall", "rows": {"ours": {"flip": 0.125}, "svgf": {"flip": 0.25}}}

    def test_flip_column_is_filled_where_the_result_is_meant(self):
        text = 'command,scene,input,flip\nbench a,Hall,ours,\nbench a,Hall,"1, spp",\nbench b,Hall,ours,0.5\nbench a,Barn,ours,\n'
        expected = text.replace("bench a,Hall,ours,", "bench a,Hall,ours,0.125")
        self.assertEqual(expected, flip.fill_csv(text, self.RESULT))

    def test_rows_without_the_scene_have_a_mode_and_a_coding(self):
        rows = [{"mode": "scene", "coding": "zstd"}, {"mode": "warp", "coding": "zstd"}, {"mode": "warp", "coding": "jpeg 75"}]
        pictures = [{"input": "warp zstd", "flip": 0.25}, {"input": "warp zstd", "flip": 0.75}, {"input": "warp jpeg 75", "flip": 1.0}]
        result = {"command": "bench a", "scene": "Hall", "rows": rows, "pictures": pictures}
        flip.add_means(result)
        self.assertEqual([None, 0.5, 1.0], [row.get("flip") for row in rows])
        text = "command,scene,mode,coding,flip\nbench a,Hall,scene,zstd,\nbench a,Hall,warp,zstd,\nbench a,Barn,warp,zstd,\n"
        self.assertEqual(text.replace("Hall,warp,zstd,", "Hall,warp,zstd,0.5"), flip.fill_csv(text, result))

    def test_other_tables_are_refused(self):
        with self.assertRaises(ValueError):
            flip.fill_csv("a,b\n1,2\n", self.RESULT)

    def test_numbers_that_differ_are_reported(self):
        x = numpy.random.default_rng(3).random((16, 16, 3))
        y = numpy.zeros_like(x)
        good = {"file": "a", "rmse": flip.rmse(x, y), "ssim": flip.ssim(x, y)}
        self.assertEqual([], flip.disagreements(good, x, y))
        self.assertEqual(1, len(flip.disagreements({**good, "ssim": good["ssim"] + 1e-4}, x, y)))
        self.assertEqual(2, len(flip.disagreements({**good, "rmse": float("nan"), "ssim": 0.5}, x, y)))


if __name__ == "__main__":
    run_where_scikit_image_is()
    import numpy

    sys.path.insert(0, str(ROOT / "bench" / "quality"))
    import flip

    Metrics.program = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
