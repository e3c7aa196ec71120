# SPDX-License-Identifier: Apache-2.0
"""Applies the rules to every source file of the tree. Run in the root: python3 tests/unit/tree/tree_test.py"""
import pathlib
import unittest

import rules

CXX_FOLDERS = ("core", "report", "server", "client", "bench")
ALL_FOLDERS = CXX_FOLDERS + ("tests", "shaders", "proto", "cmake")
SOURCES = {".h", ".cpp", ".comp", ".glsl", ".proto", ".py", ".cmake"}
LICENSED_NAMES = {"CMakeLists.txt"}


def files(folders, suffixes=SOURCES):
    """(path from the root, lines) of every source file."""
    for folder in folders:
        for path in sorted(pathlib.Path(folder).rglob("*")):
            is_built = any(part in ("node_modules", "build", "__pycache__") for part in path.parts)
            if path.is_file() and not is_built and (path.suffix in suffixes or path.name in LICENSED_NAMES):
                yield path.as_posix(), path.read_text(encoding="utf-8").splitlines()


def cxx_files(folders):
    return files(folders, {".h", ".cpp"})


class Tree(unittest.TestCase):
    def expect_none(self, problems):
        self.assertEqual([], problems, "\n" + "\n".join(problems))

    def test_is_found(self):
        self.assertGreater(len(list(cxx_files(CXX_FOLDERS))), 20, "run in the root of the repository")

    def test_includes_follow_the_arrows(self):
        self.expect_none([p for path, lines in cxx_files(CXX_FOLDERS) for p in rules.include_problems(path, lines)])

    def test_every_folder_has_its_place(self):
        rooms = {rules.room_of(path) for path, _ in cxx_files(CXX_FOLDERS) if path.endswith((".h", ".cpp"))}
        programs = {"server", "client"}
        self.assertEqual(set(rules.FOLDERS), rooms - programs, "FOLDERS lists the folders that there are")

    def test_units_do_not_include_each_other(self):
        self.expect_none(rules.cycle_problems(dict(cxx_files(CXX_FOLDERS))))

    def test_libraries_are_used(self):
        targets = {match.group(1) for _, lines in cxx_files(CXX_FOLDERS)
                   for match in map(rules.INCLUDE.match, lines) if match}
        self.assertEqual([], [start for start in rules.LIBRARIES if not any(t.startswith(start) for t in targets)])

    def test_names_say_something(self):
        self.expect_none([p for path, _ in files(ALL_FOLDERS) for p in rules.name_problems(path)])

    def test_every_file_names_its_licence(self):
        self.expect_none([p for path, lines in files(ALL_FOLDERS) for p in rules.licence_problems(path, lines)])

    def test_headers_are_guarded(self):
        folders = CXX_FOLDERS + ("tests",)
        self.expect_none([p for path, lines in cxx_files(folders) for p in rules.header_problems(path, lines)])

    def test_tests_wait_for_events(self):
        self.expect_none([p for path, lines in files(("tests",)) for p in rules.sleep_problems(path, lines)])
        self.assertEqual([], [path for path in rules.SLEEPERS if not pathlib.Path(path).exists()])

    def test_files_and_functions_fit_the_budget(self):
        for path, lines in cxx_files(CXX_FOLDERS):
            for line in rules.long_functions(path, lines):
                print("over 40 lines, needs a reason:", line)
        self.expect_none([p for path, lines in cxx_files(CXX_FOLDERS) for p in rules.size_problems(path, lines)])

    def test_mains_of_shaders_are_lists_of_steps(self):
        shaders = list(files(("shaders",), {".comp", ".vert", ".frag"}))
        self.assertGreater(len(shaders), 20)
        self.expect_none([p for path, lines in shaders for p in rules.shader_main_problems(path, lines)])


class Rules(unittest.TestCase):
    def includes(self, path, target):
        return rules.include_problems(path, [f'#include "{target}"'])

    def test_shader_mains(self):
        short = ["void main() {", *["    step();"] * 28, "}"]
        self.assertEqual([], rules.shader_main_problems("a.comp", short))
        self.assertEqual(1, len(rules.shader_main_problems("a.comp", short[:1] + ["    step();"] + short[1:])))

    def test_arrows(self):
        self.assertEqual([], self.includes("core/scene/bvh.cpp", "core/gpu/buffer.h"))
        self.assertEqual([], self.includes("core/image/quilt.h", "core/base/error.h"))
        self.assertEqual([], self.includes("core/image/quilt.cpp", "core/image/quilt.h"))
        self.assertEqual([], self.includes("server/main.cpp", "core/render/views/grid_renderer.h"))
        self.assertEqual([], self.includes("client/play/play.cpp", "client/net/client_session.h"))
        self.assertEqual([], self.includes("bench/pages/page.cpp", "report/chart.h"))
        self.assertEqual([], self.includes("server/config/a.cpp", "server/channel/settings.h"))
        self.assertTrue(self.includes("server/channel/a.cpp", "server/config/config.h"))
        self.assertTrue(self.includes("server/session/a.cpp", "server/service/grpc_server.h"))
        self.assertTrue(self.includes("client/net/a.cpp", "client/play/play.h"))
        self.assertTrue(self.includes("core/scene/gltf/a.cpp", "core/render/kernels.h"))
        self.assertTrue(self.includes("core/render/denoise/a.cpp", "core/render/views/reflections.h"))
        self.assertTrue(self.includes("server/session/a.cpp", "report/chart.h"))
        self.assertIn("core/gpu may not include core/lightfield",
                      self.includes("core/gpu/buffer.h", "core/lightfield/camera.h")[0])
        self.assertTrue(self.includes("core/image/quilt.h", "core/codec/plane_codec.h"))
        self.assertTrue(self.includes("core/render/pass.h", "core/wire/chunks.h"))
        self.assertTrue(self.includes("core/base/log.h", "server/config/config.h"))
        self.assertTrue(self.includes("server/main.cpp", "client/net/client_session.h"))
        self.assertTrue(self.includes("client/main.cpp", "server/session/mailbox.h"))
        self.assertTrue(self.includes("server/session/a.h", "shaders/shared/scene.h"))
        self.assertTrue(self.includes("core/image/quilt.cpp", "../base/log.h"))

    def test_cycles(self):
        def problems(**includes):
            return rules.cycle_problems({f"core/{name.replace('_', '.')}": [f'#include "core/{t}"' for t in targets]
                                         for name, targets in includes.items()})
        self.assertEqual([], problems(a_cpp=["a.h", "b.h"], a_h=[], b_h=[]))
        self.assertEqual(["these include each other: core/a, core/b"],
                         problems(a_cpp=["a.h", "b.h"], a_h=[], b_h=["a.h"], c_h=["a.h"]))
        self.assertEqual(1, len(problems(a_h=["b.h"], b_h=["c.h"], c_cpp=["a.h"], c_h=[])))

    def test_libraries(self):
        self.assertEqual([], self.includes("core/gpu/device.h", "vulkan/vulkan.h"))
        self.assertTrue(self.includes("core/render/pass.cpp", "vulkan/vulkan.h"))
        self.assertEqual([], self.includes("server/main.cpp", "CLI/CLI.hpp"))
        self.assertTrue(self.includes("server/session/mailbox.cpp", "CLI/CLI.hpp"))
        self.assertEqual([], self.includes("client/net/client_session.cpp", "grpcpp/grpcpp.h"))
        self.assertTrue(self.includes("core/wire/chunks.cpp", "grpcpp/grpcpp.h"))
        self.assertEqual([], self.includes("server/web/endpoint.cpp", "boost/asio/write.hpp"))
        self.assertTrue(self.includes("server/metrics/page.cpp", "boost/asio/write.hpp"))
        self.assertEqual([], self.includes("core/wire/chunks.cpp", "fieldcast/v1/frame.pb.h"))
        self.assertEqual(1, len(self.includes("core/render/a.cpp", "OpenImageIO/imageio.h")))

    def test_names(self):
        self.assertEqual([], rules.name_problems("core/image/quilt.h"))
        for name in ("core/utils/a.h", "core/image/image_helpers.cpp", "server/session_manager.h", "core/common.h"):
            self.assertTrue(rules.name_problems(name), name)

    def test_headers(self):
        self.assertEqual([], rules.header_problems("a.h", ["// SPDX", "#pragma once"]))
        self.assertEqual(2, len(rules.header_problems("a.h", ["using namespace std;"])))
        self.assertTrue(rules.licence_problems("a.h", ["#pragma once"]))

    def test_sleeps(self):
        for call in ("sleep_for", "sleep_until", "usleep", "nanosleep", "time.sleep", "asyncio.sleep"):
            self.assertEqual(1, len(rules.sleep_problems("tests/system/a.cpp", ["", f"    {call}(x);"])), call)
        for text in ("std::this_thread::" + "yield();", "from time " + "import monotonic, sleep", "poll" + "(nullptr, 0, 20);"):
            self.assertTrue(rules.sleep_problems("tests/bench/a.py", [text]), text)
        for text in ("Without subscribers a channel sleeps.", "poll(ends.data(), 2, 20);", "EXPECT_TRUE(sleeps(feed));"):
            self.assertEqual([], rules.sleep_problems("tests/system/a.cpp", [text]))
        self.assertEqual([], rules.sleep_problems("tests/fixtures/polling.h", [f"    {'sleep_for'}(kLookInterval);"]))
        self.assertTrue(rules.sleep_problems("tests/fixtures/polling.h", ["nothing"]), "the list holds who needs it only")

    def test_function_lengths(self):
        text = ["namespace a {", "struct B {", "    int c;", "};", "int f(int a,", "      int b) {", "    return a;", "}",
                "void g() {", *["    h();"] * 60, "}", "} // namespace a"]
        self.assertEqual([(5, 4), (9, 62)], [found[:2] for found in rules.functions(text)])
        table = ["const Table& t() {", "    return {", *['        {"a", 1},'] * 100, "    };", "}"]
        self.assertEqual([(1, 4)], [found[:2] for found in rules.functions(table)])
        self.assertEqual(1, len(rules.size_problems("a.cpp", text)))
        self.assertEqual(1, len(rules.size_problems("a.cpp", [""] * 401)))


if __name__ == "__main__":
    unittest.main()
