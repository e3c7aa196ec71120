# SPDX-License-Identifier: Apache-2.0
"""Measures the latency of real frames on bad networks, with and without adaptation. Server and client are processes;
the networks are measured one after the other.

    python3 bench/network/networks.py --programs build/dev --out networks.csv

--method netem: uses two network namespaces with `tc netem` between them, TLS and a token, as beyond loopback. It needs
root, `ip`, `tc`, `openssl` and a kernel with netem; if one of them is missing, it prints so and exits with 77.
--method relay: uses loopback with relay.py, which imitates the networks on the bytes of the connection.
--method auto: uses netem if possible, otherwise the relay.
--synthetic: uses the real service with frames that need no rendering (tests/server/synthetic_server.cpp), through the
relay. On a machine without a GPU, rendering would hide the effect of the network.
"""
import argparse
import csv
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from relay import Network, Relay

SKIPPED = 77
NOTHING = "nothing shown"
NETWORKS = [Network("open"), Network("20 ± 10 ms", delay_ms=20, jitter_ms=10),
            Network("50 ± 20 ms", delay_ms=50, jitter_ms=20), Network("1 % loss", delay_ms=20, loss_percent=1),
            Network("20 Mbit/s", delay_ms=10, rate_mbit=20), Network("5 Mbit/s", delay_ms=10, rate_mbit=5)]
COLUMNS = ["network", "adapt", "fps", "kbyte_per_frame", "sent_p50_ms", "sent_p95_ms", "pose_p50_ms", "pose_p95_ms",
           "superseded", "adaptations", "ends_with"]
SERVER_SPACE, CLIENT_SPACE = "fieldcast-server-net", "fieldcast-client-net"
SERVER_ADDRESS, CLIENT_ADDRESS = "10.77.31.1", "10.77.31.2"


class NotPossible(Exception):
    """netem cannot be used here."""


def sh(*words):
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise NotPossible(f"{' '.join(words)}: {done.stderr.strip()}")
    return done.stdout


class Namespaces:
    """Two network namespaces that a veth pair connects; removed at the end."""

    def __enter__(self):
        if os.geteuid() != 0:
            raise NotPossible("network namespaces need root")
        for program in ("ip", "tc", "openssl"):
            if shutil.which(program) is None:
                raise NotPossible(f"the program {program} is missing")
        try:
            for space in (SERVER_SPACE, CLIENT_SPACE):
                sh("ip", "netns", "add", space)
            sh("ip", "link", "add", "fc-s", "netns", SERVER_SPACE, "type", "veth",
               "peer", "name", "fc-c", "netns", CLIENT_SPACE)
            ends = ((SERVER_SPACE, "fc-s", SERVER_ADDRESS), (CLIENT_SPACE, "fc-c", CLIENT_ADDRESS))
            for space, device, address in ends:
                sh("ip", "-n", space, "addr", "add", address + "/24", "dev", device)
                sh("ip", "-n", space, "link", "set", device, "up")
                sh("ip", "-n", space, "link", "set", "lo", "up")
            self.shape(Network("probe", delay_ms=1))
        except NotPossible:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        for space in (SERVER_SPACE, CLIENT_SPACE):
            subprocess.run(["ip", "netns", "del", space], capture_output=True, check=False)

    def shape(self, network):
        for space, device in ((SERVER_SPACE, "fc-s"), (CLIENT_SPACE, "fc-c")):
            words = ["delay", f"{network.delay_ms}ms", f"{network.jitter_ms}ms"]
            words += ["loss", f"{network.loss_percent}%"] if network.loss_percent else []
            words += ["rate", f"{network.rate_mbit}mbit"] if network.rate_mbit else []
            sh("tc", "-n", space, "qdisc", "replace", "dev", device, "root", "netem", *words)


class Server:
    """A fieldcast-server with the given flags, in a namespace with TLS and a token or on loopback."""

    def __init__(self, options, folder, is_protected):
        program = f"{options.programs}/server/fieldcast-server"
        self.folder, self.is_protected, self.port_file = folder, is_protected, folder / "port"
        words = [program, "--scene", options.scene, "--size", options.size, "--port-file", str(self.port_file),
                 *options.server_flags.split()]
        if options.synthetic:
            words = [f"{options.programs}/tests/server/synthetic_server", str(self.port_file)]
        elif is_protected:
            certificate, key = str(folder / "cert.pem"), str(folder / "key.pem")
            sh("openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "1", "-subj", "/CN=fieldcast",
               "-addext", f"subjectAltName=IP:{SERVER_ADDRESS}", "-keyout", key, "-out", certificate)
            token, line = self.make_token(program)
            (folder / "token.txt").write_text(token + "\n", encoding="utf-8")
            (folder / "tokens.txt").write_text(line + "\n", encoding="utf-8")
            words = ["ip", "netns", "exec", SERVER_SPACE, *words, "--listen", SERVER_ADDRESS + ":0", "--tls-cert",
                     certificate, "--tls-key", key, "--tokens", str(folder / "tokens.txt")]
        else:
            words += ["--listen", "127.0.0.1:0"]
        with open(folder / "server.log", "wb") as log:
            self.process = subprocess.Popen(words, stdout=log, stderr=log)
        self.port = self.wait_for_port()

    @staticmethod
    def make_token(program):
        words = sh(program, "--make-token", "bench", "view").splitlines()
        line = next(word for word in words if "sha256:" in word).strip()
        token = next(word for word in words if " " not in word and word).strip()
        return token, line[line.index("bench"):]

    def wait_for_port(self):
        for _ in range(3000):
            if self.port_file.exists() and self.port_file.read_text(encoding="utf-8").strip():
                return int(self.port_file.read_text(encoding="utf-8"))
            if self.process.poll() is not None:
                break
            time.sleep(0.1)
        raise SystemExit("the server did not start:\n" + (self.folder / "server.log").read_text(encoding="utf-8"))

    def stop(self):
        self.process.send_signal(signal.SIGINT)
        self.process.wait(timeout=30)


def run_client(options, server, port, adapts):
    """Runs a client and returns its statistics."""
    result = server.folder / "client.json"
    result.unlink(missing_ok=True)
    words = [f"{options.programs}/client/fieldcast-client", "--save", "none", "--json", str(result),
             *options.client_flags.split()]
    words += ["--adapt", options.adapt] if adapts else []
    if server.is_protected:
        words = ["ip", "netns", "exec", CLIENT_SPACE, *words, "--server", f"https://{SERVER_ADDRESS}:{server.port}",
                 "--tls-ca", str(server.folder / "cert.pem"), "--token-file", str(server.folder / "token.txt")]
    else:
        words += ["--server", f"127.0.0.1:{port}"]
    with open(server.folder / "client.log", "wb") as log:
        client = subprocess.Popen(words, stdout=log, stderr=log)
    time.sleep(options.seconds)
    client.send_signal(signal.SIGINT)
    client.wait(timeout=60)
    if not result.exists():
        raise SystemExit("the client failed:\n" + (server.folder / "client.log").read_text(encoding="utf-8"))
    return json.loads(result.read_text(encoding="utf-8"))


def row_of(network, adapts, result):
    def percentile(key, which):
        return round(result[key][which], 1) if result[key] else ""
    last = result["epochs"][-1] if result["epochs"] else None
    ends_with = f"{last['grid']} of {last['view_size']}, {last['reason'] or 'as asked for'}" if last else NOTHING
    kbyte = round(last["bytes_per_frame"] / 1000, 1) if last else ""
    return [network.name, "yes" if adapts else "no", round(result["frames_per_second"], 2), kbyte,
            percentile("send_to_decoded_ms", "p50"), percentile("send_to_decoded_ms", "p95"),
            percentile("pose_to_shown_ms", "p50"), percentile("pose_to_shown_ms", "p95"),
            result["superseded"], result["adaptations"], ends_with]


def measure(options, namespaces):
    rows = []
    with tempfile.TemporaryDirectory() as name:
        server = Server(options, pathlib.Path(name), namespaces is not None)
        try:
            for network in NETWORKS:
                for adapts in (False, True):
                    if namespaces is not None:
                        namespaces.shape(network)
                        result = run_client(options, server, server.port, adapts)
                    else:
                        with Relay(server.port, network) as relay:
                            result = run_client(options, server, relay.port, adapts)
                    rows.append(row_of(network, adapts, result))
                    print("| " + " | ".join(map(str, rows[-1])) + " |", flush=True)
        finally:
            server.stop()
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--programs", default="build/dev", help="Build folder (default: %(default)s).")
    parser.add_argument("--method", choices=["auto", "netem", "relay"], default="auto")
    parser.add_argument("--synthetic", action="store_true")
    parser.add_argument("--seconds", type=float, default=30)
    parser.add_argument("--scene", default="scenes/atelier/atelier.gltf")
    parser.add_argument("--size", default="320x180")
    parser.add_argument("--server-flags", default="--spp 1 --bounces 1 --denoiser none --reflections off --holes source")
    parser.add_argument("--client-flags", default="--grid 6x6")
    parser.add_argument("--adapt", default="quality=40,fps=2,height=90,grid=3x3,delay=100")
    parser.add_argument("--only", default="", help="Part of the names of the networks to measure (default: all).")
    parser.add_argument("--out", help="CSV file to write.")
    options = parser.parse_args()
    NETWORKS[:] = [network for network in NETWORKS if options.only in network.name]
    print("| " + " | ".join(COLUMNS) + " |\n|" + "---|" * len(COLUMNS), flush=True)
    try:
        if options.method == "relay" or options.synthetic:
            rows = measure(options, None)
        else:
            with Namespaces() as namespaces:
                rows = measure(options, namespaces)
    except NotPossible as problem:
        print(f"skipped: tc netem cannot be used here: {problem}", file=sys.stderr)
        if options.method == "netem":
            return SKIPPED
        rows = measure(options, None)
    if options.out:
        with open(options.out, "w", encoding="utf-8", newline="") as file:
            csv.writer(file).writerows([COLUMNS, *rows])
    return 1 if any(row[-1] == NOTHING for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
