# SPDX-License-Identifier: Apache-2.0
"""`fieldcast-bench fanout` as people call it, with a small recording: what it measures, not how much it is.

    python3 tests/bench/fanout_test.py build/release/bench/fieldcast-bench
"""
import csv
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

RECORDING = "tests/data/recordings/v1.fcrec"


def call(*arguments):
    return subprocess.run([PROGRAM, "fanout", *map(str, arguments)], capture_output=True, check=False, text=True)


class Fanout(unittest.TestCase):
    def test_measures_both_servers(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            done = call("--recording", RECORDING, "--clients", "1,3", "--rounds", 2, "--seconds", 0.5, "--fps", 50,
                        "--json", folder / "a.json", "--csv", folder / "a.csv")
            self.assertEqual(0, done.returncode, done.stderr)
            result = json.loads((folder / "a.json").read_text(encoding="utf-8"))
            rows = list(csv.DictReader((folder / "a.csv").read_text(encoding="utf-8").splitlines()))
        self.assertIn("ratio", done.stdout)
        self.assertEqual({"median", "smallest", "largest"}, set(result["ratio"]))
        kinds = {"fieldcast-server", "bare gRPC"}
        self.assertEqual({(str(turn), kind, clients) for turn in (1, 2) for kind in kinds for clients in ("1", "3")},
                         {(row["round"], row["kind"], row["clients"]) for row in rows})
        for row in rows:
            self.assertGreater(float(row["cpu_ms"]), 0.0, row)
            self.assertGreater(float(row["frames"]), 0.0, row)
            # All that frames consist of came along; frames under way at either end of the window may differ.
            per_frame = float(row["megabytes"]) / float(row["frames"])
            self.assertAlmostEqual(float(row["megabytes_per_frame"]), per_frame, delta=0.5 * per_frame)

    def test_says_what_is_wrong(self):
        for arguments, text in ((["--recording", "no.fcrec"], "there is no such file"),
                                (["--recording", RECORDING, "--clients", "4,4"], "at least two"),
                                (["--recording", RECORDING, "--server", "no/server"], "there is no such program")):
            done = call(*arguments)
            self.assertEqual(2, done.returncode, done.stderr)
            self.assertIn(text, done.stderr)


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()
