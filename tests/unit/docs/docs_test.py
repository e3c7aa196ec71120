# SPDX-License-Identifier: Apache-2.0
"""Holds the documents to what they promise. Run in the root: python3 tests/unit/docs/docs_test.py"""
import pathlib
import unittest

import promises

NOT_OURS = {"build", "out", "third_party", "node_modules"}
FLAG_SOURCES = {
    "server": sorted(p.as_posix() for p in pathlib.Path("server/command_line").glob("*flags.cpp")),
    "client": ["client/options.cpp"],
    "load": ["client/load_options.cpp"],
    "bench": sorted(p.as_posix() for p in pathlib.Path("bench").rglob("*.cpp")),
}
FIRST_DOCUMENTS = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "docs/architecture.md", "docs/lightfield.md",
                   "docs/protocol.md", "docs/operations.md", "docs/security.md", "docs/benchmarks.md", "docs/known_artefacts.md"]

DECISION_SECTIONS = ["Context", "Decision", "Consequences", "What would change it"]


def read(path):
    return pathlib.Path(path).read_text(encoding="utf-8")


def documents():
    for path in sorted(pathlib.Path(".").rglob("*.md")):
        if not any(part in NOT_OURS or part.startswith(".") for part in path.parts):
            yield path


class Documents(unittest.TestCase):
    def test_are_there(self):
        found = {path.as_posix() for path in documents()}
        self.assertEqual(set(), set(FIRST_DOCUMENTS) - found, "run in the root of the repository")

    def test_links_lead_somewhere(self):
        broken = [f"{path}: {target}" for path in documents() for target in promises.links(read(path))
                  if not (path.parent / target).exists()]
        self.assertEqual([], broken)

    def test_links_stay_inside(self):
        root = pathlib.Path(".").resolve()
        outside = [f"{path}: {target}" for path in documents() for target in promises.links(read(path))
                   if not (path.parent / target).resolve().is_relative_to(root)]
        self.assertEqual([], outside)

    def test_anchors_exist(self):
        broken = [f"{path}: {target}#{anchor}" for path in documents()
                  for target, anchor in promises.anchored_links(read(path))
                  if anchor not in promises.anchors(read(path.parent / target if target else path))]
        self.assertEqual([], broken)

    def test_decisions_have_one_form(self):
        pages = sorted(pathlib.Path("docs/decisions").glob("[!R]*.md"))
        self.assertEqual([f"{number:04d}" for number in range(1, len(pages) + 1)], [page.name[:4] for page in pages])
        for page in pages:
            with self.subTest(page.name):
                self.assertTrue(read(page).startswith(f"# {page.name[:4]} "))
                self.assertEqual(DECISION_SECTIONS, promises.section_names(read(page)))

    def test_commands_are_in_the_help(self):
        known = promises.help_commands(read("fieldcast"))
        self.assertIn("demo", known)
        unknown = [f"{path}: ./fieldcast {command}" for path in documents()
                   for command in sorted(promises.script_commands(read(path)) - known)]
        self.assertEqual([], unknown)

    def test_every_flag_of_the_server_is_explained(self):
        table = promises.table_flags(read("docs/operations.md"))
        defined = promises.defined_flags("".join(map(read, FLAG_SOURCES["server"])))
        self.assertEqual(set(), defined - promises.GIVEN_FLAGS - table)

    def test_flags_exist(self):
        known = {program: promises.defined_flags("".join(map(read, files))) for program, files in FLAG_SOURCES.items()}
        unknown = [f"{path}: fieldcast-{program} {flag}" for path in documents()
                   for program, flag in sorted(promises.program_flags(read(path))) if flag not in known[program]]
        self.assertEqual([], unknown)
        self.assertNotEqual(set(), promises.program_flags(read("README.md")), "README shows how to call the programs")


    def test_every_attack_is_in_the_table(self):
        defined, _ = promises.scenarios("".join(map(read, sorted(pathlib.Path("tests/hostile/scenarios").glob("*.py")))))
        _, listed = promises.scenarios(read("docs/security.md"))
        self.assertEqual({f"`{name}`" for name in defined}, listed)
        self.assertIn("garbage", defined)


class Promises(unittest.TestCase):
    def test_links(self):
        text = '[a](docs/a.md#part) ![b](b.png "title") [c](https://example.org) [d](#here) <img src="d.png">'
        self.assertEqual(["docs/a.md", "b.png", "d.png"], promises.links(text))
        self.assertEqual([], promises.links("`view[i](x)`\n```\n[a](b)\n```\n"))

    def test_anchors(self):
        self.assertEqual([("a.md", "part"), ("", "here")], promises.anchored_links("[a](a.md#part) [b](#here) [c](d.md)"))
        page = "# One, two\n## `code` of [it](x.md)\n```\n# no heading\n```\n"
        self.assertEqual({"one-two", "code-of-it"}, promises.anchors(page))
        self.assertEqual(["B"], promises.section_names("# A\n## B\n### C\n"))

    def test_commands(self):
        self.assertEqual({"demo", "test"}, promises.script_commands("`./fieldcast demo`, ./fieldcast test --quick"))
        script = "print_help() {\n    cat <<'END'\n  setup [--check]  text\n           more text\n  demo   x\n\nExamples:\n" \
                 "  ./fieldcast gone\nEND\n}\n"
        self.assertEqual({"setup", "demo"}, promises.help_commands(script))

    def test_scenarios(self):
        self.assertEqual({"a-b"}, promises.scenarios('    Scenario("a-b", 1, "x", f),\n')[0])
        table = "| threat | bound | scenario |\n|---|---|---|\n| x `y` | z | `a`, `b-c` |\n| no | `d` |\n"
        self.assertEqual({"`a`", "`b-c`"}, promises.scenarios(table)[1])

    def test_tables(self):
        self.assertEqual({"--a", "--b-c"}, promises.table_flags("| `--a FILE` | x |\n`--d`\n| `--b-c` | `--e` |\n"))

    def test_flags(self):
        text = "build/fieldcast-server --scene a.gltf \\\n    --size 1x1   # --not-a-flag\n`fieldcast-client --grid 3x3` --other"
        self.assertEqual({("server", "--scene"), ("server", "--size"), ("client", "--grid")},
                         promises.program_flags(text))
        self.assertEqual({"--grid", "--no-nee", "--help"}, promises.defined_flags('f("--grid", x); f("!--no-nee", y);'))


if __name__ == "__main__":
    unittest.main()
