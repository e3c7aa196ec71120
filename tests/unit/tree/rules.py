# SPDX-License-Identifier: Apache-2.0
"""Rules of the source tree: who may include whom, which folder knows which library, names and budgets.

Each check takes lines of text and returns problems, one string per problem, so that it can be tested without a tree.
"""
import re

# Folder -> folders of its part that it may include, besides itself; docs/architecture.md draws this. The longest prefix
# of a path counts: core/render/views is a room of its own, and all of core/wire is one.
FOLDERS = {
    "core/base": set(),
    "core/lightfield": {"core/base"},
    "core/timing": {"core/base", "core/lightfield"},
    "core/image": {"core/base", "core/lightfield"},
    "core/codec": {"core/base", "core/lightfield"},
    "core/gpu": {"core/base"},
    "core/scene": {"core/base", "core/lightfield", "core/image", "core/codec", "core/gpu", "core/scene/gltf"},
    "core/scene/gltf": {"core/base", "core/lightfield", "core/image", "core/codec", "core/scene"},
    "core/render": {"core/base", "core/lightfield", "core/gpu", "core/scene", "core/render/source", "core/render/views"},
    "core/render/denoise": {"core/base", "core/lightfield", "core/gpu", "core/scene", "core/render"},
    "core/render/source": {"core/base", "core/lightfield", "core/gpu", "core/scene", "core/render", "core/render/denoise"},
    "core/render/views": {"core/base", "core/lightfield", "core/gpu", "core/scene", "core/render", "core/render/denoise",
                          "core/render/source"},
    "core/render/warp": {"core/base", "core/lightfield", "core/gpu", "core/scene", "core/render", "core/render/source",
                         "core/render/views"},
    "core/wire": {"core/base", "core/lightfield", "core/codec"},
    "server/access": set(),
    "server/feed": set(),
    "server/listener": set(),
    "server/metrics": set(),
    "server/camera": {"server/feed", "server/metrics"},
    "server/recording": {"server/feed", "server/metrics"},
    "server/session": {"server/feed"},
    "server/web": {"server/access"},
    "server/service": {"server/access", "server/feed", "server/listener", "server/metrics", "server/session"},
    "server/channel": {"server/camera", "server/feed", "server/metrics", "server/recording"},
    "server/config": {"server/access", "server/channel", "server/feed", "server/service", "server/session"},
    "server/command_line": {"server/access", "server/channel", "server/config", "server/service"},
    "client/net": set(),
    "client/play": {"client/net"},
    "client/load": {"client/net"},
    "bench": {"bench/fanout", "bench/pages", "bench/quality", "bench/speed"},
    "bench/fanout": {"bench"},
    "bench/pages": {"bench"},
    "bench/quality": {"bench", "bench/pages"},
    "bench/speed": {"bench", "bench/fanout", "bench/pages"},
    "report": set(),
}
# Part of the tree -> parts that it may include. Within core, FOLDERS says which folders.
PARTS = {
    "core": set(),
    "report": {"core"},
    "server": {"core"},
    "client": {"core", "report"},
    "bench": {"core", "report"},
}
SHADER_USERS = ("core/scene", "core/render", "core/gpu", "bench")  # structs shared with GLSL, compiled kernels

# Start of an include path -> folders that may know the library. A folder ending in "/" means only files directly in it.
LIBRARIES = {
    "vulkan/": ("core/gpu",),
    "zstd": ("core/codec",),
    "jpeglib": ("core/codec",),
    "wels/": ("core/codec",),
    "OpenImageIO/": ("core/image",),
    "webp/": ("core/image",),
    "zlib": ("core/image",),
    "tiny_gltf": ("core/scene",),
    "nlohmann/": ("core/scene", "bench", "server/command_line", "client"),
    "embree": ("core/scene", "bench"),
    "meshoptimizer": ("core/scene",),
    "draco/": ("core/scene",),
    "boost/": ("server/web",),
    "openssl/": ("core/scene", "server/access", "server/listener"),
    "toml": ("core/base",),
    "spdlog/": ("core/base",),
    "grpc": ("server/service", "client/net", "bench/fanout"),
    "fieldcast/v1/": ("core/wire", "server/recording", "server/session", "server/service", "client/net", "bench/fanout"),
    "google/protobuf/": ("core/wire", "server/recording", "server/service", "client/net"),
    "CLI/": ("server/", "server/command_line", "client/", "bench"),  # programs and their flags
}

TABLE_ROW = re.compile(r"\s+\{.*\},?$")
FORBIDDEN_NAMES = {"utils", "util", "common", "helpers", "helper", "misc", "manager"}

# Tests wait for events with a deadline. Files that may let time pass all the same, and why.
SLEEPERS = {
    "tests/hostile/waiting.py": "measures others meanwhile, and looks at what has no event; for all scenarios",
    "tests/server/frame_time.h": "stands for the time that a frame takes on a device which is not there",
    "tests/fixtures/polling.h": "looks at what has no event, again and again until a deadline; for all tests",
}
SLEEP = re.compile(r"\b(sleep|sleep_for|sleep_until|usleep|nanosleep)\s*\(|this_thread::(yield)|\bpoll\(nullptr"
                   r"|\bselect\(\[\], \[\], \[\]|\bfrom (time|asyncio) import .*\bsleep\b")

MAX_FILE_LINES = 400
MAX_FUNCTION_LINES = 60  # 40 without a reason; those between are reported
GOOD_FUNCTION_LINES = 40
MAX_SHADER_MAIN_LINES = 30  # a kernel's main reads as the list of its steps

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')
NO_FUNCTION = re.compile(r"(namespace|struct|class|enum|union|using|typedef|extern|static_assert|SHARED_)\b|[#/})]|template")


def folder_of(path):
    """core/image/quilt.h -> core/image; server/main.cpp -> server."""
    return "/".join(path.split("/")[:-1][:2])


def is_inside(path, folder):
    return path.rpartition("/")[0] + "/" == folder if folder.endswith("/") else path.startswith(folder + "/")


def room_of(path):
    """core/render/views/a.h -> core/render/views; server/main.cpp -> server, where programs may include everything."""
    folder = path.rpartition("/")[0]
    while folder not in FOLDERS and "/" in folder:
        folder = folder.rpartition("/")[0]
    return folder


def direction_problem(path, target):
    """`target` is an include path that starts at the root of the tree."""
    part, target_part = path.split("/")[0], target.split("/")[0]
    room, target_room = room_of(path), room_of(target)
    if part in PARTS and target_part in PARTS and part != target_part:
        return None if target_part in PARTS[part] else f"{part} may not include {target_part}"
    if part == target_part and room != target_room and room in FOLDERS and target_room not in FOLDERS[room]:
        return f"{room} may not include {target_room}"
    if target_part == "shaders" and not any(is_inside(path, user) for user in SHADER_USERS):
        return f"{folder_of(path)} may not include shaders"
    return None


def units(files):
    """`files`: path -> lines. A unit is a header with its source; unit -> units that either of them includes."""
    found = {path.rpartition(".")[0]: set() for path in files}
    for path, lines in files.items():
        unit = path.rpartition(".")[0]
        targets = (match.group(1).rpartition(".")[0] for match in map(INCLUDE.match, lines) if match)
        found[unit].update(target for target in targets if target in found and target != unit)
    return found


def reachable(graph, start):
    seen, ahead = set(), list(graph[start])
    while ahead:
        unit = ahead.pop()
        if unit not in seen:
            seen.add(unit)
            ahead.extend(graph[unit])
    return seen


def cycle_problems(files):
    """Units that include each other in a circle can neither be read nor tested one by one."""
    graph = units(files)
    reached = {unit: reachable(graph, unit) for unit in graph}
    circles = {frozenset({unit} | {other for other in reached[unit] if unit in reached[other]})
               for unit in graph if unit in reached[unit]}
    return ["these include each other: " + ", ".join(sorted(circle)) for circle in circles]


def include_problems(path, lines):
    problems = []
    for number, line in enumerate(lines, 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        target = match.group(1)
        found = direction_problem(path, target)
        for start, folders in LIBRARIES.items():
            if target.startswith(start) and not any(is_inside(path, folder) for folder in folders):
                found = f"<{target}> belongs to {', '.join(folders)}"
        if target.startswith(".") or "/../" in target:
            found = "include paths start at the root of the tree"
        if found:
            problems.append(f"{path}:{number}: {found}")
    return problems


def name_problems(path):
    """No folder or file name may consist of, or end in, a word that says nothing."""
    problems = []
    for part in path.split("/"):
        words = re.split(r"[_\-]", part.split(".")[0].lower())
        if words[0] in FORBIDDEN_NAMES or words[-1] in FORBIDDEN_NAMES:
            problems.append(f"{path}: '{part}' means the noun was not found")
    return problems


def licence_problems(path, lines):
    good = any("SPDX-License-Identifier: Apache-2.0" in line for line in lines[:3])
    return [] if good else [f"{path}: no SPDX line at the top"]


def header_problems(path, lines):
    if not path.endswith(".h"):
        return []
    problems = [] if "#pragma once" in lines else [f"{path}: no #pragma once"]
    return problems + [f"{path}: using namespace in a header" for line in lines if re.match(r"\s*using namespace", line)]


def sleep_problems(path, lines):
    """A test that sleeps is slow on an idle machine and fails on a busy one."""
    found = [number for number, line in enumerate(lines, 1) if SLEEP.search(line)]
    if path in SLEEPERS:
        return [] if found else [f"{path}: does not sleep any more, take it off the list"]
    return [f"{path}:{number}: a test waits for an event with a deadline, see tests/fixtures/polling.h"
            for number in found]


def functions(lines):
    """(first line, line count, first line's text) of each function at namespace level of a formatted file.

    Rows of a table of values, such as {"a", 1}, are data and do not count.
    """
    found, start, rows = [], None, 0
    for number, line in enumerate(lines, 1):
        if line == "}" and start is not None:
            found.append((start, number - start + 1 - rows, lines[start - 1]))
            start = None
        elif line[:1].strip() and not (start is not None and line.startswith(")")):
            start, rows = (None if NO_FUNCTION.match(line) else number), 0
        elif TABLE_ROW.match(line):
            rows += 1
    return found


def size_problems(path, lines):
    problems = []
    if len(lines) > MAX_FILE_LINES:
        problems.append(f"{path}: {len(lines)} lines, at most {MAX_FILE_LINES}")
    for start, count, text in functions(lines):
        if count > MAX_FUNCTION_LINES:
            problems.append(f"{path}:{start}: {count} lines, at most {MAX_FUNCTION_LINES}: {text.strip()}")
    return problems


def shader_main_problems(path, lines):
    return [f"{path}:{start}: main has {count} lines, at most {MAX_SHADER_MAIN_LINES}"
            for start, count, text in functions(lines) if text.startswith("void main()") and count > MAX_SHADER_MAIN_LINES]


def long_functions(path, lines):
    return [f"{path}:{start}: {count} lines: {text.strip()}" for start, count, text in functions(lines)
            if GOOD_FUNCTION_LINES < count <= MAX_FUNCTION_LINES]
