# SPDX-License-Identifier: Apache-2.0
"""Puts promtool into .cache/promtool, out of Debian's package `prometheus`, which is not installed: it would bring a
service and a third of a gigabyte. Exit code 77: it could not be. Run in the root of the repository."""
import pathlib
import shutil
import subprocess
import sys
import tarfile
import tempfile

PROGRAM = pathlib.Path(".cache/promtool/promtool").resolve()
MEMBER = "./usr/bin/promtool"


def extract(package):
    with subprocess.Popen(["dpkg-deb", "--fsys-tarfile", package], stdout=subprocess.PIPE) as unpacked:
        with tarfile.open(fileobj=unpacked.stdout, mode="r|") as files:
            member = next(entry for entry in files if entry.name == MEMBER)
            with PROGRAM.open("wb") as program:
                shutil.copyfileobj(files.extractfile(member), program)
        unpacked.stdout.read()  # or dpkg-deb ends by a signal
    PROGRAM.chmod(0o755)


def main():
    if shutil.which("promtool") or PROGRAM.exists():
        return 0
    PROGRAM.parent.mkdir(parents=True, exist_ok=True)
    try:
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run(["apt-get", "download", "--quiet", "prometheus"], cwd=folder, check=True, timeout=240)
            extract(next(pathlib.Path(folder).glob("prometheus_*.deb")))
        subprocess.run([PROGRAM, "--version"], check=True, timeout=60)
    except (OSError, StopIteration, subprocess.SubprocessError, tarfile.TarError) as problem:
        PROGRAM.unlink(missing_ok=True)
        print(f"skipped: promtool cannot be had here: {problem}")
        return 77
    return 0


if __name__ == "__main__":
    sys.exit(main())
