# SPDX-License-Identifier: Apache-2.0
"""Classes of attacks that have always held."""
import contextlib
import dataclasses
import random
import time

import processes
import recordings
from connection import Closed, Connection, Target
from fieldcast.v1 import light_field_pb2 as v1
from fieldcast.v1 import types_pb2 as types
from raw import PREFACE, RawConnection, frame, header_frames, literal_field
from scenario import Bounds, Scenario, Setup
from session import OPEN, Session
from waiting import let_pass

SEED = 14
HUGE = 0xFFFFFFFF
NAN, INFINITY = float("nan"), float("inf")


def garbage(field):
    """Bytes that are no HTTP/2, or begin like it; frames of random kinds, lengths and streams."""
    noise = random.Random(SEED)
    starts = [b"", PREFACE, PREFACE + frame(4, 0, 0), b"GET / HTTP/1.1\r\nHost: x\r\n\r\n", b"\x16\x03\x01\x02\x00"]
    attempts = 0
    while field.has_time(4.0):
        with contextlib.suppress(OSError), RawConnection(field.target, speaks=False) as connection:
            connection.push(starts[attempts % len(starts)])
            for _ in range(8):
                connection.push(frame(noise.randrange(12), noise.randrange(256), noise.randrange(8),
                                      noise.randbytes(noise.randrange(600))))
            connection.is_closed_within(0.02)
        attempts += 1
    field.expect("garbage was sent", attempts > 30, f"{attempts} connections")


def garbage_messages(field):
    """gRPC messages on a session that are no protobuf, too long, or compressed without a word about it."""
    noise, ended = random.Random(SEED), 0
    bodies = [b"\0\0\0\0\x03\x0a\x7f\x01",  # a field that is longer than the message
              b"\1" + (40).to_bytes(4, "big") + noise.randbytes(40),
              b"\0\0\x02\0\0" + noise.randbytes(2 << 16)]
    for attempt in range(40):
        with contextlib.suppress(OSError, Closed), Connection(field.target) as connection:
            call = connection.call(OPEN)
            with contextlib.suppress(Closed):
                connection.send(call.stream, bodies[attempt % len(bodies)], False)
            status = call.finish(2.0)
            ended += status not in (None, 0) or call.is_over
        if not field.has_time(5.0):
            break
    field.expect("each such session ends", ended == attempt + 1, f"{ended} of {attempt + 1}")


ABSURD = {
    "rows 4294967295": {"grid": types.Grid(rows=HUGE, cols=HUGE)},
    "rows 73": {"grid": types.Grid(rows=73, cols=1)},
    "rows 0": {"grid": types.Grid(rows=0, cols=5)},
    "spacing nan": {"grid": types.Grid(rows=1, cols=1, spacing_x_m=NAN)},
    "spacing -inf": {"grid": types.Grid(rows=1, cols=1, spacing_y_m=-INFINITY)},
    "convergence -1": {"grid": types.Grid(rows=1, cols=1, convergence_m=-1.0)},
    "width 4294967295": {"view_width_px": HUGE, "view_height_px": HUGE},
    "width without height": {"view_width_px": 4},
    "field of view nan": {"fovy_rad": NAN},
    "field of view 1e38": {"fovy_rad": 1e38},
    "rate nan": {"max_frames_per_second": NAN},
    "rate -1": {"max_frames_per_second": -1.0},
    "chunk of 1 byte": {"chunk_bytes": 1},
    "chunk of 4 GiB": {"chunk_bytes": HUGE},
    "quality 4294967295": {"codecs": [v1.CodecPreference(semantic=types.PLANE_SEMANTIC_COLOUR,
                                                        codecs=[types.CODEC_JPEG], quality=HUGE)]},
    "no such channel": {"channel": "\x1b[2J" + "x" * 1000},
    "no such mode": {"modes": [99]},
}


def absurd_configures(field):
    """Values beyond every limit, one after the other on the same session."""
    with Connection(field.target) as connection:
        session = Session(connection)
        for name, wishes in ABSURD.items():
            session.configure(**wishes)
            answer = session.answer(3.0)
            if not isinstance(answer, v1.Refused) or not answer.message:
                field.expect(f"{name} is refused", False, answer)
        session.configure()
        field.expect("an ordinary wish is granted after them", isinstance(session.answer(3.0), v1.Configured))


def unread_streams(field):
    """Forty sessions whose frames nobody reads."""
    with Connection(field.target, stream_window=1000) as connection:
        sessions = []
        for _ in range(40):
            with contextlib.suppress(Closed):
                sessions.append(Session(connection))
                sessions[-1].call.is_read = False
                sessions[-1].configure()
        while field.has_time(5.0):
            connection.pump(0.1)
        field.expect("sessions were open", len(sessions) > 10, len(sessions))


def unacknowledged_streams(field):
    """Forty sessions that read everything and acknowledge nothing."""
    with Connection(field.target) as connection:
        sessions, frames = [], 0
        for _ in range(40):
            with contextlib.suppress(Closed):
                sessions.append(Session(connection))
                sessions[-1].configure()
        while field.has_time(5.0):
            for session in sessions:
                with contextlib.suppress(Closed):
                    frames += session.read_frame(0.002) is not None
        most = 8 * len(sessions)  # credits, docs/protocol.md
        field.expect("each gets 8 frames at most", 0 < frames <= most, f"{frames} of {len(sessions)} sessions")


def acknowledgement_flood(field):
    """Acknowledgements of frames that never were, as fast as they go."""
    with Connection(field.target) as connection:
        session, sent = Session(connection), 0
        session.configure()
        session.answer()
        message = v1.ClientMessage(frame_ack=v1.FrameAck(frame_id=1 << 60, epoch=77)).SerializeToString()
        packed = (b"\0" + len(message).to_bytes(4, "big") + message) * 500
        try:
            while field.has_time(6.0):
                connection.send(session.call.stream, packed, False)
                sent += 500
                connection.pump(0)
                session.call.messages.clear()
                if session.call.is_over:
                    break
        except Closed:
            pass
        field.expect("is cut off with RESOURCE_EXHAUSTED", session.call.finish(2.0) == 8,
                     f"status {session.call.status} after {sent} messages")


def metadata_bombs(field):
    """Calls with 64 KB of metadata, a thousand fields of it, or empty fields without end."""
    many = b"".join(literal_field(b"bomb-%d" % i, b"y" * 40) for i in range(1000))
    bombs = [literal_field(b"bomb", b"x" * 60_000), many,
             literal_field(b"authorization", b"Bearer " + b"z" * 30_000) * 2, literal_field(b"bomb-bin", b"A" * 50_000),
             literal_field(b"b", b"") * 15_000]
    sent = 0
    while field.has_time(5.0):
        with contextlib.suppress(OSError), RawConnection(field.target) as connection:
            block = connection.header_block(OPEN)
            for stream in range(1, 120, 2):
                if not connection.push(header_frames(stream, block + bombs[stream // 2 % len(bombs)])):
                    break
                sent += 1
    field.expect("bombs were sent", sent > 50, sent)


def drain_under_attack(field):
    """TERM while thirty sessions ignore GoingAway and others keep coming."""
    with Connection(field.target) as connection:
        for _ in range(30):
            with contextlib.suppress(Closed):
                Session(connection).configure()
        field.server.child.send_signal(processes.signal.SIGTERM)
        begin, refused = time.monotonic(), 0
        while field.server.is_running() and time.monotonic() - begin < 9.5:
            try:
                with Connection(field.target) as late:
                    refused += late.call(OPEN).finish(0.2) not in (None, 0)
            except (OSError, Closed):
                refused += 1
                let_pass(0.05)
        took = time.monotonic() - begin
        field.expect("has ended within the 8 s that the drain may take", took < 9.0,
                 f"{took:.1f} s, {refused} turned away")


def tls_garbage(field):
    """Handshakes that are none, stop half-way, or speak plain HTTP/2 to the port of TLS."""
    noise = random.Random(SEED)
    hello = bytes.fromhex("160301020001 0001fc0303".replace(" ", ""))
    starts = [b"", hello, hello + noise.randbytes(600), PREFACE + frame(4, 0, 0), b"\x80\x2e\x01\0\x02",
              noise.randbytes(4000)]
    target = dataclasses.replace(field.target, ca=None)
    held = []
    for attempt in range(150):
        if not field.has_time(5.0):
            break
        with contextlib.suppress(OSError):
            connection = RawConnection(target, speaks=False)
            connection.push(starts[attempt % len(starts)])
            held.append(connection)
            if len(held) > 30:
                held.pop(0).close()
    for connection in held:
        connection.close()
    field.expect("handshakes were begun", attempt > 20, attempt + 1)


def damaged_recordings(field):
    """Recordings with damaged bytes, each served by a server of its own, which says what is wrong or serves what is left."""
    noise, codes = random.Random(SEED), {}
    for attempt in range(8):
        if not field.has_time(8.0):
            break
        folder = field.folder / f"damaged{attempt}"
        folder.mkdir()
        path = folder / "damaged.fcrec"
        path.write_bytes(recordings.damaged(noise))
        try:
            with processes.Server(field.program, folder, ["--replay", f"damaged={path}"]) as server, \
                    Connection(Target(server.port)) as connection:
                session = Session(connection)
                session.configure()
                with contextlib.suppress(Closed):
                    session.read_frame(0.5)
                connection.close()
                code = server.stop()[1]
        except processes.NotStarted as problem:
            code = problem.code
        codes[code] = codes.get(code, 0) + 1
    field.expect("each ends with 0, or with 2 at the start", set(codes) <= {0, 2}, codes)


SESSIONS = 3 * 45  # log lines: opened, configured, closed
MANY = "what one address may open is logged: 3 lines for a session, so many sessions"
QUIET = "garbage is logged once a second, and a session takes 3 lines"
SCENARIOS = [
    Scenario("garbage", 0, "bytes that are no HTTP/2, or begin like it", garbage, Bounds(QUIET)),
    Scenario("garbage-messages", 0, "gRPC messages that are none, or too long", garbage_messages,
             Bounds(MANY, log_lines=SESSIONS)),
    Scenario("absurd-configures", 0, "values beyond every limit", absurd_configures,
             Bounds("each refusal is logged, and a session takes 3 lines", log_lines=len(ABSURD) + 4)),
    Scenario("unread", 0, "forty sessions that do not read", unread_streams, Bounds(MANY, log_lines=SESSIONS)),
    Scenario("unacknowledged", 0, "forty sessions that acknowledge nothing", unacknowledged_streams,
             Bounds(MANY, log_lines=SESSIONS)),
    Scenario("acknowledgement-flood", 0, "acknowledgements of frames that never were", acknowledgement_flood,
             Bounds(QUIET)),
    Scenario("metadata-bombs-envoy", 0, "metadata of 60 KB and more, through Envoy", metadata_bombs,
             Bounds("Envoy's only thread is busy with them: 28 % of the frames came on a machine with far too much work",
                    share=0.1, gap_frames=90.0), Setup(front="envoy")),
    Scenario("drain", 0, "TERM while thirty sessions ignore GoingAway and others come", drain_under_attack,
             Bounds("sessions take 3 lines, those refused meanwhile are logged up to 26 times", log_lines=3 * 30 + 60),
             Setup(has_honest=False)),
    Scenario("tls-garbage", 0, "TLS handshakes that are none, or stop half-way", tls_garbage, Bounds(QUIET),
             Setup(front="tls")),
    Scenario("damaged-recordings", 0, "recordings with damaged bytes", damaged_recordings, Bounds(QUIET)),
]
