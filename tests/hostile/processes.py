# SPDX-License-Identifier: Apache-2.0
"""The server that is attacked, Envoy before it, and certificates for both."""
import pathlib
import re
import resource
import signal
import socket
import subprocess
import time

from packages import ROOT
from waiting import comes_true

START_S = 120.0  # a rendering server with sanitizers on a busy machine
STOP_S = 60.0
ENVOY = ROOT / ".cache/envoy/bin/envoy"  # where tests/deploy/install_envoy.py puts it
REPLAY = ROOT / "tests/data/recordings/v1.fcrec"
ATELIER = ROOT / "scenes/atelier/atelier.gltf"
# What AddressSanitizer keeps must not count as memory of the server. Its quarantine of freed memory takes 256 MiB by
# default, and 1 MiB more per thread. Stack traces of allocations, five frames each, took 45 MiB in a drain that turned
# 4700 callers away; two frames take 5 MiB, and suffice for leaks.supp.
ASAN_OPTIONS = "quarantine_size_mb=8:thread_local_quarantine_size_kb=64:malloc_context_size=2"


OK, UNAUTHENTICATED = 0, 16  # gRPC's numbers


class NotStarted(Exception):
    """Something ended, or was not ready in time."""

    def __init__(self, what, code=None):
        super().__init__(what)
        self.code = code  # with which it ended; None: it did not


def has_address_sanitizer(program):
    return b"__asan_init" in pathlib.Path(program).read_bytes()


def make_certificate(folder):
    """A certificate for 127.0.0.1 that has signed itself, and its key."""
    subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes",
                    "-subj", "/CN=localhost", "-addext", "subjectAltName=IP:127.0.0.1,DNS:localhost", "-days", "2",
                    "-keyout", folder / "key.pem", "-out", folder / "cert.pem"],
                   check=True, capture_output=True, timeout=30)
    return str(folder / "cert.pem"), str(folder / "key.pem")


def free_port():
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        return found.getsockname()[1]


class Process:
    """A child whose output goes to a file; ended at the end of its block."""

    def __init__(self, arguments, log, **options):
        self.log = log
        with open(log, "wb") as out:
            self.child = subprocess.Popen([str(a) for a in arguments], stdin=subprocess.DEVNULL, stdout=out, stderr=out,
                                          cwd=ROOT, **options)
        self.pid = self.child.pid

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.child.poll() is None:
            self.child.kill()
        self.child.wait()

    def text(self):
        return pathlib.Path(self.log).read_text(encoding="utf-8", errors="replace")

    def is_running(self):
        return self.child.poll() is None

    def stop(self):
        """TERM; (seconds until it had ended, exit code). The code is None if it had to be killed."""
        begin = time.monotonic()
        if self.is_running():
            self.child.send_signal(signal.SIGTERM)
        try:
            code = self.child.wait(timeout=STOP_S)
        except subprocess.TimeoutExpired:
            self.child.kill()
            self.child.wait()
            code = None
        return time.monotonic() - begin, code

    def wait_until(self, is_so, what, timeout_s=START_S):
        comes_true(lambda: is_so() or not self.is_running(), timeout_s)
        if not is_so():
            self.__exit__()
            raise NotStarted(f"{what} is not there: {self.text()[-2000:]}", self.child.poll())


class Server(Process):
    """A server whose port is open."""

    def __init__(self, program, folder, flags, max_descriptors=None):
        self.folder = folder
        port_file = folder / "port"
        arguments = [program, "--listen", "127.0.0.1:0", "--port-file", port_file, "--log-format", "json",
                     *self._metrics_flags(flags), *flags]
        super().__init__(arguments, folder / "server.log", env={
            **subprocess.os.environ, "ASAN_OPTIONS": ASAN_OPTIONS,
            "LSAN_OPTIONS": f"suppressions={ROOT}/tests/fixtures/leaks.supp:print_suppressions=0"},
            preexec_fn=None if max_descriptors is None else lambda: resource.setrlimit(
                resource.RLIMIT_NOFILE, (max_descriptors, max_descriptors)))
        self.wait_until(lambda: port_file.exists() and port_file.read_text().strip(), "the server's port")
        self.port = int(port_file.read_text())

    def _metrics_flags(self, flags):
        listen = [] if "--metrics-listen" in flags else ["--metrics-listen", "127.0.0.1:0"]
        return [*listen, "--metrics-port-file", self.folder / "metrics_port"]

    @property
    def metrics_port(self):
        return int((self.folder / "metrics_port").read_text())


class Envoy(Process):
    """Envoy with deploy/envoy.yaml on ports of its own, once it has found the server healthy."""

    def __init__(self, folder, server_port, changes=()):
        certificate, key = make_certificate(folder)
        self.port, self.ca, self.admin_port = free_port(), certificate, free_port()
        text = (ROOT / "deploy/envoy.yaml").read_text(encoding="utf-8")
        for old, new in (("/etc/fieldcast/cert.pem", certificate), ("/etc/fieldcast/key.pem", key),
                         ("0.0.0.0, port_value: 8443", f"127.0.0.1, port_value: {self.port}"),
                         ("port_value: 50151", f"port_value: {server_port}"),
                         ("port_value: 9901", f"port_value: {self.admin_port}"), *changes):
            if old not in text:
                raise NotStarted(f"deploy/envoy.yaml has no {old!r} any more")
            text = text.replace(old, new)
        (folder / "envoy.yaml").write_text(text, encoding="utf-8")
        super().__init__([ENVOY, "-c", folder / "envoy.yaml", "--concurrency", "1", "--use-dynamic-base-id",
                          "--log-level", "warning"], folder / "envoy.log")
        self.wait_until(self._finds_the_server, "the server behind Envoy")

    def _finds_the_server(self):
        from connection import Closed, Connection, Target
        try:
            with Connection(Target(self.port, ca=self.ca)) as connection:
                call = connection.call("/fieldcast.v1.Catalog/GetServerInfo")
                call.send(b"", end=True)
                return call.finish(2.0) in (OK, UNAUTHENTICATED)
        except (OSError, Closed):
            return False


def metric(port, series):
    """A value of the plain-text metrics page; 0 if it has no such series yet."""
    with socket.create_connection(("127.0.0.1", port), timeout=5) as page:
        page.sendall(b"GET /metrics HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n")
        text = b"".join(iter(lambda: page.recv(1 << 16), b"")).decode("utf-8", "replace")
    found = re.search("^" + re.escape(series) + r" (\S+)", text, re.MULTILINE)
    return float(found.group(1)) if found else 0.0


def metrics(port, *series):
    return [metric(port, each) for each in series]
