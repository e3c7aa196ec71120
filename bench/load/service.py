# SPDX-License-Identifier: Apache-2.0
"""Measures how clients of one server affect each other, with a recording instead of a renderer (docs/recordings.md).

  python3 bench/load/service.py slow-reader|connects|restart RECORDING [--build build/release]

slow-reader: latencies of quick clients with and without slow readers, interleaved, and the memory of the server.
connects: file descriptors and memory of the server before and after thousands of clients connect and vanish.
restart: time from the restart of a killed server (its port is open) to the next frame of a client.
"""
import argparse
import json
import pathlib
import re
import signal
import statistics
import subprocess
import tempfile
import time
import urllib.request

QUICK = """duration = {seconds}
ramp = 2
[[group]]
name = "quick"
count = 16
grid = "3x3"
size = "160x90"
"""
SLOW = """[[group]]
name = "slow"
count = 4
grid = "4x4"
size = "160x90"
reads-kbit-per-second = 400
"""
VANISHING = """duration = {seconds}
[[group]]
name = "vanishing"
count = 40
grid = "1x1"
size = "160x90"
stay = 0.05
away = 0.02
leaves = "abruptly"
"""


class Server:
    """A fieldcast-server that replays a recording, on a free or a given port."""

    def __init__(self, arguments, folder, port=0):
        self.files = [folder / "port", folder / "metrics-port"]
        for file in self.files:
            file.unlink(missing_ok=True)
        started = time.time()
        self.process = subprocess.Popen(
            [arguments.build / "server/fieldcast-server", "--replay", arguments.recording, "--log-level", "warn",
             "--listen", f"127.0.0.1:{port}", "--port-file", self.files[0], "--metrics-listen", "127.0.0.1:0",
             "--metrics-port-file", self.files[1], "--max-sessions", "4096", "--max-sessions-per-peer", "4096",
             "--max-opens-per-second-per-peer", "100000", "--max-pixels-per-peer", "1000000000000"], stderr=subprocess.DEVNULL)
        while not all(file.exists() and file.read_text().strip() for file in self.files):
            if self.process.poll() is not None:
                raise SystemExit("the server ended; does the recording exist?")
            time.sleep(0.005)
        self.ready = time.time()
        self.starting_s = self.ready - started
        self.port, self.metrics_port = (int(file.read_text()) for file in self.files)

    def page(self):
        with urllib.request.urlopen(f"http://127.0.0.1:{self.metrics_port}/metrics") as answer:
            return answer.read().decode()

    def number(self, series):
        found = re.search(rf"^{re.escape(series)}(?:\{{[^}}]*\}})? (\S+)$", self.page(), re.MULTILINE)
        return float(found.group(1)) if found else 0.0

    def sum_of(self, series):
        return sum(float(value) for value in re.findall(rf"^{series}(?:\{{[^}}]*\}})? (\S+)$", self.page(), re.MULTILINE))

    def stop(self, how=signal.SIGTERM):
        self.process.send_signal(how)
        self.process.wait()


def load(arguments, folder, server, scenario, while_running=lambda: None):
    """Runs a scenario and returns the results of its groups by name."""
    (folder / "scenario.toml").write_text(scenario)
    process = subprocess.Popen([arguments.build / "client/fieldcast-load", "--scenario", folder / "scenario.toml", "--json",
                                folder / "load.json", f"127.0.0.1:{server.port}"],
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while process.poll() is None:
        while_running()
        time.sleep(0.2)
    return {group["name"]: group for group in json.loads((folder / "load.json").read_text())["groups"]}


def slow_reader(arguments, folder):
    p99 = {"without": [], "with": []}
    stages = {"without": [], "with": []}
    for turn in range(arguments.turns):
        for kind in ("without", "with") if turn % 2 == 0 else ("with", "without"):
            server = Server(arguments, folder)
            before = server.number("process_resident_memory_bytes")
            most = {"memory": before, "in flight": 0.0}

            def look():
                most["memory"] = max(most["memory"], server.number("process_resident_memory_bytes"))
                most["in flight"] = max(most["in flight"], server.sum_of("fieldcast_bytes_in_flight"))

            scenario = QUICK.format(seconds=arguments.seconds) + (SLOW if kind == "with" else "")
            groups = load(arguments, folder, server, scenario, look)
            server.stop()
            quick = groups["quick"]["stages"]
            p99[kind].append(quick["due"]["p99_ms"])
            stages[kind].append(quick["send"]["p99_ms"])
            print(f"{kind:8} due p99 {p99[kind][-1]:8.1f} ms, send p99 {stages[kind][-1]:8.1f} ms, memory "
                  f"{before / 1e6:.1f} -> {most['memory'] / 1e6:.1f} MB, in flight {most['in flight'] / 1e6:.1f} MB")
    for name, values in (("due", p99), ("send", stages)):
        ratio = statistics.median(values["with"]) / statistics.median(values["without"])
        print(f"{name} p99, with over without slow readers: {ratio:.2f} (medians of {arguments.turns})")


def connects(arguments, folder):
    server = Server(arguments, folder)
    facts = []
    files = server.number("process_open_fds")
    print(f"{files:.0f} open files at the start")
    for part in range(arguments.turns):
        load(arguments, folder, server, VANISHING.format(seconds=arguments.seconds))
        deadline = time.monotonic() + 60
        while server.number("process_open_fds") > files + 5 and time.monotonic() < deadline:
            time.sleep(0.5)  # the transport closes sockets of vanished clients with a delay
        facts.append([server.number("fieldcast_sessions_opened_total"), server.number("process_open_fds"),
                      server.number("process_resident_memory_bytes") / 1e6])
        print("{:.0f} sessions so far, {:.0f} open files, {:.1f} MB".format(*facts[-1]), flush=True)
    server.stop()


def restart(arguments, folder):
    server = Server(arguments, folder)
    log = folder / "client.log"
    client = subprocess.Popen([arguments.build / "client/fieldcast-client", "--server", f"127.0.0.1:{server.port}", "--grid",
                               "3x3", "--size", "160x90", "--frames", "0", "--out", folder / "out", "--verbose"],
                              stdout=subprocess.DEVNULL, stderr=log.open("w"))
    shown = 0
    for turn in range(arguments.turns):
        wait_for_frame(log, shown)
        server.stop(signal.SIGKILL)
        time.sleep(0.3 + turn * 0.7)  # the client has to wait longer in each turn
        shown = log.read_text().count("frame arrived")
        server = Server(arguments, folder, server.port)
        arrived = wait_for_frame(log, shown)
        print(f"down for {0.3 + turn * 0.7:.1f} s and {server.starting_s:.2f} s "
              f"of starting; first frame {1e3 * (arrived - server.ready):.0f} ms after the server was ready", flush=True)
        shown = log.read_text().count("frame arrived")
    client.send_signal(signal.SIGINT)
    client.wait()
    server.stop()


def wait_for_frame(log, shown):
    deadline = time.monotonic() + 60
    while log.read_text().count("frame arrived") <= shown:
        if time.monotonic() > deadline:
            raise SystemExit("no frame arrived")
        time.sleep(0.005)
    return time.time()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["slow-reader", "connects", "restart"], help="Measurement to run.")
    parser.add_argument("recording", type=pathlib.Path, help="Recording (.fcrec) to replay.")
    parser.add_argument("--build", type=pathlib.Path, default=pathlib.Path("build/release"),
                        help="Build folder (default: %(default)s).")
    parser.add_argument("--turns", type=int, default=4, help="Number of repetitions (default: %(default)s).")
    parser.add_argument("--seconds", type=int, default=15, help="Seconds of each load run (default: %(default)s).")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        {"slow-reader": slow_reader, "connects": connects, "restart": restart}[arguments.what](
            arguments, pathlib.Path(folder))


if __name__ == "__main__":
    main()
