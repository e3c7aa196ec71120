# SPDX-License-Identifier: Apache-2.0
"""What a process takes, from /proc, and what it logged."""
import collections
import json
import os
import pathlib
import threading

INTERVAL_S = 0.05


def resident_mib(pid):
    pages = int(pathlib.Path(f"/proc/{pid}/statm").read_text(encoding="ascii").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 2**20


def descriptors(pid):
    return len(os.listdir(f"/proc/{pid}/fd"))


def threads(pid):
    return len(os.listdir(f"/proc/{pid}/task"))


def cpu_s(pid):
    words = pathlib.Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


def log_lines(path):
    """Number of lines by kind: the event of a JSON line, else `other`."""
    kinds = collections.Counter()
    for line in pathlib.Path(path).read_text(encoding="utf-8", errors="replace").splitlines():
        try:
            kinds[str(json.loads(line)["event"])] += 1
        except (ValueError, KeyError, TypeError):
            kinds["other"] += 1
    return kinds


class Peak:
    """The most memory and descriptors that processes took since it began, looked at every 50 ms."""

    def __init__(self, pids):
        self._pids = list(pids)
        self.memory_mib = dict.fromkeys(self._pids, 0.0)
        self.descriptors = dict.fromkeys(self._pids, 0)
        self._end = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)

    def __enter__(self):
        self._look()
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._end.set()
        self._thread.join()
        self._look()

    def _look(self):
        for pid in self._pids:
            try:
                self.memory_mib[pid] = max(self.memory_mib[pid], resident_mib(pid))
                self.descriptors[pid] = max(self.descriptors[pid], descriptors(pid))
            except (OSError, IndexError):
                continue  # it has ended, which others notice

    def _run(self):
        while not self._end.wait(INTERVAL_S):
            self._look()
