# SPDX-License-Identifier: Apache-2.0
"""Callers of /metrics."""
import contextlib
import socket
import ssl
import threading
import time

from scenario import Bounds, Scenario, Setup
from waiting import let_pass



def open_metrics(field, is_encrypted):
    plain = socket.create_connection(("127.0.0.1", field.server.metrics_port), timeout=5)
    if not is_encrypted:
        return plain
    context = ssl.create_default_context(cafile=field.target.ca)
    context.check_hostname = False
    return context.wrap_socket(plain)


def scrape(field, is_encrypted):
    """Seconds until the page of metrics was there."""
    begin = time.monotonic()
    with open_metrics(field, is_encrypted) as page:
        bearer = f"Authorization: Bearer {field.target.token}\r\n" if is_encrypted else ""
        page.sendall(f"GET /metrics HTTP/1.1\r\nHost: localhost\r\n{bearer}Connection: close\r\n\r\n".encode())
        page.settimeout(8.0)
        answer = b"".join(iter(lambda: page.recv(1 << 16), b""))
    return time.monotonic() - begin, b"fieldcast_serving" in answer


class Dribble:
    """Callers of /metrics that say a byte a second, each on a connection of its own, until told to stop."""

    def __init__(self, field, is_encrypted, count):
        self._end = threading.Event()
        self._target = (field, is_encrypted)
        self._threads = [threading.Thread(target=self._run, daemon=True) for _ in range(count)]

    def __enter__(self):
        for each in self._threads:
            each.start()
        return self

    def __exit__(self, *_):
        self._end.set()
        for each in self._threads:
            each.join()

    def _run(self):
        field, is_encrypted = self._target
        hello = b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03" if is_encrypted else b"GET /metrics HTTP/1.1\r\n"
        while not self._end.is_set():
            with contextlib.suppress(OSError), open_metrics(field, False) as connection:
                for byte in hello:
                    connection.sendall(bytes([byte]))
                    if self._end.wait(1.0):
                        return
            self._end.wait(0.1)


def dribbled(field, is_encrypted):
    """Somebody scrapes beside them; then the server is stopped."""
    with Dribble(field, is_encrypted, 3):
        let_pass(1.0)
        try:
            took, is_page = scrape(field, is_encrypted)
        except OSError as problem:
            took, is_page = 99.0, f"{type(problem).__name__}: {problem}"
        is_quick = is_page is True and took <= 2.0
        field.expect("a scrape beside them takes 2 s at most", is_quick, f"{took:.2f} s, {is_page}")
        took, code = field.server.stop()
        field.expect("ends within 5 s while they speak", took <= 5.0 and code == 0, f"{took:.1f} s, exit code {code}")


def dribbled_metrics(field):
    """Three callers of /metrics send a byte a second, also while the server stops."""
    dribbled(field, False)


def dribbled_metrics_tls(field):
    """Three callers begin a TLS handshake, a byte a second, also while the server stops."""
    dribbled(field, True)


ENCRYPTED_METRICS = ("--metrics-listen", "0.0.0.0:0")
ALONE = Setup(has_honest=False)
NOBODY = "only metrics are attacked, and the end of the process; no client is beside them"
SCENARIOS = [
    Scenario("slow-metrics", 13, "callers of /metrics that send a byte a second", dribbled_metrics,
             Bounds(NOBODY, attack_s=20.0), ALONE),
    Scenario("slow-metrics-tls", 13, "callers of /metrics whose TLS handshake takes for ever", dribbled_metrics_tls,
             Bounds(NOBODY, attack_s=20.0),
             Setup(flags=ENCRYPTED_METRICS, front="tls", role="admin", has_honest=False)),
]
