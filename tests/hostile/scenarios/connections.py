# SPDX-License-Identifier: Apache-2.0
"""Before any token is shown: HTTP/2 frames and connections."""
import contextlib
import dataclasses
import time

from connection import Closed, Connection
from raw import CONTINUATION, END_HEADERS, HEADERS, RST_STREAM, RawConnection, frame, literal_field
from scenario import Bounds, Scenario, Setup

OPEN = "/fieldcast.v1.LightField/Open"
INFO = "/fieldcast.v1.Catalog/GetServerInfo"
HEALTH = "/grpc.health.v1.Health/Check"
FLOOD_MIB = 400
RESET_STREAMS = 120_000
POURED_MIB = 300  # more than the quota of memory of the server's gRPC, 256 MiB
MAX_DESCRIPTORS = 64
IDLE_CONNECTIONS = 80


def endless_continuation(field):
    """One header block that never ends: a literal header field after the other, in CONTINUATION frames."""
    field_of_header = literal_field(b"flood", b"x" * 16_000)
    with RawConnection(field.target) as connection:
        connection.push(frame(HEADERS, 0, 1, connection.header_block(OPEN)))
        sent = 0
        part = frame(CONTINUATION, 0, 1, field_of_header)
        while sent < FLOOD_MIB << 20 and field.has_time() and connection.push(part):
            sent += len(part)
        field.expect("is cut off", connection.is_closed_within(2.0), f"after {sent / 2**20:.1f} MiB")


def rapid_reset(field):
    """HEADERS and RST_STREAM, one stream after the other, on a new connection whenever one is cut."""
    streams, connections = 0, 0
    while streams < RESET_STREAMS and field.has_time(8.0):
        connections += 1
        with contextlib.suppress(OSError), RawConnection(field.target) as connection:
            block, first = connection.header_block(INFO), 1
            while streams < RESET_STREAMS and field.has_time(8.0):
                burst = b"".join(frame(HEADERS, END_HEADERS, each, block) + frame(RST_STREAM, 0, each, b"\0\0\0\x08")
                                 for each in range(first, first + 400, 2))
                if not connection.push(burst):
                    break
                first, streams = first + 400, streams + 200
    field.expect("streams were reset", streams >= RESET_STREAMS / 10, f"{streams} on {connections} connections")


def endless_requests(field):
    """Requests of health and of the catalogue that announce 4 GiB and never end, by somebody without a token."""
    target, part = dataclasses.replace(field.target, token=None), bytes(1 << 14)
    for path in (HEALTH, INFO):
        sent = 0
        with Connection(target) as connection:
            call = connection.call(path)
            with contextlib.suppress(Closed):
                connection.send(call.stream, b"\0\xff\xff\xff\xff", False)
                while sent < POURED_MIB << 20 and field.has_time() and not call.is_over:
                    connection.send(call.stream, part, False)
                    sent += len(part)
                    connection.pump(0.01)
            field.expect(f"{path} is cut off", call.is_over, f"after {sent / 2**20:.1f} MiB")


def answers(field):
    """Whether a newcomer gets an answer within 8 s."""
    deadline = time.monotonic() + 8.0
    while time.monotonic() < deadline:
        with contextlib.suppress(OSError, Closed), Connection(field.target) as connection:
            connection.ask(INFO, timeout_s=1.0)
            return True
    return False


def descriptors_run_out(field):
    """More idle connections than the process may have descriptors; they leave again, and somebody else comes."""
    idle = []
    with contextlib.suppress(OSError):
        for _ in range(IDLE_CONNECTIONS):
            idle.append(RawConnection(field.target, speaks=False))
    idle[-1].is_closed_within(2.0)  # or all of them are held
    for connection in idle:
        connection.close()
    field.expect("a newcomer is answered", answers(field), f"after {len(idle)} connections")


# Of a thread that the attack keeps busy, the honest client gets a fifth at least: half, and room for other work.
BY_ENVOY = "Envoy holds back 1 MiB of a connection, and shares its only thread among all"
SCENARIOS = [
    Scenario("continuation-envoy", 1, "a header block that never ends, through Envoy", endless_continuation,
             Bounds(BY_ENVOY, share=0.2, gap_frames=60.0), Setup(front="envoy")),
    Scenario("rapid-reset-envoy", 2, "120,000 streams opened and reset, through Envoy", rapid_reset,
             Bounds(BY_ENVOY, share=0.2, gap_frames=60.0), Setup(front="envoy")),
    Scenario("endless-requests-envoy", 1, "requests of 4 GiB without a token, through Envoy", endless_requests,
             Bounds(BY_ENVOY, share=0.2, gap_frames=60.0), Setup(front="envoy", role="view")),
    Scenario("descriptors", 3, "80 idle connections to a server with 64 descriptors", descriptors_run_out,
             Bounds("connections leave a reserve of descriptors"), Setup(max_descriptors=MAX_DESCRIPTORS)),
    Scenario("descriptors-envoy", 3, "the same, through Envoy", descriptors_run_out, Bounds(BY_ENVOY),
             Setup(front="envoy", max_descriptors=MAX_DESCRIPTORS)),
]
