# SPDX-License-Identifier: Apache-2.0
"""Rules of the source tree: who may include whom, which folder knows which library, names and budgets.

Each check takes lines of text and returns problems, one string per problem, so that it can be tested without a tree.
"""
import re

# Folder -> folders of core that it may include, besides itself. Completed transitively from the arrows of
# docs/architecture.md: base <- lightfield <- {image, codec}; base <- gpu; {gpu, image, lightfield, codec} <- scene;
# {gpu, scene, lightfield} <- render; {lightfield, codec} <- wire; image <- report.
CORE = {
    "core/base": set(),
    "core/lightfield": {"core/base"},
    "core/timing": {"core/base", "core/lightfield"},
    "core/image": {"core/base", "core/lightfield"},
    "core/report": {"core/base", "core/lightfield", "core/image"},
    "core/codec": {"core/base", "core/lightfield"},
    "core/gpu": {"core/base"},
    "core/scene": {"core/base", "core/lightfield", "core/image", "core/codec", "core/gpu"},
    "core/render": {"core/base", "core/lightfield", "core/gpu", "core/scene"},
    "core/wire": {"core/base", "core/lightfield", "core/codec"},
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
    "nlohmann/": ("core/scene", "bench", "server/ops", "client"),
    "embree": ("core/scene", "bench"),
    "meshoptimizer": ("core/scene",),
    "boost/": ("server/web",),
    "openssl/": ("core/scene", "server/access", "server/listener"),
    "toml": ("core/base",),
    "spdlog/": ("core/base",),
    "grpc": ("server/service", "client/net", "bench/fanout"),
    "fieldcast/v1/": ("core/wire", "server/recording", "server/session", "server/service", "client/net", "bench/fanout"),
    "google/protobuf/": ("core/wire", "server/recording", "server/service", "client/net"),
    "nats": ("server/bus",),
    "prometheus/": ("server/ops",),
    "GLFW/": ("client/sink",),
    "CLI/": ("server/", "server/ops", "client/", "bench/"),  # programs and their flags
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


def direction_problem(path, target):
    """`target` is an include path that starts at the root of the tree."""
    top, target_top = path.split("/")[0], target.split("/")[0]
    folder, target_folder = folder_of(path), folder_of(target)
    if target_top == "core":
        if top == "core" and folder != target_folder and target_folder not in CORE.get(folder, set()):
            return f"{folder} may not include {target_folder}"
    elif target_top in ("server", "client", "bench") and target_top != top:
        return f"{top} may not include {target_top}"
    elif target_top == "shaders" and not any(is_inside(path, user) for user in SHADER_USERS):
        return f"{folder} may not include shaders"
    return None


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
