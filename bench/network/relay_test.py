# SPDX-License-Identifier: Apache-2.0
"""Tests that the relay imitates its networks. Run: python3 bench/network/relay_test.py"""
import socket
import threading
import time
import unittest

from relay import Network, Relay

ANSWER_BYTES = 500_000
PATIENCE_S = 30


class Source:
    """Answers "ping" with four bytes and everything else with ANSWER_BYTES, on any number of connections."""

    def __init__(self):
        self.socket = socket.socket()
        self.socket.bind(("127.0.0.1", 0))
        self.socket.listen(4)
        self.port = self.socket.getsockname()[1]
        threading.Thread(target=self.accept, daemon=True).start()

    def accept(self):
        while True:
            caller, _ = self.socket.accept()
            threading.Thread(target=self.answer, args=(caller,), daemon=True).start()

    @staticmethod
    def answer(caller):
        while words := caller.recv(4):
            caller.sendall(b"pong" if words == b"ping" else bytes(ANSWER_BYTES))


class RelayTest(unittest.TestCase):
    source = Source()

    def seconds(self, network, words, size):
        """Seconds from the request to the end of the answer."""
        with (Relay(self.source.port, network) as relay,
              socket.create_connection(("127.0.0.1", relay.port), PATIENCE_S) as caller):
            begin = time.monotonic()
            caller.sendall(words)
            while size > 0:
                got = caller.recv(65536)
                self.assertTrue(got, "the relay closed the connection")
                size -= len(got)
            return time.monotonic() - begin

    def test_delays_both_ways(self):
        self.assertGreaterEqual(self.seconds(Network("far", delay_ms=60), b"ping", 4), 0.12)

    def test_jitter_stays_within_its_bounds(self):
        self.assertGreaterEqual(self.seconds(Network("far", delay_ms=60, jitter_ms=20), b"ping", 4), 0.08)

    def test_limits_the_rate(self):
        narrow = self.seconds(Network("narrow", rate_mbit=8), b"data", ANSWER_BYTES)
        self.assertGreaterEqual(narrow, 0.98 * ANSWER_BYTES * 8 / 8e6)  # 0.5 s; the first packet is not slower than the last

    def test_loss_costs_a_round_trip(self):
        network = Network("lossy", delay_ms=30, loss_percent=100)
        self.assertGreaterEqual(self.seconds(network, b"ping", 4), 2 * 0.03 + 2 * 0.06)


if __name__ == "__main__":
    unittest.main()
