#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints the statistics of several clients, as written by fieldcast-client --json, as one table."""

import json
import pathlib
import sys


def latency(percentiles):
    """p50 and p95 in milliseconds, or a dash while the clocks were not in step."""
    return f"{percentiles['p50']:.0f} / {percentiles['p95']:.0f}" if percentiles else "-"


def not_shown(statistics):
    return statistics["superseded"] + statistics["aborted"] + statistics["failed"]


COLUMNS = [
    ("client", lambda name, s: name),
    ("mode", lambda name, s: s["mode"]),
    ("views", lambda name, s: f"{s['grid']} of {s['view_size']}"),
    ("frames", lambda name, s: str(s["shown"])),
    ("fps", lambda name, s: f"{s['frames_per_second']:.2f}"),
    ("MB/frame", lambda name, s: f"{s['bytes_per_frame'] / 1e6:.2f}"),
    ("pose to decoded ms p50/p95", lambda name, s: latency(s["pose_to_decoded_ms"])),
    ("pose to shown ms p50/p95", lambda name, s: latency(s["pose_to_shown_ms"])),
    ("discards", lambda name, s: f"{s['discarded_percent']:.2f} %"),
    ("not shown", lambda name, s: str(not_shown(s))),
]


def main(files):
    rows = [[title for title, _ in COLUMNS]]
    for file in map(pathlib.Path, files):
        statistics = json.loads(file.read_text())
        rows.append([cell(file.stem, statistics) for _, cell in COLUMNS])
    widths = [max(len(row[i]) for row in rows) for i in range(len(COLUMNS))]
    for row in rows:
        print("   " + "  ".join(text.ljust(width) for text, width in zip(row, widths)).rstrip())


if __name__ == "__main__":
    main(sys.argv[1:])
