#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Opens and renders every glTF file below some folders, and writes a page with the results.

    tools/conformance.py ~/models                                   # writes out/conformance/index.html
    tools/conformance.py ~/models --no-render --json                # needs no device; prints the summary as JSON
    tools/conformance.py ~/models ~/scans --out /tmp/check --jobs 2 --timeout 300
    tools/conformance.py ~/models --again                           # repeats what did not open, after a fix

Each .gltf and .glb runs through 'fieldcast-server inspect', and then through 'fieldcast-server render' for one small
picture. A file is opened, refused (exit code 2), crashed (a signal, any other exit code, or a sanitizer report), or
timed out. OUT/results.jsonl receives one line per finished file, so the next run continues where this one stopped. A
file runs again once its size or modification time has changed; buffers and images beside it are not compared.

Exit codes: 0 no crash and no timeout, 1 a crash or a timeout, 2 wrong arguments or no device, 130 interrupted.
"""
import argparse
import concurrent.futures
import dataclasses
import hashlib
import json
import math
import os
import pathlib
import re
import select
import signal
import stat
import subprocess
import sys
import tempfile
import time

import conformance_page
from conformance_page import RESULTS, printable

ROOT = pathlib.Path(__file__).resolve().parent.parent
SUFFIXES = (".gltf", ".glb")
PROGRAM = "fieldcast-server: "  # how its messages begin
MAX_TIMEOUT_S = 1e6
WRONG_INPUT, INTERRUPTED = 2, 130
# A fixed channel name, because the default one is made of the file's name. One view without margin is the least work.
RENDER_FLAGS = ("--size", "160x90", "--largest-grid", "1x1", "--guard-band", "none", "--fixed-camera",
                "--clock", "frames", "--count", "1", "--write", "views", "--log-level", "error")
LEAKS = f"suppressions={ROOT}/tests/fixtures/leaks.supp:print_suppressions=0"
SANITIZER = re.compile(r"^(==\d+==\s*(?:ERROR|WARNING): \w+Sanitizer.*|SUMMARY: \w+Sanitizer.*"
                       r"|WARNING: \w+Sanitizer.*|[^:\n]+:\d+:\d+: runtime error: .*)$", re.MULTILINE)
NO_DEVICE = re.compile(r"^fieldcast-server: no (?:Vulkan driver|usable Vulkan device)", re.MULTILINE)


class NoDevice(Exception):
    """The server finds no Vulkan device, so no file can be rendered."""


class Stopped(Exception):
    """The run ends before this program has ended."""


@dataclasses.dataclass(frozen=True)
class File:
    """A glTF file, and the values that identify its content without reading it."""
    path: str  # absolute
    shown: str  # as found below the given folder
    size: int
    mtime_ns: int

    @property
    def key(self):
        return (self.path, self.size, self.mtime_ns)


@dataclasses.dataclass(frozen=True)
class Ended:
    """How a program has ended."""
    code: int  # negative: minus the number of the signal
    is_late: bool
    seconds: float
    peak_mb: float
    out: bytes
    err: str


def find(folders):
    """All glTF files below `folders`, each once; links to folders are not followed."""
    found = {}
    for folder in folders:
        for where, below, names in os.walk(folder, onerror=lambda problem: note(str(problem))):
            below.sort()
            for name in sorted(names):
                path = os.path.join(where, name)
                if name.lower().endswith(SUFFIXES) and os.path.isfile(path):
                    status = os.stat(path)
                    absolute = os.path.join(os.path.realpath(where), name)
                    found.setdefault(absolute, File(absolute, path, status.st_size, status.st_mtime_ns))
    return list(found.values())


def note(text):
    print(printable(text), file=sys.stderr, flush=True)


def run(command, timeout_s, stop):
    """Waits until `command` has ended, and kills it after `timeout_s`, or once `stop` (a descriptor) is readable."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        begin = time.monotonic()
        # A process group of its own, so that Ctrl-C reaches this program only.
        child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=out, stderr=err, process_group=0,
                                 env={"LSAN_OPTIONS": LEAKS, **os.environ})
        handle = os.pidfd_open(child.pid)
        events = select.poll()
        for descriptor in (handle, stop):
            events.register(descriptor, select.POLLIN)
        ready = {descriptor for descriptor, _ in events.poll(timeout_s * 1000)}
        if handle not in ready:
            signal.pidfd_send_signal(handle, signal.SIGKILL)
        os.close(handle)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        if stop in ready:
            raise Stopped
        out.seek(0)
        err.seek(0)
        return Ended(child.returncode, not ready, time.monotonic() - begin, usage.ru_maxrss * 1024 / 1e6,
                     out.read(), err.read().decode("utf-8", "replace"))


def reason_of(ended, file):
    """The messages of the program without its name and the file's; else the last line of its output."""
    lines = [line.strip() for line in ended.err.splitlines() if line.strip()]
    messages = [line.removeprefix(PROGRAM) for line in lines if line.startswith(PROGRAM)]
    return "; ".join(line.removeprefix(f"{file.path}: ") for line in messages or lines[-1:]) or "no message"


def judge(ended, file, what, timeout_s):
    """(result, reason) of one program; the reason of an opened file is empty."""
    report = SANITIZER.search(ended.err)
    if ended.is_late:
        return "timed_out", f"{what}: more than {timeout_s:g} s"
    if report:
        return "crashed", f"{what}: {report.group(1)}"
    if ended.code == WRONG_INPUT:
        return "refused", reason_of(ended, file)
    if ended.code < 0:
        return "crashed", f"{what}: {signal.Signals(-ended.code).name}: {reason_of(ended, file)}"
    if ended.code > 0:
        return "crashed", f"{what}: exit code {ended.code}: {reason_of(ended, file)}"
    return "opened", ""


def open_file(file, options, stop):
    """The record of a file after 'inspect'."""
    ended = run([options.server, "inspect", file.path, "--json"], options.timeout, stop)
    result, reason = judge(ended, file, "inspect", options.timeout)
    content = {}
    if result == "opened":
        try:
            content = json.loads(ended.out.decode("utf-8", "replace"))
        except ValueError as problem:
            result, reason = "crashed", f"inspect: its output is not JSON: {problem}"
    return {"path": file.path, "size": file.size, "mtime_ns": file.mtime_ns, "result": result, "reason": reason,
            "open_s": round(ended.seconds, 3), "render_s": None, "peak_mb": round(ended.peak_mb, 1),
            "triangles": content.get("triangles_shown"), "extensions": content.get("extensions", []),
            "warnings": content.get("warnings", []), "picture": None}


def render(file, record, options, stop):
    """Adds the result of 'render' to the record, and moves the picture to OUT/pictures."""
    with tempfile.TemporaryDirectory(prefix=".rendering-", dir=options.out) as folder:
        ended = run([options.server, "render", "--channel", f"scene={file.path}", *RENDER_FLAGS, "--out", folder],
                    options.timeout, stop)
        if ended.code > 0 and NO_DEVICE.search(ended.err):
            raise NoDevice(reason_of(ended, file))
        record["result"], record["reason"] = judge(ended, file, "render", options.timeout)
        record["render_s"] = round(ended.seconds, 3)
        record["peak_mb"] = max(record["peak_mb"], round(ended.peak_mb, 1))
        pictures = sorted(pathlib.Path(folder).glob("*.png"))
        if record["result"] == "opened" and not pictures:
            record["result"], record["reason"] = "crashed", "render: it wrote no picture"
        elif record["result"] == "opened":
            record["picture"] = f"pictures/{hashlib.sha256(os.fsencode(file.path)).hexdigest()[:16]}.png"
            os.replace(pictures[0], options.out / record["picture"])


def test(file, options, stop):
    record = open_file(file, options, stop)
    if record["result"] == "opened" and not options.no_render:
        render(file, record, options, stop)
    return record


def read_results(path):
    """Key of a file -> its last record. Lines that a killed run left incomplete are skipped."""
    found = {}
    for line in path.read_bytes().splitlines() if path.exists() else ():
        try:
            record = json.loads(line)
            found[(record["path"], record["size"], record["mtime_ns"])] = record
        except (ValueError, KeyError, TypeError):
            continue
    return found


def is_done(record, options):
    """Whether this run has nothing to add to a record of an earlier one."""
    if record is None or (options.again and record["result"] != "opened"):
        return False
    return record["result"] != "opened" or options.no_render or record["render_s"] is not None


class ResultsFile:
    """Appends records; each line is written by one call, so an interruption leaves no half of one."""

    def __init__(self, path):
        self.descriptor = os.open(path, os.O_RDWR | os.O_APPEND | os.O_CREAT, 0o644)
        size = os.fstat(self.descriptor).st_size
        if size and os.pread(self.descriptor, 1, size - 1) != b"\n":
            os.write(self.descriptor, b"\n")  # ends the incomplete line of a run that was killed

    def append(self, record):
        os.write(self.descriptor, json.dumps(record).encode() + b"\n")


def test_all(files, options, on_record):
    """Calls `on_record` with each file and its record, in the order in which they end."""
    stop, stopper = os.pipe()
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        try:
            futures = {pool.submit(test, file, options, stop): file for file in files}
            for future in concurrent.futures.as_completed(futures):
                on_record(futures[future], future.result())
        except BaseException:
            os.write(stopper, b"x")
            pool.shutdown(cancel_futures=True)
            raise


def summarise(files, records, run_now, options):
    count = dict.fromkeys(RESULTS, 0)
    for file in files:
        if file.key in records:
            count[records[file.key]["result"]] += 1
    return {"files": len(files), **count, "not_run": len(files) - sum(count.values()), "run_now": run_now,
            "page": str(options.out / "index.html"), "results": str(options.out / "results.jsonl")}


def print_summary(summary, options):
    if options.json:
        print(json.dumps(summary, indent=1))
        return
    counts = ", ".join(f"{summary[result]} {label}" for result, label in reversed(RESULTS.items()))
    rest = f", {summary['not_run']} not run" if summary["not_run"] else ""
    print(f"{summary['files']} files: {counts}{rest}; {summary['run_now']} of them tested now")
    print(f"page: {printable(summary['page'])}")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+", metavar="FOLDER", help="tests every .gltf and .glb below it")
    parser.add_argument("--server", type=pathlib.Path, default=ROOT / "build/release/server/fieldcast-server",
                        help="the program; default: build/release/server/fieldcast-server")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/conformance"),
                        help="folder for the results; default: out/conformance")
    parser.add_argument("--no-render", action="store_true", help="only open the files; needs no device")
    parser.add_argument("--again", action="store_true", help="repeat the files that an earlier run did not open")
    parser.add_argument("--timeout", type=float, default=120.0, metavar="SECONDS",
                        help="for opening, and again for rendering; default: 120")
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)),
                        help="files at the same time; default: number of processors")
    parser.add_argument("--json", action="store_true", help="print the summary as JSON")
    options = parser.parse_intermixed_args()
    for folder in options.folders:
        if not os.path.isdir(folder):
            parser.error(f"{printable(folder)}: there is no such folder")
    if not os.access(options.server, os.X_OK) or not options.server.is_file():
        parser.error(f"--server {printable(options.server)}: there is no such program; './fieldcast build' makes it")
    if not 0.0 < options.timeout <= MAX_TIMEOUT_S or math.isnan(options.timeout):
        parser.error(f"--timeout {options.timeout:g}: is not a number of seconds from above 0 to {MAX_TIMEOUT_S:.0f}")
    if options.jobs < 1:
        parser.error(f"--jobs {options.jobs}: is less than 1")
    options.server = options.server.resolve()
    return parser, options


def prepare(parser, options):
    """The files; makes OUT."""
    files = find(options.folders)
    if not files:
        parser.error(f"no .gltf or .glb below {', '.join(map(printable, options.folders))}")
    try:
        (options.out / "pictures").mkdir(parents=True, exist_ok=True)
    except OSError as problem:
        parser.error(f"--out {printable(options.out)}: {problem.strerror}")
    return files


def main():
    parser, options = arguments()
    files = prepare(parser, options)
    records = read_results(options.out / "results.jsonl")
    results = ResultsFile(options.out / "results.jsonl")
    wanted = [file for file in files if not is_done(records.get(file.key), options)]
    known = {file.key: records[file.key] for file in files if is_done(records.get(file.key), options)}
    tested = []

    def keep(file, record):
        results.append(record)
        known[file.key] = record
        tested.append(file)
        note(f"[{len(tested)}/{len(wanted)}] {RESULTS[record['result']]} {file.shown}"
             + (f": {record['reason']}" if record["reason"] else ""))

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.default_int_handler)
    is_interrupted = False
    try:
        test_all(wanted, options, keep)
    except KeyboardInterrupt:
        is_interrupted = True
    except NoDevice as problem:
        parser.exit(WRONG_INPUT, f"{parser.prog}: {problem}; or open the files only, with --no-render\n")
    summary = summarise(files, known, len(tested), options)
    conformance_page.write(options.out, [(file.shown, known.get(file.key)) for file in files], summary)
    print_summary(summary, options)
    return INTERRUPTED if is_interrupted else 1 if summary["crashed"] or summary["timed_out"] else 0


if __name__ == "__main__":
    for stream in (sys.stdout, sys.stderr):
        stream.reconfigure(errors="backslashreplace")
    sys.exit(main())
