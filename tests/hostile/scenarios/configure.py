# SPDX-License-Identifier: Apache-2.0
"""Legal messages of sessions, as large, as small and as many as they may be."""
import contextlib
import time

import processes
from connection import Closed, Connection
from fieldcast.v1 import light_field_pb2 as v1
from fieldcast.v1 import types_pb2 as types
from scenario import ATELIER, Bounds, Scenario, Setup
from session import Session
from waiting import let_pass

RENDERED_VIEWS = 'fieldcast_views_total{channel="atelier",step="rendered"}'
ENCODED_VIEWS = 'fieldcast_views_total{channel="atelier",step="encoded"}'
MOST_ENCODINGS = 8  # six qualities, the channel's own and the lossless form: docs/protocol.md, "Session"
RESOURCE_EXHAUSTED = 8  # gRPC's number
CONFIGURED = b"\x0a"  # key of ServerMessage.configured


def large_configures(field):
    """Three sessions send Configures as large as they may be, with adaptation, 18 a second each."""
    with contextlib.suppress(Closed), Connection(field.target) as connection:
        session = Session(connection)
        session.configure(codecs=[v1.CodecPreference()] * 32_000)
        session.answer(2.0)
        field.expect("64 KB are too much", False)
    field.expect("64 KB are too much", session.call.status == RESOURCE_EXHAUSTED, f"status {session.call.status}")
    adaptation = v1.Adaptation(codecs=[types.CODEC_JPEG], min_quality=1, min_frames_per_second=0.1,
                               min_view_height_px=1, min_rows=1, min_cols=1)
    codecs = [v1.CodecPreference(codecs=[types.CODEC_JPEG] * 16, formats=[types.PLANE_FORMAT_RGB8] * 16)] * 32
    granted = 0
    with contextlib.ExitStack() as stack:
        sessions = [Session(stack.enter_context(Connection(field.target))) for _ in range(3)]
        next_at = time.monotonic()
        while field.has_time(6.0) and sessions:
            for session in list(sessions):
                try:
                    session.configure(codecs=codecs, adaptation=adaptation)
                    session.call.connection.pump(0)
                    granted += sum(message.startswith(CONFIGURED) for message in session.call.messages)
                    session.call.messages.clear()
                except Closed:
                    sessions.remove(session)
            next_at += 1 / 18
            let_pass(max(0.0, next_at - time.monotonic()))
    field.expect("they are granted while the rate allows it", granted > 3, granted)


def tiny_rates(field):
    """Frame rates close to nothing, which would be granted and never send a frame."""
    answers = {}
    for rate in (1e-30, 1e-45, 1e-6, 0.004):
        with Connection(field.target) as connection:
            session = Session(connection)
            session.configure(max_frames_per_second=rate)
            answers[rate] = session.answer()
    for rate, answer in answers.items():
        refused = isinstance(answer, v1.Refused)
        field.expect(f"{rate:g} frames a second is refused", refused,
                     answer.message if refused else "granted" if answer else "no answer")


def distinct_qualities(field):
    """Sessions that want the same views, each in a quality of its own."""
    with contextlib.ExitStack() as stack:
        connection = stack.enter_context(Connection(field.target))
        sessions = []
        for quality in range(20, 80):
            with contextlib.suppress(Closed):
                session = Session(connection)
                session.configure(grid=types.Grid(rows=6, cols=6), codecs=[v1.CodecPreference(
                    semantic=types.PLANE_SEMANTIC_COLOUR, codecs=[types.CODEC_JPEG], quality=quality)])
                sessions.append(session)
        before = processes.metrics(field.server.metrics_port, ENCODED_VIEWS, RENDERED_VIEWS)
        while field.has_time(8.0):
            for session in sessions:
                with contextlib.suppress(Closed):
                    frame = session.read_frame(0.002)
                    if frame is not None:
                        session.acknowledge(frame)
        after = processes.metrics(field.server.metrics_port, ENCODED_VIEWS, RENDERED_VIEWS)
        encoded, rendered = (now - then for now, then in zip(after, before))
        field.expect(f"a view is encoded {MOST_ENCODINGS} times at most", encoded <= MOST_ENCODINGS * rendered,
                     f"{encoded / max(rendered, 1):.1f} times, for {len(sessions)} sessions")


def steering_flood(field):
    """One session asks for the camera, again and again, as fast as messages may come."""
    with Connection(field.target) as connection:
        session = Session(connection)
        session.configure()
        session.answer()
        asked, next_at = 0, time.monotonic()
        while field.has_time(5.0):
            session.send(request_steering=v1.RequestSteering())
            session.send(release_steering=v1.ReleaseSteering())
            connection.pump(0)
            session.call.messages.clear()
            asked += 1
            next_at += 1 / 430
            let_pass(max(0.0, next_at - time.monotonic()))
        field.expect("steering was asked for", asked > 200, asked)


ANSWERS = "starts, ends and configurations of sessions are logged, 10 of a session and then one in 30 s"
SCENARIOS = [
    Scenario("large-configures", 4, "the largest Configures that may be sent, 18 a second from each of three sessions",
             large_configures, Bounds(ANSWERS, log_lines=60)),
    Scenario("tiny-rates", 5, "frame rates close to nothing", tiny_rates, Bounds(ANSWERS)),
    Scenario("distinct-qualities", 7, "sixty sessions with sixty qualities", distinct_qualities,
             Bounds("each session is logged three times; 36 views are rendered for them, the honest client has 4",
                    log_lines=200, share=0.1, attack_s=20.0), Setup(ATELIER, ("--max-sessions-per-peer", "64"))),
    Scenario("steering-flood", 10, "the camera asked for and given back, hundreds of times a second", steering_flood,
             Bounds("10 lines of steering, then one in 30 s, and what was left out"),
             Setup(ATELIER, ("--camera-control", "steered"))),
]
