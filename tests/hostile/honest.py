# SPDX-License-Identifier: Apache-2.0
"""The honest client: a process that watches a stream, acknowledges every frame and writes down when frames came.

    python3 honest.py MESSAGES OUT TARGET GRID

OUT gets a line per event: `frame SECONDS`, `lost SECONDS WHY`; seconds of the machine's steady clock. It comes back when
its stream is lost, as clients do, and ends with its parent or when told to.
"""
import dataclasses
import json
import os
import pathlib
import subprocess
import sys
import time

from waiting import comes_true, let_pass

COME_BACK_S = 0.2


def watch(target, grid, out):
    """One session after the other."""
    from connection import Closed, Connection
    from fieldcast.v1 import types_pb2 as types
    from session import Broken, Session

    parent = os.getppid()
    while os.getppid() == parent:
        try:
            with Connection(target) as connection:
                session = Session(connection)
                session.configure(grid=types.Grid(rows=grid[0], cols=grid[1]))
                while os.getppid() == parent:
                    frame = session.read_frame(1.0)
                    if frame is not None:
                        session.acknowledge(frame)
                        print(f"frame {time.monotonic():.6f}", file=out, flush=True)
        except (Closed, Broken, OSError) as problem:
            print(f"lost {time.monotonic():.6f} {type(problem).__name__}: {problem}", file=out, flush=True)
            let_pass(COME_BACK_S)


class Honest:
    """Starts that process; tells what it got between two times."""

    def __init__(self, messages, folder, target, grid):
        self._out = pathlib.Path(folder) / "honest.txt"
        self._out.touch()
        self._process = subprocess.Popen([sys.executable, "-B", __file__, str(messages), str(self._out),
                                          json.dumps(dataclasses.asdict(target)), json.dumps(grid)])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._process.kill()
        self._process.wait()

    def _times(self, kind):
        lines = (line.split() for line in self._out.read_text(encoding="utf-8").splitlines())
        return [float(words[1]) for words in lines if len(words) > 1 and words[0] == kind]

    def wait_for_frames(self, count, timeout_s):
        """Until so many more have come; False if they do not."""
        wanted = len(self._times("frame")) + count
        comes_true(lambda: len(self._times("frame")) >= wanted or self._process.poll() is not None, timeout_s)
        return len(self._times("frame")) >= wanted

    def frames_per_second(self, begin, end):
        return sum(begin < moment <= end for moment in self._times("frame")) / (end - begin)

    def longest_gap_s(self, begin, end):
        """The longest time without a frame, the time before the first and after the last one included."""
        moments = [begin] + [moment for moment in self._times("frame") if begin < moment <= end] + [end]
        return max(b - a for a, b in zip(moments, moments[1:]))

    def losses(self, begin, end):
        return sum(begin < moment <= end for moment in self._times("lost"))

    def said(self):
        return [line for line in self._out.read_text(encoding="utf-8").splitlines() if line.startswith("lost")]


def main():
    sys.path.insert(0, sys.argv[1])
    from connection import Target

    with open(sys.argv[2], "a", encoding="utf-8") as out:
        watch(Target(**json.loads(sys.argv[3])), json.loads(sys.argv[4]), out)


if __name__ == "__main__":
    main()
