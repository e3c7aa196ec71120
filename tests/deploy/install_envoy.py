# SPDX-License-Identifier: Apache-2.0
"""Installs Envoy for the tests into .cache/envoy. Exit code 77: it could not be. Run in the root of the repository."""
import pathlib
import subprocess
import sys
import venv

FOLDER = pathlib.Path(".cache/envoy")
WANTED = pathlib.Path("deploy/requirements.txt")
INSTALLED = FOLDER / "requirements.txt"


def main():
    if INSTALLED.exists() and INSTALLED.read_bytes() == WANTED.read_bytes():
        return 0
    try:
        venv.create(FOLDER, with_pip=True, clear=True)
        subprocess.run([FOLDER / "bin/pip", "install", "--quiet", "--disable-pip-version-check", "-r", WANTED],
                       check=True, timeout=240)
        subprocess.run([FOLDER / "bin/envoy", "--version"], check=True, timeout=60)
    except (OSError, subprocess.SubprocessError) as problem:
        print(f"skipped: Envoy cannot be installed here: {problem}")
        return 77
    INSTALLED.write_bytes(WANTED.read_bytes())
    return 0


if __name__ == "__main__":
    sys.exit(main())
