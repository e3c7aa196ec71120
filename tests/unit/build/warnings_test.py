# SPDX-License-Identifier: Apache-2.0
"""Warnings are errors for developers and CI only. Run in the root: python3 tests/unit/build/warnings_test.py"""
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

PROJECT = """
cmake_minimum_required(VERSION 3.25)
project(warned LANGUAGES CXX)
option(FIELDCAST_WERROR "" OFF)
include("{root}/cmake/Warnings.cmake")
add_executable(warned warned.cpp)
target_link_libraries(warned PRIVATE fieldcast_warnings)
"""
# A program on the path in place of the real one: notes how it was called, and configures nothing.
STUB = """#!/bin/sh
echo "$(basename "$0") $*" >>"{calls}"
case "$*" in *--preset*-DFIELDCAST_WERROR=ON*) mkdir -p build/release && : >build/release/build.ninja &&
    echo FIELDCAST_WERROR:BOOL=ON >build/release/CMakeCache.txt ;; esac
case "$*" in "--preset release") mkdir -p build/release && : >build/release/build.ninja &&
    echo FIELDCAST_WERROR:BOOL=OFF >build/release/CMakeCache.txt ;; esac
"""


class Warnings(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def cmake(self, *arguments):
        return subprocess.run(["cmake", *arguments], cwd=self.folder, capture_output=True, text=True, check=False)

    def test_switching_them_rebuilds_nothing_and_counts_from_then_on(self):
        (self.folder / "CMakeLists.txt").write_text(PROJECT.format(root=pathlib.Path.cwd()))
        source = self.folder / "warned.cpp"
        source.write_text("int main() { int never_used = 1; }\n")
        self.assertEqual(0, self.cmake("-S", ".", "-B", "build", "-G", "Ninja").returncode)
        built = self.cmake("--build", "build")
        self.assertEqual(0, built.returncode, built.stdout)
        self.assertIn("never_used", built.stdout, "it warns")
        self.assertEqual(0, self.cmake("-DFIELDCAST_WERROR=ON", "build").returncode)
        again = self.cmake("--build", "build")
        self.assertIn("no work to do", again.stdout)
        source.write_text(source.read_text() + "// changed\n")
        self.assertNotEqual(0, self.cmake("--build", "build").returncode)

    def calls_of(self, *commands):
        """How ./fieldcast calls cmake for these commands, one after the other in one folder."""
        shutil.copy("fieldcast", self.folder)
        (self.folder / "deps.txt").write_text("")
        tools = self.folder / "tools"
        tools.mkdir()
        calls = self.folder / "calls.txt"
        for name in ("cmake", "ctest"):
            (tools / name).write_text(STUB.format(calls=calls))
            (tools / name).chmod(0o755)
        for command in commands:
            subprocess.run(["./fieldcast", *command], cwd=self.folder, capture_output=True, check=False,
                           env={**os.environ, "PATH": f"{tools}:{os.environ['PATH']}"})
        return [line for line in calls.read_text().splitlines() if "--preset" in line and "--build" not in line
                and line.startswith("cmake")]

    def test_builds_of_users_only_warn(self):
        self.assertEqual(["cmake --preset release"], self.calls_of(["build"]))

    def test_tests_make_them_errors(self):
        self.assertEqual(["cmake --preset release -DFIELDCAST_WERROR=ON"], self.calls_of(["test", "--quick"]))

    def test_one_folder_does_not_go_back_and_forth(self):
        self.assertEqual(["cmake --preset release", "cmake --preset release -DFIELDCAST_WERROR=ON"],
                         self.calls_of(["build"], ["test", "--quick"], ["build"], ["test", "--quick"]))

    def test_presets_of_developers_have_them(self):
        presets = json.loads(pathlib.Path("CMakePresets.json").read_text())["configurePresets"]
        strict = {preset["name"]: preset.get("cacheVariables", {}).get("FIELDCAST_WERROR") for preset in presets}
        self.assertEqual({"base": None, "release": None, "dev": "ON", "tsan": "ON", "fuzz": "ON"}, strict)


if __name__ == "__main__":
    unittest.main()
