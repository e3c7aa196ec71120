# SPDX-License-Identifier: Apache-2.0
"""Builds the image of deploy/Containerfile, starts it once and fetches a frame from it.

Run in the root, as root: python3 tests/deploy/container_test.py BUILD CLIENT

BUILD is a build folder with a built fieldcast-server, which takes the place of the stage that compiles; CLIENT is a
built fieldcast-client. The base image is made from Debian's packages, so no registry is needed. Exit code 77: not
possible here, for the reason that is printed.
"""
import os
import pathlib
import queue
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import containerfile
from container_image import Images, Unavailable, checked

CONTAINERFILE = pathlib.Path("deploy/Containerfile")
IMAGE = "localhost/fieldcast-server"
BUILD, CLIENT = (sys.argv.pop(1), sys.argv.pop(1)) if len(sys.argv) > 2 else (None, None)
USER = 65532
PROGRAM = "fieldcast-server"
READY = 300  # seconds until a server serves; HEALTHCHECK of the image allows as many
DRAINED = 30  # a drain takes at most 8 s
reason_to_skip = None


def suite_of(image):
    """docker.io/library/debian:bookworm-slim -> bookworm"""
    return re.search(r":([a-z]+)", image).group(1)


def own_suite():
    text = pathlib.Path("/etc/os-release").read_text(encoding="utf-8")
    found = re.search(r"^VERSION_CODENAME=(\w+)$", text, re.MULTILINE)
    return found.group(1) if found else None


def offspring(root):
    """Process ids of the children of a process, their children, and so on."""
    parents = {}
    for entry in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            parents[int(entry.parent.name)] = int(entry.read_text(encoding="utf-8").rpartition(")")[2].split()[1])
        except OSError:
            continue  # it ended meanwhile
    found = {root}
    for _ in parents:
        found |= {child for child, parent in parents.items() if parent in found}
    return found - {root}


def is_program(pid):
    try:
        return os.path.basename(os.readlink(f"/proc/{pid}/exe")) == PROGRAM
    except OSError:
        return False


class Log:
    """What a process says, taken line by line as it comes."""

    def __init__(self, stream):
        self.lines, self.news = [], queue.Queue()
        threading.Thread(target=self.follow, args=(stream,), daemon=True).start()

    def follow(self, stream):
        for line in stream:
            self.lines.append(line)
            self.news.put(line)
        self.news.put("")  # the end

    def waits_for(self, words, seconds):
        """Whether a line with these words comes in time."""
        end = time.monotonic() + seconds
        try:
            while line := self.news.get(timeout=max(end - time.monotonic(), 0.0)):
                if words in line:
                    return True
        except queue.Empty:
            pass
        return False

    def text(self):
        return "".join(self.lines)


def write_for_server(path, text):
    path.write_text(text, encoding="utf-8")
    os.chown(path, USER, USER)
    path.chmod(0o400)


class Container(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.folder.chmod(0o755)
        try:
            cls.make_image()
        except Unavailable as problem:
            global reason_to_skip  # what unittest knows of a skipped class does not reach its result's exit code
            reason_to_skip = str(problem)
            raise unittest.SkipTest(reason_to_skip) from problem
        cls.container = cls.images.start(IMAGE)
        cls.settings = cls.images.settings(IMAGE)

    @classmethod
    def make_image(cls):
        base = containerfile.base_image(CONTAINERFILE.read_text(encoding="utf-8"), "runtime")
        if suite_of(base) != own_suite():
            raise Unavailable(f"what is built here does not run in {base}")
        cls.images = Images()
        cls.addClassCleanup(cls.images.remove)
        cls.images.make_debian(suite_of(base), base)
        built = cls.folder / "built"
        checked("cmake", "--install", BUILD, "--component", "server", "--prefix", str(built / "installed/usr"))
        cls.images.build(IMAGE, "--target", "runtime", "--build-context", f"build={built}",
                         "-f", str(CONTAINERFILE), ".")

    def server(self, *flags, volumes=()):
        """The command that runs the image's program."""
        place = self.images.in_container(self.container, volumes)
        return self.images.command(*place, *self.settings["Entrypoint"], *flags)

    def test_program_starts(self):
        self.assertIn("--check-config", checked(*self.server("--help")))

    def test_wrong_flags_are_told_by_the_exit_code(self):
        result = subprocess.run(self.server("--no-such-flag"), capture_output=True, timeout=60, check=False)
        self.assertEqual(2, result.returncode, result.stderr)

    def test_serves_a_frame_and_stops_by_its_signal(self):
        volumes = self.prepare_service()
        command = self.server(*self.settings["Cmd"], volumes=volumes)
        process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
        self.addCleanup(self.end, process)
        log = Log(process.stderr)
        if not log.waits_for("SERVING", READY):
            self.fail(f"no server after {READY} s, or it ended: {log.text()[-3000:]}")
        port = int((self.folder / "state/port").read_text(encoding="utf-8"))
        probe = self.settings["Healthcheck"]["Test"][1:]
        probe[probe.index("127.0.0.1:50151")] = f"127.0.0.1:{port}"
        self.assertIn("SERVING", self.images.buildah(*self.images.in_container(self.container), *probe))
        self.fetch_frame(port)
        for pid in self.programs(process):
            os.kill(pid, getattr(signal, self.settings["StopSignal"]))
        self.assertEqual(0, process.wait(timeout=DRAINED), log.text())

    def prepare_service(self):
        """Configuration, token and scene, at the places that the image's own command names."""
        for name in ("configuration", "state"):
            (self.folder / name).mkdir()
            os.chown(self.folder / name, USER, USER)
        token = checked(*self.server("--make-token", "alice", "view"))
        (self.folder / "alice.txt").write_text(token, encoding="utf-8")
        (self.folder / "alice.txt").chmod(0o600)
        lines = [line for line in token.splitlines() if "sha256:" in line]
        write_for_server(self.folder / "configuration/tokens.txt", "\n".join(lines) + "\n")
        text = pathlib.Path("deploy/server.toml").read_text(encoding="utf-8")
        for pattern, line in (("size", "64x36"), ("largest-grid", "2x2"), ("listen", "127.0.0.1:0")):
            text = re.sub(f'^{pattern} = .*$', f'{pattern} = "{line}"', text, flags=re.M)
        text = re.sub("^metrics-listen = .*$", 'port-file = "/run/fieldcast/port"', text, flags=re.M)
        write_for_server(self.folder / "configuration/server.toml", text)
        return ((self.folder / "configuration", "/etc/fieldcast:ro"), (self.folder / "state", "/run/fieldcast"),
                (pathlib.Path("scenes").resolve(), "/srv/fieldcast/scenes:ro"))

    def fetch_frame(self, port):
        out = self.folder / "out"
        checked(CLIENT, "--server", f"127.0.0.1:{port}", "--token-file", str(self.folder / "alice.txt"),
                "--grid", "1x1", "--size", "64x36", "--frames", "1", "--out", str(out), "--write", "views",
                seconds=READY)
        pictures = list(out.glob("**/*.png"))
        self.assertEqual(1, len(pictures))
        header = pictures[0].read_bytes()
        self.assertEqual((64, 36), (int.from_bytes(header[16:20], "big"), int.from_bytes(header[20:24], "big")))

    @staticmethod
    def programs(process):
        return [pid for pid in offspring(process.pid) if is_program(pid)]

    def end(self, process):
        """Leaves nothing behind when the test fails."""
        if process.poll() is None:
            for pid in self.programs(process):
                os.kill(pid, signal.SIGKILL)
            process.wait(timeout=60)


if __name__ == "__main__":
    program = unittest.main(exit=False)
    if reason_to_skip:
        print(f"skipped: {reason_to_skip}")
        sys.exit(77)
    sys.exit(not program.result.wasSuccessful())
