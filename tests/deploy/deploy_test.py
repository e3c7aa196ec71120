# SPDX-License-Identifier: Apache-2.0
"""Checks the files of deploy/ with the tools they are for.

Run in the root: python3 tests/deploy/deploy_test.py [SERVER]

SERVER is a built fieldcast-server. Tools that are not there are named in the skips. What needs a running server is in
tests/system: envoy_test.cpp, operation_process_test.cpp (dashboard and alerts against a live /metrics page).
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import containerfile

DEPLOY = pathlib.Path("deploy")
SERVER = sys.argv.pop(1) if len(sys.argv) > 1 and not sys.argv[1].startswith("-") else None
PROMTOOL = pathlib.Path(".cache/promtool/promtool")  # see install_promtool.py
WORST_EXPOSURE = 25  # tenths, as `systemd-analyze security` counts; 0 is best, without hardening it is 96


def read(path):
    return pathlib.Path(path).read_text(encoding="utf-8")


def run(*command):
    return subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)


def need(test, tool):
    if shutil.which(tool) is None:
        test.skipTest(f"{tool} is not installed")


def runtime_packages():
    return [line[2:].split("|")[0].strip() for line in read("deps.txt").splitlines() if line.startswith("#! ")]


class Units:
    """What both units promise."""
    name = program = None

    def setUp(self):
        need(self, "systemd-analyze")
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.text = read(DEPLOY / self.name)

    def analyze(self, text, *command):
        unit = pathlib.Path(self.folder.name) / self.name
        self.assertIn(self.program, text)
        unit.write_text(text.replace(self.program, "/bin/true"), encoding="utf-8")
        return run("systemd-analyze", *command, str(unit))

    def number(self, name):
        return int(re.search(rf"^{name}=(\d+)M?$", self.text, re.MULTILINE).group(1))

    def test_is_understood(self):
        result = self.analyze(self.text, "verify")
        self.assertEqual((0, ""), (result.returncode, result.stderr + result.stdout))

    def test_mistakes_would_be_found(self):
        broken = self.analyze(self.text.replace("ProtectSystem=strict", "ProtectSytem=strict"), "verify")
        self.assertIn("ProtectSytem", broken.stderr)

    def test_is_confined(self):
        result = self.analyze(self.text, "security", "--offline=true", f"--threshold={WORST_EXPOSURE}")
        if "offline" in result.stderr:
            self.skipTest("this systemd-analyze cannot look at files")
        self.assertEqual(0, result.returncode, result.stdout)

    def test_allows_a_drain(self):
        self.assertGreater(self.number("TimeoutStopSec"), 8, "seconds that a drain takes at most")


class ServerUnit(Units, unittest.TestCase):
    name, program = "fieldcast-server.service", "/usr/bin/fieldcast-server"

    def test_starts_a_deaf_server_again(self):
        self.assertIn("\nRestart=on-failure\n", self.text)
        self.assertEqual(2, self.number("RestartPreventExitStatus"), "3, a deaf port, is not among them")


class EnvoyUnit(Units, unittest.TestCase):
    name, program = "fieldcast-envoy.service", "/opt/fieldcast-envoy/bin/envoy"

    def test_has_room_for_what_envoy_is_allowed(self):
        config = read(DEPLOY / "envoy.yaml")
        connections = int(re.search(r"max_active_downstream_connections: (\d+)", config).group(1))
        heap = int(re.search(r"max_heap_size_bytes: (\d+)", config).group(1))
        self.assertGreater(self.number("LimitNOFILE"), 2 * connections)
        self.assertGreater(self.number("MemoryMax") << 20, heap)

    def test_runs_the_file_that_is_tested(self):
        self.assertIn("-c /etc/fieldcast/envoy.yaml", self.text)


class Container(unittest.TestCase):
    def setUp(self):
        self.text = read(DEPLOY / "Containerfile")

    def test_is_understood(self):
        self.assertEqual([], containerfile.problems(self.text, lambda path: pathlib.Path(path).exists()))

    def test_mistakes_would_be_found(self):
        for broken in ("RUM x", "COPY nowhere /x", "COPY --from=nobody /a /b", "ENTRYPOINT server"):
            self.assertEqual(1, len(containerfile.problems(f"FROM a AS b\n{broken}", lambda path: False)), broken)

    def test_installs_what_a_server_needs(self):
        installed = containerfile.installed_packages(containerfile.stages(self.text)["runtime"])
        self.assertEqual(runtime_packages(), installed)
        self.assertIn("libvulkan1", installed)

    def test_does_not_run_as_root(self):
        users = [rest for word, rest in containerfile.stages(self.text)["runtime"] if word == "USER"]
        self.assertEqual(["65532"], users)

    def test_runtime_packages_hold_all_libraries(self):
        for tool in ("readelf", "dpkg-query", "ldconfig"):
            need(self, tool)
        if SERVER is None:
            self.skipTest("no built server was named")
        needed = set(re.findall(r"NEEDED.*\[(.*)\]", run("readelf", "-d", SERVER).stdout))
        closure = dependencies(runtime_packages())
        if closure is None:
            self.skipTest("the runtime packages are those of another distribution")
        owners = owners_of(needed)
        self.assertEqual({}, {library: owners[library] for library in needed if not owners[library] & closure})

    def test_builds(self):
        need(self, "buildah")
        if os.environ.get("FIELDCAST_TEST_CONTAINER") != "1":
            self.skipTest("compiles everything once more; set FIELDCAST_TEST_CONTAINER=1 to do so")
        buildah = ["buildah", "--storage-driver", "vfs"]
        if run(*buildah, "pull", "docker.io/library/debian:bookworm-slim").returncode != 0:
            self.skipTest("the base image cannot be fetched here")
        result = subprocess.run([*buildah, "bud", "--isolation", "chroot", "--network", "host", "-f",
                                 str(DEPLOY / "Containerfile"), "-t", "fieldcast-server-test", "."], check=False)
        self.assertEqual(0, result.returncode)


def dependencies(packages):
    """The packages and everything they depend on, among those installed; None if one of them is not installed."""
    found, left = set(), list(packages)
    while left:
        name = left.pop()
        if name in found:
            continue
        answer = run("dpkg-query", "-W", "-f", "${Depends}", name)
        if answer.returncode != 0:
            if name in packages:
                return None
            continue
        found.add(name)
        left += [re.split(r"[ :(]", choice.strip())[0] for choice in re.split(r"[,|]", answer.stdout) if choice.strip()]
    return found


def owners_of(libraries):
    """Shared library -> packages that own a file of that name, where the linker finds it."""
    places = {}
    for line in run("ldconfig", "-p").stdout.splitlines():
        name, path = line.split()[:1], line.rpartition("=> ")[2]
        if name and name[0] in libraries:
            candidates = {path, str(pathlib.Path(path).resolve()), "/usr" + path}
            places |= {candidate: name[0] for candidate in candidates}
    owners = {library: set() for library in libraries}
    for line in run("dpkg-query", "-S", *places).stdout.splitlines():
        package, _, path = line.partition(": ")
        owners[places[path]].add(package.split(":")[0])
    return owners


class Configuration(unittest.TestCase):
    def test_of_the_server_is_accepted(self):
        if SERVER is None:
            self.skipTest("no built server was named")
        with tempfile.TemporaryDirectory() as folder:
            tokens = pathlib.Path(folder) / "tokens.txt"
            tokens.write_text("alice view sha256:" + 64 * "0" + "\n", encoding="utf-8")
            tokens.chmod(0o600)
            config = pathlib.Path(folder) / "server.toml"
            text = read(DEPLOY / "server.toml").replace("/etc/fieldcast/tokens.txt", str(tokens))
            config.write_text(text.replace("/srv/fieldcast/scenes", str(pathlib.Path("scenes").resolve())),
                              encoding="utf-8")
            result = run(SERVER, "--config", str(config), "--check-config")
        self.assertEqual(0, result.returncode, result.stderr)

    def test_agrees_with_the_other_files(self):
        config = read(DEPLOY / "server.toml")
        listen = re.search(r'^listen = "127.0.0.1:(\d+)"$', config, re.MULTILINE).group(1)
        metrics = re.search(r'^metrics-listen = "(.*)"$', config, re.MULTILINE).group(1)
        self.assertIn(f"address: 127.0.0.1, port_value: {listen}", read(DEPLOY / "envoy.yaml"))
        self.assertIn(f'"--health", "127.0.0.1:{listen}"', read(DEPLOY / "Containerfile"))
        self.assertIn(f'targets: ["{metrics}"]', read(DEPLOY / "prometheus.yml"))
        self.assertIn("--config /etc/fieldcast/server.toml", read(DEPLOY / "fieldcast-server.service"))
        self.assertIn('"--config", "/etc/fieldcast/server.toml"', read(DEPLOY / "Containerfile"))


class Prometheus(unittest.TestCase):
    def setUp(self):
        self.tool = shutil.which("promtool") or str(PROMTOOL)
        need(self, self.tool)

    def check(self, kind, path):
        return run(self.tool, "check", kind, str(path))

    def test_accepts_its_files(self):
        for kind, name in (("config", "prometheus.yml"), ("rules", "alerts.yml")):
            result = self.check(kind, DEPLOY / name)
            self.assertEqual(0, result.returncode, result.stderr)
            self.assertIn(f"{len(self.alerts())} rules found", result.stdout)

    def test_mistakes_would_be_found(self):
        for right, wrong in (("== 0", "= 0"), ("for: 1m", "for: soon"), ("increase(", "incraese(")):
            text = read(DEPLOY / "alerts.yml")
            self.assertIn(right, text)
            with tempfile.NamedTemporaryFile("w", suffix=".yml") as file:
                file.write(text.replace(right, wrong))
                file.flush()
                self.assertNotEqual(0, self.check("rules", file.name).returncode, wrong)

    @staticmethod
    def alerts():
        return re.findall(r"^ +- alert: (\w+)$", read(DEPLOY / "alerts.yml"), re.MULTILINE)


class Monitoring(unittest.TestCase):
    def test_panels_have_their_place(self):
        panels = json.loads(read(DEPLOY / "grafana-dashboard.json"))["panels"]
        self.assertEqual(len(panels), len({panel["id"] for panel in panels}))
        cells = set()
        for panel in panels:
            place = panel["gridPos"]
            own = {(place["x"] + x, place["y"] + y) for x in range(place["w"]) for y in range(place["h"])}
            self.assertTrue(max(x for x, _ in own) < 24 and not own & cells, panel["title"])
            cells |= own
            self.assertTrue(all(target["expr"] for target in panel["targets"]), panel["title"])


if __name__ == "__main__":
    unittest.main()
