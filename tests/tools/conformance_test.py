# SPDX-License-Identifier: Apache-2.0
"""tools/conformance.py with the real server on files of its own, and with a server that misbehaves.

    python3 tests/tools/conformance_test.py build/release/server/fieldcast-server [Opening Misbehaviour | Rendering]

Opening and Misbehaviour need no device. Rendering without a Vulkan device says so and exits with 77, which ctest shows
as skipped.
"""
import html.parser
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest

import scene_files

ROOT = pathlib.Path(__file__).resolve().parents[2]
TOOL = ROOT / "tools/conformance.py"
SKIPPED, INTERRUPTED = 77, 130
LONG_S = 600  # for everything that is to end by itself
ODD = 'a <img src=x onerror="b">&\'c; $(d) \u00fc\u202e.gltf'
NOT_UTF8 = os.fsdecode(b"-q=[\xff].gltf")
CONTROLS = "line\nbreak\x1b[2J.gltf"

# In place of the server: behaves as the name of the file says.
STUB = """#!{python}
import os, signal, sys
word = sys.argv[2] if sys.argv[1] == "inspect" else sys.argv[3]
name = os.path.basename(word).partition(".")[0]
if name == "segv":
    signal.signal(signal.SIGSEGV, signal.SIG_DFL)
    os.kill(os.getpid(), signal.SIGSEGV)
if name == "hang":
    signal.pause()
if name == "machine":
    sys.exit("fieldcast-server: out of memory")
if name == "undefined":
    print("a.cpp:1:2: runtime error: signed integer overflow", file=sys.stderr)
if name == "address":
    print("==7==ERROR: AddressSanitizer: heap-use-after-free", file=sys.stderr)
    sys.exit(2)
if name == "refused":
    print("fieldcast-server: " + word + ": mesh 0: b.cpp:1:2: runtime error: no", file=sys.stderr)
    sys.exit(2)
print("no JSON" if name == "mumbles" else '{{"triangles_shown": 1, "extensions": [], "warnings": []}}')
"""


class Page(html.parser.HTMLParser):
    """Rows of the table of files, and pictures; fails if elements do not nest or the page asks for anything else."""

    VOID = {"meta", "br", "img"}

    def __init__(self, text):
        super().__init__()
        self.open, self.rows, self.pictures = [], [], []
        self.feed(text)
        self.close()
        assert not self.open, self.open

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        assert tag not in ("script", "link", "iframe", "a"), tag
        assert not any(name.startswith("on") for name in attributes), attributes
        if tag == "img":
            self.pictures.append(attributes["src"])
        if tag not in self.VOID:
            self.open.append(tag)
        if tag == "tr" and "tbody" in self.open:
            self.rows.append([])
        if tag == "td" and "tbody" in self.open:
            self.rows[-1].append("")

    def handle_endtag(self, tag):
        assert self.open.pop() == tag, tag

    def handle_data(self, data):
        if "tbody" in self.open and "td" in self.open:
            self.rows[-1][-1] += data


class InFolder(unittest.TestCase):
    SERVER = ""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.files = self.folder / "files"
        self.out = self.folder / "out"
        self.files.mkdir()

    def put(self, files):
        for name, content in files.items():
            path = self.files / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)

    def command(self, *flags, server=None):
        return [sys.executable, "-B", str(TOOL), str(self.files), "--server", str(server or self.SERVER), "--out",
                str(self.out), *map(str, flags)]

    def call(self, *flags, server=None):
        return subprocess.run(self.command(*flags, server=server), capture_output=True, text=True, check=False,
                              errors="surrogateescape", timeout=LONG_S)

    def summary(self, done, code=0):
        """The summary of a run with --json."""
        self.assertEqual(code, done.returncode, done.stderr)
        return json.loads(done.stdout)

    def records(self):
        """Name of a file -> its record."""
        lines = (self.out / "results.jsonl").read_text().splitlines()
        return {os.path.basename(record["path"]): record for record in map(json.loads, lines)}

    def page(self):
        return Page((self.out / "index.html").read_text(encoding="utf-8"))


class Opening(InFolder):
    FLAGS = ("--no-render", "--json", "--timeout", LONG_S / 2)

    def test_valid_files_open(self):
        self.put({f"below/{name}": content for name, content in scene_files.valid().items()})
        count = len(scene_files.valid())
        summary = self.summary(self.call(*self.FLAGS))
        refused = {name: each["reason"] for name, each in self.records().items() if each["result"] != "opened"}
        self.assertEqual({}, refused)
        self.assertEqual((count, count, count), (summary["files"], summary["opened"], summary["run_now"]))
        records = self.records()
        self.assertEqual({"instances.gltf": 2, "strip.gltf": 2, "fan.gltf": 2, "camera.gltf": 1},
                         {name: records[name]["triangles"]
                          for name in ("instances.gltf", "strip.gltf", "fan.gltf", "camera.gltf")})
        self.assertTrue(records["points.gltf"]["warnings"], "points are ignored with a warning")
        for record in records.values():
            self.assertGreater(record["open_s"], 0.0)
            self.assertGreater(record["peak_mb"], 1.0)
        cells = {os.path.basename(row[0]): row for row in self.page().rows}
        self.assertIn("KHR_texture_transform (required)", cells["texture_transform.gltf"][-1])
        self.assertIn("VENDOR_unheard_of (ignored)", cells["unknown_extension.gltf"][-1])

    def test_damaged_files_are_refused_with_a_reason(self):
        files = scene_files.damaged()
        self.put({name: content for name, (content, _) in files.items()})
        summary = self.summary(self.call(*self.FLAGS))
        self.assertEqual((len(files), 0), (summary["refused"], summary["crashed"]))
        cells = {os.path.basename(row[0]): row for row in self.page().rows}
        for name, record in self.records().items():
            with self.subTest(name):
                self.assertEqual("refused", record["result"])
                self.assertIn(files[name][1], record["reason"])
                self.assertEqual(["refused", record["reason"]], cells[name][1:3])

    def test_second_run_adds_nothing(self):
        self.put({"a.gltf": scene_files.Scene().gltf(), "b.gltf": b"", "sub/c.glb": scene_files.Scene().glb(),
                  "no.bin": b""})
        first = self.summary(self.call(*self.FLAGS))
        kept = (self.out / "results.jsonl").read_bytes()
        second = self.summary(self.call(*self.FLAGS))
        self.assertEqual(kept, (self.out / "results.jsonl").read_bytes())
        self.assertEqual((3, 0), (first["run_now"], second["run_now"]))
        self.assertEqual({**first, "run_now": 0}, second)
        self.assertEqual(3, len(self.page().rows))
        self.assertEqual(1, self.summary(self.call(*self.FLAGS, "--again"))["run_now"], "what did not open")
        self.put({"b.gltf": scene_files.Scene().gltf()})
        repaired = self.summary(self.call(*self.FLAGS))
        self.assertEqual((1, 3), (repaired["run_now"], repaired["opened"]))

    def test_odd_names_are_escaped(self):
        names = [ODD, NOT_UTF8, CONTROLS]
        self.put(dict.fromkeys(names, scene_files.Scene().gltf()))
        done = self.call("--no-render")
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertEqual({ODD: "opened", NOT_UTF8: "opened", CONTROLS: "refused"},
                         {name: record["result"] for name, record in self.records().items()})
        page = self.page()
        self.assertEqual([], page.pictures)
        shown = {row[0].removeprefix(f"{self.files}/") for row in page.rows}
        self.assertEqual({ODD.replace("\u202e", "\\u202e"), "-q=[\\udcff].gltf", "line\\nbreak\\x1b[2J.gltf"}, shown)
        self.assertNotIn("\x1b", done.stdout + done.stderr)
        self.assertEqual(0, self.summary(self.call(*self.FLAGS))["run_now"])

    def test_wrong_arguments(self):
        self.put({"a.gltf": scene_files.Scene().gltf()})
        for flags, message in ((["absent"], "absent: there is no such folder"), (["--jobs", "0"], "--jobs 0"),
                               (["--timeout", "nan"], "--timeout nan"), (["--timeout", "0"], "--timeout 0"),
                               (["--server", "absent"], "--server absent"), (["--out", __file__], f"--out {__file__}")):
            with self.subTest(flags):
                done = self.call(*flags)
                self.assertEqual(2, done.returncode)
                self.assertIn(message, done.stderr)
        (self.files / "a.gltf").unlink()
        self.assertIn("no .gltf or .glb below", self.call().stderr)


class Misbehaviour(InFolder):
    def setUp(self):
        super().setUp()
        self.stub = self.folder / "stub"
        self.stub.write_text(STUB.format(python=sys.executable))
        self.stub.chmod(0o755)

    def test_crashes_are_found(self):
        names = ("segv", "machine", "undefined", "address", "refused", "mumbles", "good")
        self.put({f"{name}.gltf": b"" for name in names})
        summary = self.summary(self.call("--no-render", "--json", server=self.stub), code=1)
        self.assertEqual((5, 1, 1), (summary["crashed"], summary["refused"], summary["opened"]))
        reasons = {name.partition(".")[0]: record["reason"] for name, record in self.records().items()}
        parts = {"segv": "SIGSEGV", "machine": "exit code 1: out of memory", "mumbles": "not JSON",
                 "undefined": "runtime error", "address": "AddressSanitizer", "refused": "mesh 0: b.cpp"}
        for name, part in parts.items():
            self.assertIn(part, reasons[name])
        self.assertEqual(["crashed"] * 5 + ["refused", "opened"], [row[1] for row in self.page().rows], "worst first")

    def test_render_without_picture_is_a_crash(self):
        self.put({"good.gltf": b""})
        self.assertEqual(1, self.call(server=self.stub).returncode)
        self.assertIn("render: it wrote no picture", self.records()["good.gltf"]["reason"])

    def test_timeout(self):
        self.put({"hang.gltf": b""})
        summary = self.summary(self.call("--no-render", "--json", "--timeout", "0.5", server=self.stub), code=1)
        self.assertEqual(1, summary["timed_out"])
        self.assertEqual("inspect: more than 0.5 s", self.records()["hang.gltf"]["reason"])

    def test_interruption_keeps_what_is_done(self):
        self.put({"a.gltf": b"", "hang.gltf": b""})
        with subprocess.Popen(self.command("--no-render", "--json", "--jobs", "1", server=self.stub), text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE) as tool:
            self.assertIn("[1/2] opened", tool.stderr.readline())
            tool.send_signal(signal.SIGINT)
            summary = json.loads(tool.communicate(timeout=LONG_S)[0])
            self.assertEqual(INTERRUPTED, tool.returncode)
        self.assertEqual((1, 1), (summary["opened"], summary["not_run"]))
        self.assertEqual(["a.gltf"], list(self.records()))
        self.assertEqual(["not run", "opened"], [row[1] for row in self.page().rows])

    def test_half_a_line_is_no_result(self):
        self.put({"a.gltf": b"", "b.gltf": b""})
        self.call("--no-render", "--jobs", "1", server=self.stub)
        results = self.out / "results.jsonl"
        lines = results.read_text().splitlines()
        results.write_text(lines[0] + "\n" + lines[1][:50])
        self.assertEqual(1, self.summary(self.call("--no-render", "--json", server=self.stub))["run_now"])
        self.assertEqual(0, self.summary(self.call("--no-render", "--json", server=self.stub))["run_now"])


class Rendering(InFolder):
    def test_picture(self):
        self.put({ODD: scene_files.with_camera().gltf()})
        flags = ("--json", "--timeout", LONG_S / 2)
        self.assertEqual(1, self.summary(self.call(*flags, "--no-render"))["run_now"])
        done = self.call(*flags)
        if done.returncode == 2 and "Vulkan" in done.stderr:
            self.skipTest(done.stderr.strip())
        summary = self.summary(done)
        self.assertEqual((1, 1), (summary["run_now"], summary["opened"]), "it had only been opened")
        self.assertGreater(self.records()[ODD]["render_s"], 0.0)
        (picture,) = self.page().pictures
        self.assertEqual(b"\x89PNG", (self.out / picture).read_bytes()[:4])
        self.assertEqual([], list(self.out.glob(".rendering-*")))
        self.assertEqual(0, self.summary(self.call(*flags))["run_now"])


if __name__ == "__main__":
    InFolder.SERVER = pathlib.Path(sys.argv.pop(1)).resolve()
    result = unittest.main(exit=False).result
    for _, reason in result.skipped:
        print("skipped:", reason)
    sys.exit(1 if not result.wasSuccessful() else SKIPPED if result.skipped else 0)
