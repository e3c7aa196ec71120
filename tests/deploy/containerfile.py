# SPDX-License-Identifier: Apache-2.0
"""Reads container files, as far as ours go, and says what is wrong with them."""
import json
import re

INSTRUCTIONS = {"FROM", "RUN", "COPY", "WORKDIR", "USER", "ENV", "STOPSIGNAL", "HEALTHCHECK", "ENTRYPOINT", "CMD"}
STAGE = re.compile(r"^(\S+)(?: AS (\S+))?$", re.IGNORECASE)
INSTALL = re.compile(r"apt-get install((?: +-\S+)*)((?: +[a-z0-9][a-z0-9.+-]*)+)")


def instructions(text):
    """(word, rest) of each instruction; lines that end in a backslash go on."""
    lines = "\n".join(line for line in text.splitlines() if not line.startswith("#"))
    joined = re.sub(r"\\\n\s*", " ", lines)
    return [tuple(line.split(None, 1)) for line in joined.splitlines() if line.strip()]


def stages(text):
    """Name -> instructions of that stage."""
    found, name = {}, None
    for word, rest in instructions(text):
        if word == "FROM":
            match = STAGE.match(rest)
            name = match.group(2) if match and match.group(2) else str(len(found))
            found[name] = []
        elif name is not None:
            found[name].append((word, rest))
    return found


def base_image(text, name):
    """The image that a stage starts from."""
    starts = [STAGE.match(rest) for word, rest in instructions(text) if word == "FROM"]
    return next(match.group(1) for match in starts if match and match.group(2) == name)


def installed_packages(stage):
    return [package for word, rest in stage if word == "RUN"
            for match in INSTALL.finditer(rest) for package in match.group(2).split()]


def problems(text, exists):
    """`exists` says whether a path is in the build context."""
    found, known = [], set()
    for number, line in enumerate(instructions(text), 1):
        word, rest = line if len(line) == 2 else (line[0], "")
        if word not in INSTRUCTIONS or not rest:
            found.append(f"instruction {number}: {word}")
        if number == 1 and word != "FROM":
            found.append("the first instruction is FROM")
        if word == "FROM":
            match = STAGE.match(rest)
            known.add(match.group(2) if match else None)
        if word in ("ENTRYPOINT", "CMD") and not isinstance(parse_list(rest), list):
            found.append(f"{word} {rest}: no list, so signals would go to a shell")
        if word == "COPY":
            found += copy_problems(rest.split(), known, exists)
    return found


def parse_list(text):
    try:
        return json.loads(text)
    except json.JSONDecodeError:
        return None


def copy_problems(words, known_stages, exists):
    options = [word for word in words if word.startswith("--")]
    sources = [word for word in words if not word.startswith("--")][:-1]
    origins = [word.removeprefix("--from=") for word in options if word.startswith("--from=")]
    if origins:
        return [] if origins[0] in known_stages else [f"COPY --from={origins[0]}: there is no such stage"]
    return [f"COPY {source}: there is no such file" for source in sources if not exists(source)]
