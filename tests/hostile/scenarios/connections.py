# SPDX-License-Identifier: Apache-2.0
"""Before any token is shown: HTTP/2 frames and connections."""
from raw import CONTINUATION, HEADERS, RawConnection, frame, literal_field
from scenario import Bounds, Scenario, Setup

OPEN = "/fieldcast.v1.LightField/Open"
FLOOD_MIB = 96


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


# Of a thread that the attack keeps busy, the honest client gets a fifth at least: half, and room for other work.
BY_ENVOY = "Envoy holds back 1 MiB of a connection, and shares its only thread among all"
SCENARIOS = [
    Scenario("continuation-envoy", 1, "a header block that never ends, through Envoy", endless_continuation,
             Bounds(BY_ENVOY, share=0.2, gap_frames=60.0), Setup(front="envoy")),
]
