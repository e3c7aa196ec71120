#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes shared_layout.comp and shared_layout.h: every struct of the given shared headers, for both compilers.

Usage: generate_layout.py OUTPUT_DIR HEADER...
"""
import pathlib
import re
import sys

STRUCT = re.compile(r"^struct (\w+) \{\n(.*?)^\};", re.MULTILINE | re.DOTALL)
MEMBER = re.compile(r"^(\w+) (\w+)((?:\[\w+\])*);$")
COMMENT = re.compile(r"//.*")


def structs_of(header):
    """Pairs (struct, member names) of one header. Stops at lines it does not understand."""
    text = COMMENT.sub("", header.read_text(encoding="utf-8"))
    found = []
    for name, body in STRUCT.findall(text):
        members = []
        for line in filter(None, map(str.strip, body.splitlines())):
            match = MEMBER.match(line)
            if not match:
                sys.exit(f"{header}: struct {name}: expected one `type name;` per line, found: {line}")
            members.append(match.group(2))
        found.append((name, members))
    if len(found) != len(re.findall(r"\bstruct\s+\w+\s*\{", text)):
        sys.exit(f"{header}: a struct does not have the form `struct Name {{`, members on lines of their own, `}};`")
    return found


def kernel_text(headers, structs):
    lines = ["#version 460", "#extension GL_GOOGLE_include_directive : require"]
    lines += [f'#include "shared/{header.name}"' for header in headers]
    lines += [f"SHARED_BUFFER(Probe{name}, {name});" for name, _ in structs]
    lines += ["layout(local_size_x = 1) in;", "layout(push_constant) uniform Push { uint64_t address; };"]
    lines += ["void main() {"]
    lines += [f"    Probe{name}(address).at[0] = Probe{name}(address).at[1];" for name, _ in structs]
    return "\n".join(lines + ["}", ""])


def table_text(headers, structs):
    lines = ["#pragma once", '#include "tests/gpu/struct_layout.h"', "#include <cstddef>"]
    lines += [f'#include "shaders/shared/{header.name}"' for header in headers]
    lines += ["namespace fieldcast::shared {"]
    lines += ["inline const std::vector<gpu::StructLayout> kSharedStructs = {"]
    for name, members in structs:
        offsets = ", ".join(f'{{"{member}", offsetof({name}, {member})}}' for member in members)
        lines += [f'    {{"{name}", sizeof({name}), {{{offsets}}}}},']
    return "\n".join(lines + ["};", "} // namespace fieldcast::shared", ""])


def main():
    output = pathlib.Path(sys.argv[1])
    headers = sorted(pathlib.Path(argument) for argument in sys.argv[2:])
    structs = [struct for header in headers for struct in structs_of(header)]
    output.mkdir(parents=True, exist_ok=True)
    (output / "shared_layout.comp").write_text(kernel_text(headers, structs), encoding="utf-8")
    (output / "shared_layout.h").write_text(table_text(headers, structs), encoding="utf-8")


main()
