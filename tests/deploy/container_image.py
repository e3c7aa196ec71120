# SPDX-License-Identifier: Apache-2.0
"""Images without a registry or a container engine: buildah in a chroot, with a storage of its own that vanishes."""
import json
import os
import pathlib
import shutil
import subprocess
import tempfile

SUITES = "{0} {0}-updates {0}-security"
QUICKER = ("--dpkgopt=force-unsafe-io", "--dpkgopt=path-exclude=/usr/share/doc/*",
           "--dpkgopt=path-exclude=/usr/share/man/*")
SLOW = 900  # seconds: downloads, and a machine that has other things to do


class Unavailable(Exception):
    """What is missing here, so that no image can be made."""


class Failed(Exception):
    """A command ended in another way than it should; holds what it said last."""


def checked(*command, seconds=SLOW):
    result = subprocess.run(command, capture_output=True, text=True, timeout=seconds, check=False)
    if result.returncode != 0:
        said = (result.stdout + result.stderr)[-3000:]
        raise Failed(f"{' '.join(command)}: exit code {result.returncode}: {said}")
    return result.stdout


def package_sources(suite):
    """Lines for sources.list: from where this machine itself installs the packages of a Debian suite."""
    wanted = SUITES.format(suite).split()
    rows = checked("apt-get", "indextargets", "--format", "$(CODENAME) $(COMPONENT) $(REPO_URI)",
                   "Created-By: Packages")
    found = [row.split() for row in rows.splitlines()]
    lines = [f"deb {row[2]} {row[0]} main" for row in found if row[1:2] == ["main"] and row[0] in wanted]
    if not any(line.endswith(f" {suite} main") for line in lines):
        raise Unavailable(f"this machine has no package source of Debian {suite}")
    return lines


class Images:
    """Builds images and runs commands in them. Everything lies below one temporary folder."""

    def __init__(self):
        for tool in ("buildah", "mmdebstrap"):
            if shutil.which(tool) is None:
                raise Unavailable(f"{tool} is not installed")
        if os.geteuid() != 0:
            raise Unavailable("making a root file system needs root")
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="fieldcast-images-"))
        self.environment = {**os.environ, "TMPDIR": str(self.folder)}

    def remove(self):
        for command in (("rm", "--all"), ("rmi", "--all", "--force")):  # these undo what is still mounted
            subprocess.run(self.command(*command), capture_output=True, timeout=SLOW, check=False)
        shutil.rmtree(self.folder, ignore_errors=True)

    def command(self, *arguments):
        return ("buildah", "--root", str(self.folder / "root"), "--runroot", str(self.folder / "run"),
                "--storage-driver", "vfs", *arguments)

    def buildah(self, *arguments, seconds=SLOW):
        return checked(*self.command(*arguments), seconds=seconds).strip()

    def make_debian(self, suite, name):
        """A minimal Debian under the name of the image that a registry would have."""
        sources = package_sources(suite)
        container = self.buildah("from", "scratch")
        place = self.buildah("mount", container)
        try:
            checked("mmdebstrap", "--quiet", "--variant=minbase", "--mode=root", "--format=directory", *QUICKER, suite,
                    place, *sources)
        except Failed as problem:
            raise Unavailable(f"a root file system cannot be made here: {problem}") from problem
        self.buildah("umount", container)
        try:
            self.buildah(*self.in_container(container), "/bin/true")
        except Failed as problem:
            raise Unavailable(f"nothing can be run in a root file system here: {problem}") from problem
        self.buildah("commit", "--quiet", "--rm", container, name)

    def build(self, name, *arguments):
        self.buildah("bud", "--isolation", "chroot", "--network", "host", "--pull-never", "--format", "docker",
                     "-t", name, *arguments)

    def start(self, image):
        """A container of an image, in which commands can be run."""
        return self.buildah("from", "--pull-never", image)

    def settings(self, image):
        return json.loads(self.buildah("inspect", "--type", "image", image))["Docker"]["config"]

    @staticmethod
    def in_container(container, volumes=()):
        """Arguments of buildah before a command; volumes are (path here, path there)."""
        mounts = [word for here, there in volumes for word in ("-v", f"{here}:{there}")]
        return ("run", "--isolation", "chroot", "--network", "host", *mounts, container, "--")
