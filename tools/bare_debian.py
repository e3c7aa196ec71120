#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tries the commands of README.md on a Debian without any of the packages.

    tools/bare_debian.py trixie --folder /var/tmp/bare
    tools/bare_debian.py bookworm --folder /var/tmp/bare --keep -- ./fieldcast test --quick

Makes a minimal root file system with mmdebstrap, copies the committed files there, and runs './fieldcast demo' and
'./fieldcast test --quick' in it, or the command after '--'. FOLDER/SUITE.log receives their output. Packages come from
the mirror that this machine uses. Compiled files stay in FOLDER/SUITE.ccache, so that the next try takes less time; the
root is deleted unless --keep is given. Needs root, mmdebstrap, and about 10 GB.
"""
import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent.parent
SUITES = ("bookworm", "trixie")  # Debian 12 and 13
COMMANDS = (("./fieldcast", "demo"), ("./fieldcast", "test", "--quick"))
PLACE = "fieldcast"  # folder of the sources inside the root
# Runs in a namespace of its own, so that no mount stays behind, however the command ends.
INSIDE = """
set -e
mount -t proc proc "$1/proc"
mount --rbind /dev "$1/dev"
mount --bind "$2" "$1/ccache"
shift 2
exec nice -n 10 "$@"
"""


def mirror_of_this_machine():
    rows = subprocess.run(["apt-get", "indextargets", "--format", "$(COMPONENT) $(CODENAME) $(REPO_URI)",
                           "Created-By: Packages"], capture_output=True, text=True, check=True).stdout.splitlines()
    own = [row.split() for row in rows]
    found = [row[2] for row in own if row[:2] in (["main", suite] for suite in SUITES)]
    if not found:
        sys.exit("bare_debian: this machine has no Debian mirror in its package sources; name one with --mirror")
    return found[0]


def make_root(root, suite, mirror):
    if not (root / "etc/os-release").exists():
        shutil.rmtree(root, ignore_errors=True)
        subprocess.run(["mmdebstrap", "--variant=apt", "--mode=root", "--format=directory", suite, str(root), mirror],
                       check=True)
    shutil.copy("/etc/resolv.conf", root / "etc/resolv.conf")
    (root / "ccache").mkdir(exist_ok=True)


def copy_sources(root):
    (root / PLACE).mkdir(exist_ok=True)
    archive = subprocess.run(["git", "-C", str(HERE), "archive", "HEAD"], capture_output=True, check=True).stdout
    subprocess.run(["tar", "-x", "-C", str(root / PLACE)], input=archive, check=True)


def run(root, ccache, command, log):
    """Exit code of `command` in the root; its output goes to the terminal and to `log`."""
    inside = ["chroot", str(root), "env", "-i", "PATH=/usr/sbin:/usr/bin:/sbin:/bin", "HOME=/root", "LANG=C.UTF-8",
              "CCACHE_DIR=/ccache", "CCACHE_BASEDIR=/", "CCACHE_NOHASHDIR=1",
              "sh", "-c", f'cd /{PLACE} && exec "$@"', "sh", *command]
    process = subprocess.Popen(["unshare", "--mount", "--propagation", "private", "sh", "-c", INSIDE, "sh", str(root),
                                str(ccache), *inside],
                               stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    for line in process.stdout:
        print(line, end="", flush=True)
        log.write(line)
        log.flush()
    return process.wait()


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("suite", choices=SUITES)
    parser.add_argument("--folder", type=pathlib.Path, default=pathlib.Path("/var/tmp/fieldcast-bare"))
    parser.add_argument("--mirror", help="default: the one that this machine uses")
    parser.add_argument("--ccache", type=pathlib.Path, help="folder of compiled files; default: FOLDER/SUITE.ccache")
    parser.add_argument("--keep", action="store_true", help="keep the root; the next try continues with it")
    words = sys.argv[1:]
    cut = words.index("--") if "--" in words else len(words)
    choice = parser.parse_args(words[:cut])
    choice.command = words[cut + 1:]
    return choice


def main():
    choice = arguments()
    if os.geteuid() != 0 or shutil.which("mmdebstrap") is None:
        sys.exit("bare_debian: this needs root, and the package mmdebstrap")
    folder = choice.folder.resolve()
    root = folder / f"{choice.suite}.root"
    ccache = (choice.ccache or folder / f"{choice.suite}.ccache").resolve()
    ccache.mkdir(parents=True, exist_ok=True)
    make_root(root, choice.suite, choice.mirror or mirror_of_this_machine())
    copy_sources(root)
    results = []
    with open(folder / f"{choice.suite}.log", "w", encoding="utf-8") as log:
        for command in [choice.command] if choice.command else COMMANDS:
            started = time.monotonic()
            code = run(root, ccache, command, log)
            results.append((code, f"{' '.join(command)}: exit code {code} after {time.monotonic() - started:.0f} s"))
    if not choice.keep:
        shutil.rmtree(root)
    print(f"== {choice.suite}")
    for _, line in results:
        print(line)
    return 0 if all(code == 0 for code, _ in results) else 1


if __name__ == "__main__":
    sys.exit(main())
