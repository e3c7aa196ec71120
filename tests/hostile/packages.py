# SPDX-License-Identifier: Apache-2.0
"""Finds a Python that has the packages which the client needs, and makes Python modules of proto/."""
import importlib
import importlib.util
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
SKIPPED = 77  # ctest shows this exit code as skipped
NEEDED = ("h2", "hpack", "google.protobuf")
DEBIAN = pathlib.Path("/usr/bin/python3")  # which sees Debian's packages


def has_all():
    try:
        return all(importlib.util.find_spec(name) for name in NEEDED)
    except ModuleNotFoundError:  # of the parent of google.protobuf
        return False


def run_where_they_are():
    """Goes on only where the packages are; replaces this process if Debian's Python has them."""
    if has_all():
        return
    check = [DEBIAN, "-c", "import " + ", ".join(NEEDED)]
    if not os.environ.get("FIELDCAST_TRIED") and DEBIAN.exists() and subprocess.run(
            check, capture_output=True, check=False).returncode == 0:
        os.execve(DEBIAN, [str(DEBIAN), "-B", *sys.argv], {**os.environ, "FIELDCAST_TRIED": "1"})
    print(f"skipped: no Python has {', '.join(NEEDED)} (`./fieldcast setup` installs them)")
    sys.exit(SKIPPED)


def make_messages(folder):
    """Generates modules of proto/ into `folder` and puts it where Python looks."""
    folder.mkdir(parents=True, exist_ok=True)
    sources = sorted(path.relative_to(ROOT / "proto").as_posix() for path in (ROOT / "proto").rglob("*.proto"))
    subprocess.run(["protoc", "-I", ROOT / "proto", "--python_out", folder, *sources], check=True, timeout=60)
    sys.path.insert(0, str(folder))
    importlib.invalidate_caches()
