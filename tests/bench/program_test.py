# SPDX-License-Identifier: Apache-2.0
"""fieldcast-bench as people call it, on the demo scene at a very small size.

    python3 tests/bench/program_test.py build/release/bench/fieldcast-bench

Without a Vulkan device it says so and exits with 77, which ctest shows as skipped.
"""
import csv
import html.parser
import json
import os
import pathlib
import pty
import select
import signal
import subprocess
import sys
import tempfile
import time
import unittest

SKIPPED = 77
SIZE = ["--size", "48x32"]
INTERRUPTED = 130


def call(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, check=False, text=True)


def read_until(terminal, words, seconds):
    """What comes from a terminal up to and with `words`; less if that takes too long, or its program ends before."""
    said, end = b"", time.monotonic() + seconds
    while words not in said and select.select([terminal], [], [], max(end - time.monotonic(), 0.0))[0]:
        try:
            said += os.read(terminal, 4096)
        except OSError:  # nobody writes to it any more
            break
    return said.decode()


class Outline(html.parser.HTMLParser):
    """Headings of a page; fails if elements do not close in order, or if the page asks for anything."""

    VOID = {"meta", "br", "input", "line"}

    def __init__(self, text):
        super().__init__()
        self.open, self.headings = [], []
        self.feed(text)
        self.close()
        assert not self.open, self.open

    def handle_starttag(self, tag, attrs):
        assert tag not in ("script", "link", "iframe", "img"), tag
        assert not {"src", "href", "srcset"} & {name for name, _ in attrs}, attrs
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        pass

    def handle_endtag(self, tag):
        assert self.open.pop() == tag, tag

    def handle_data(self, data):
        if self.open and self.open[-1] in ("h1", "h2"):
            self.headings.append(data)
        if self.open and self.open[-1] == "style":
            rest = data.replace("url(data:image/png;base64,", "")
            assert "url(" not in rest and "@import" not in rest


class Program(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.references = ["--references", cls.folder / "references", "--spp", 16, *SIZE]

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def expect_good(self, done):
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertIn("invalid samples: 0", done.stdout)

    def expect_user_error(self, done, text):
        self.assertEqual(2, done.returncode, done.stderr)
        self.assertIn(text, done.stderr)

    def table(self, name):
        return list(csv.DictReader((self.folder / name).read_text(encoding="utf-8").splitlines()))

    def headings(self, name):
        return Outline((self.folder / name).read_text(encoding="utf-8")).headings

    def test_codecs(self):
        done = call("codecs", *SIZE, "--frames", 3, "--measured", 2, "--qualities", "30,90", "--json",
                    self.folder / "codecs.json", "--csv", self.folder / "codecs.csv")
        self.assertEqual(0, done.returncode, done.stderr)
        rows = {(row["part"], row["coding"]): row for row in self.table("codecs.csv")}
        parts = ["diffuse", "specular", "light", "depth", "normal", "id", "material", "view"]
        lossless = {(part, coding) for part in parts for coding in ("raw", "zstd", "zstd, key frame")}
        lossy = {(part, f"jpeg {quality}") for part in ("diffuse", "specular", "light", "view") for quality in (30, 90)}
        lossy |= {("view", f"h264 {quality}{alone}") for quality in (30, 90) for alone in ("", " alone")}
        merged = {("total_light", coding) for coding in ("raw", "zstd", "jpeg 30", "jpeg 90")}
        self.assertEqual(lossless | lossy | merged | {("normal", "zstd, oct2x8")}, set(rows))
        number = lambda part, coding, column: float(rows[part, coding][column])
        for part in ("light", "view"):
            self.assertLess(number(part, "jpeg 30", "bytes"), number(part, "jpeg 90", "bytes"))
            self.assertLess(number(part, "jpeg 90", "bytes"), number(part, "raw", "bytes"))
            self.assertLess(number(part, "jpeg 30", "ssim"), number(part, "jpeg 90", "ssim"))
            self.assertLess(number(part, "jpeg 90", "ssim"), 1.0)
            self.assertEqual("", rows[part, "zstd"]["ssim"])
        self.assertEqual(0.0, number("light", "jpeg 30", "discard_points"))  # geometry is what discards
        self.assertTrue(0.98 < number("total_light", "zstd", "ssim") < 1.0)  # measured 0.998 on Sponza
        self.assertEqual(0.0, number("total_light", "jpeg 30", "discard_points"))
        self.assertLess(number("normal", "zstd, oct2x8", "bytes"), number("normal", "zstd", "bytes"))
        turned = json.loads((self.folder / "codecs.json").read_text())["coarse_normals_deg"]
        self.assertTrue(0.0 < turned["mean"] < turned["max"] < 1.0, turned)  # core/image/packing.h has the bound
        light = number("diffuse", "zstd", "bytes") + number("specular", "zstd", "bytes")
        self.assertAlmostEqual(light, number("light", "zstd", "bytes"), delta=light * 1e-4)  # the CSV has six digits
        self.expect_user_error(call("codecs", *SIZE, "--frames", 1, "--measured", 2), "--measured")

    def test_warp(self):
        out = self.folder / "warp"
        done = call("warp", *SIZE, "--grid", "3x3", "--frames", 1, "--qualities", "75", "--out", out, "--csv",
                    self.folder / "warp.csv")
        self.assertEqual(0, done.returncode, done.stderr)
        result = json.loads((out / "warp.json").read_text())
        inputs = [f"{row['mode']} {row['coding']}" for row in result["rows"]]
        self.assertEqual(["scene zstd", "views zstd", "warp zstd", "warp, no residual zstd", "views jpeg 75", "warp jpeg 75",
                          "warp, no residual jpeg 75"], inputs)
        for picture in result["pictures"]:
            self.assertIn(picture["input"], inputs[1:])
            for name in (picture["file"], picture["reference"]):
                self.assertTrue((out / f"{name}.png").exists(), name)
        self.assertEqual(result["view_count"] * 6, len(result["pictures"]))
        self.assertEqual([""] * 7, [row["flip"] for row in self.table("warp.csv")])

    def test_quality_with_everything(self):
        out = self.folder / "out"
        done = call("quality", *self.references, "--presets", "default", "--temporal", "--light-field", "--out", out,
                    "--csv", self.folder / "a.csv", "--html", self.folder / "a.html")
        self.expect_good(done)
        result = json.loads((out / "quality.json").read_text())
        self.assertAlmostEqual(3.1, result["exposure"], places=5)  # bench/scenes/atelier.json
        noisy, ours = result["rows"]["1 spp"], result["rows"]["default"]
        self.assertTrue(0.0 < ours["rmse"] < noisy["rmse"] < 1.0, result["rows"])
        self.assertTrue(0.0 < ours["temporal"]["flicker"] < noisy["temporal"]["flicker"])
        self.assertIsNone(ours["temporal"]["warped_error_excess"])  # no references of the frames before
        self.assertEqual(36, len(ours["light_field"]["views"]))
        self.assertLess(ours["light_field"]["angular_error"], noisy["light_field"]["angular_error"])
        self.assertEqual(2 * 3 * 5, len(result["pictures"]))
        self.check_table(result)
        self.check_pictures(out, result)
        self.assertIn("As a light field", self.headings("a.html"))
        self.check_report(out, result)

    def check_table(self, result):
        rows = self.table("a.csv")
        self.assertEqual(["1 spp", "default"], [row["input"] for row in rows])
        self.assertAlmostEqual(result["rows"]["default"]["rmse"], float(rows[1]["rmse"]), places=5)
        self.assertEqual("", rows[0]["rmse_holes"])
        self.assertEqual("", rows[0]["flip"])

    def check_pictures(self, out, result):
        picture = result["pictures"][-1]
        for name in (picture["file"], picture["reference"]):
            self.assertTrue((out / f"{name}.png").is_file())
        done = call("compare", out / f"{picture['file']}.exr", out / f"{picture['reference']}.exr", "--exposure",
                    result["exposure"], "--json", self.folder / "c.json")
        self.assertEqual(0, done.returncode, done.stderr)
        scores = json.loads((self.folder / "c.json").read_text())
        # The exposure went through text and is multiplied before the clamp instead of within: 1e-7 of a value.
        self.assertAlmostEqual(picture["rmse"], scores["rmse"], places=6)
        self.assertAlmostEqual(picture["ssim"], scores["ssim"], places=5)

    def check_report(self, out, result):
        for picture in result["pictures"]:
            picture["flip"] = 0.25
        for row in result["rows"].values():
            row["flip"] = 0.25
        (out / "quality.json").write_text(json.dumps(result))
        self.assertEqual(0, call("report", out, "--html", self.folder / "b.html").returncode)
        self.assertEqual(self.headings("a.html"), self.headings("b.html"))
        self.assertIn("FLIP", (self.folder / "b.html").read_text())
        (out / "quality.json").write_text('{"rows": {}}')
        self.expect_user_error(call("report", out, "--html", self.folder / "b.html"), "quality.json")

    def test_grids(self):
        self.expect_good(call("grids", *self.references, "--frames", "2,1", "--grids", "1x2,2x2", "--json", self.folder / "g.json", "--csv",
                              self.folder / "g.csv", "--html", self.folder / "g.html"))
        result = json.loads((self.folder / "g.json").read_text())
        self.assertEqual(["1x2", "2x2"], [row["grid"] for row in result["grids"]])
        self.assertEqual([2, 4], [len(row["views"]) for row in result["grids"]])
        self.assertEqual([2], result["frames"])  # of those, the last
        self.assertAlmostEqual(result["grids"][0]["ssim"] - result["grids"][1]["ssim"], result["ssim_lost"])
        self.assertEqual(2, len(self.table("g.csv")))
        self.assertIn("Cost", self.headings("g.html"))

    def test_frame(self):
        done = call("frame", *SIZE, "--grid", "2x2", "--frames", 2, "--warm-up", 1, "--html", self.folder / "f.html")
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertIn("Stages", self.headings("f.html"))

    def test_references_go_on_after_an_interrupt(self):
        folder = self.folder / "interrupted"
        command = ["reference", "--references", str(folder), *SIZE, "--spp"]
        ours, its = pty.openpty()  # on a terminal it tells at once how far it is
        self.addCleanup(os.close, ours)
        with subprocess.Popen([PROGRAM, *command, "1000000"], stdout=subprocess.DEVNULL, stderr=its) as process:
            os.close(its)
            self.assertIn("references: ", read_until(ours, b"references: ", 120.0))
            process.send_signal(signal.SIGINT)
            message = read_until(ours, b"continues from them", 120.0)
            self.assertIn("continues from them", message)
            self.assertEqual(INTERRUPTED, process.wait(timeout=120.0), message)
        sidecars = list(folder.rglob("*.json"))
        self.assertEqual(1, len(sidecars))
        self.assertGreaterEqual(json.loads(sidecars[0].read_text())["samples_per_pixel"], 16)
        before = sidecars[0].stat().st_mtime_ns
        self.assertEqual(0, call(*command, 16).returncode)
        self.assertEqual(2 * 15, len(list(folder.rglob("*.exr"))))  # two halves of each
        self.assertEqual(before, sidecars[0].stat().st_mtime_ns)  # had enough samples
        self.assertEqual([], [path for path in folder.rglob("*") if path.name.endswith(".part")])

    def test_references_may_be_half_as_large(self):
        sizes = []
        for name, flags in (("whole", []), ("half", ["--half"])):
            folder = self.folder / name
            done = call("reference", "--references", folder, *SIZE, "--spp", 32, "--frames", 1, *flags)
            self.assertEqual(0, done.returncode, done.stderr)
            sizes.append(sum(path.stat().st_size for path in folder.rglob("*.exr")))
        self.assertLess(sizes[1], 0.7 * sizes[0])

    def test_bad_input_is_answered(self):
        self.expect_user_error(call("quality", "--scene", "atelie"), "atelier, breakfast_room")
        self.expect_user_error(call("quality", "--light-field", "--scored-views", *SIZE), "--scored-views")
        self.expect_user_error(call("grids", "--grids", "9x9"), "at most 72")
        self.expect_user_error(call("grids", "--preset", "theirs", *SIZE), "expected one of")
        self.expect_user_error(call("quality", "--presets", "theirs", *SIZE), "expected some of")
        self.expect_user_error(call("compare", "no.png", "such.png"), "no.png: cannot be read")


if __name__ == "__main__":
    PROGRAM = str(pathlib.Path(sys.argv.pop(1)).resolve())
    probe = call("frame", *SIZE, "--grid", "1x1", "--frames", 1, "--warm-up", 0)
    if "Vulkan" in probe.stderr and probe.returncode != 0:
        print("skipped:", probe.stderr.strip())
        sys.exit(SKIPPED)
    unittest.main()
