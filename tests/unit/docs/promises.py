# SPDX-License-Identifier: Apache-2.0
"""What the documents promise and where it is kept: links, commands of ./fieldcast, flags of the programs.

Each function takes text and returns values, so that it can be tested without a tree.
"""
import re

LINK = re.compile(r"!?\[[^\]]*\]\(\s*<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)")
IMAGE_TAG = re.compile(r"<(?:img|a)\b[^>]*\b(?:src|href)=\"([^\"]+)\"", re.IGNORECASE)
SCHEME = re.compile(r"^(?:[a-z][a-z0-9+.-]*:|//)", re.IGNORECASE)
FENCE = re.compile(r"^(```|~~~).*?^\1[ \t]*$", re.MULTILINE | re.DOTALL)
CODE_SPAN = re.compile(r"`[^`\n]*`")
HEADING = re.compile(r"^#{1,6} (.+?)\s*$", re.MULTILINE)
SCRIPT_COMMAND = re.compile(r"\./fieldcast[ \t]+([a-z][a-z-]*)")
HELP_COMMAND = re.compile(r"^  ([a-z][a-z-]*)\b", re.MULTILINE)
PROGRAM_CALL = re.compile(r"fieldcast-(server|client|bench|load)\b([^`\n|]*)")
FLAG = re.compile(r"(?<![\w-])(--[a-z][a-z0-9-]*)")
DEFINED_FLAG = re.compile(r"\"!?(--[a-z][a-z0-9-]*)\"")
TABLE_FLAG = re.compile(r"^\| `(--[a-z][a-z0-9-]*)", re.MULTILINE)
SCENARIO = re.compile(r"\bScenario\(\"([a-z0-9-]+)\"")
SCENARIO_ROW = re.compile(r"^\|(?:[^|\n]*\|){2}([^|\n]*)\|[ \t]*$", re.MULTILINE)
GIVEN_FLAGS = {"--help"}  # the argument parser's own


def links(text):
    """Targets of links and images outside of code, without their #anchors; addresses with a scheme are left out."""
    prose = CODE_SPAN.sub("", FENCE.sub("", text))
    targets = [target.split("#")[0] for target in LINK.findall(prose) + IMAGE_TAG.findall(prose)
               if not SCHEME.match(target)]
    return [target for target in targets if target]


def anchored_links(text):
    """(target, anchor) of links with an #anchor, outside of code; the target of a link within its page is empty."""
    prose = CODE_SPAN.sub("", FENCE.sub("", text))
    pairs = [target.split("#", 1) for target in LINK.findall(prose) if "#" in target and not SCHEME.match(target)]
    return [(target, anchor) for target, anchor in pairs]


def anchors(text):
    """The anchors of a page's headings: lower case, letters, digits, hyphens and underscores, blanks as hyphens."""
    headings = HEADING.findall(FENCE.sub("", text))
    plain = [re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).strip().lower() for heading in headings]
    return {re.sub(r"[^\w\- ]", "", heading).replace(" ", "-") for heading in plain}


def section_names(text):
    """The headings of the second level, in order."""
    return re.findall(r"^## (.+?)\s*$", FENCE.sub("", text), re.MULTILINE)


def script_commands(text):
    return set(SCRIPT_COMMAND.findall(text))


def help_commands(script):
    """Commands that `./fieldcast help` names, read from the script's own text."""
    found = re.search(r"^print_help\(\) \{\n(.*?)^END$", script, re.MULTILINE | re.DOTALL)
    body = found.group(1).partition("\nExamples:")[0] if found else ""
    return set(HELP_COMMAND.findall(body))


def scenarios(text):
    """Names of attacks: of sources those that are defined, of a document those in the third column of a table."""
    return set(SCENARIO.findall(text)), {name for row in SCENARIO_ROW.findall(text) for name in CODE_SPAN.findall(row)}


def program_flags(text):
    """(program, flag) for every flag in a call of one of our programs. A backslash continues a call."""
    joined = re.sub(r"\\\n\s*", " ", text)
    return {(program, flag) for program, rest in PROGRAM_CALL.findall(joined)
            for flag in FLAG.findall(rest.split(" #")[0])}


def table_flags(text):
    """Flags in the first column of a table."""
    return set(TABLE_FLAG.findall(text))


def defined_flags(source):
    """Flags that C++ source gives to the argument parser."""
    return set(DEFINED_FLAG.findall(source)) | GIVEN_FLAGS
