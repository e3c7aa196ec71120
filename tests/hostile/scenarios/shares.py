# SPDX-License-Identifier: Apache-2.0
"""What one client or address may take from the others."""
import contextlib
import dataclasses

import processes
from connection import Closed, Connection
from fieldcast.v1 import light_field_pb2 as v1
from fieldcast.v1 import types_pb2 as types
from scenario import ATELIER, Bounds, Scenario, Setup
from session import Session

RENDERED_VIEWS = 'fieldcast_views_total{channel="atelier",step="rendered"}'
RENDERED_FRAMES = 'fieldcast_frames_rendered_total{channel="atelier"}'


def views_beside(field, ours):
    """Renders ten frames for the honest client: views beside `ours` in each, and frames."""
    before = processes.metrics(field.server.metrics_port, RENDERED_VIEWS, RENDERED_FRAMES)
    field.honest.wait_for_frames(10, 10.0)
    after = processes.metrics(field.server.metrics_port, RENDERED_VIEWS, RENDERED_FRAMES)
    views, frames = (round(now - then) for now, then in zip(after, before))
    return views - frames * ours, frames


def never_acknowledged(field):
    """A client with 72 views takes frames as long as it has credit, and acknowledges none."""
    ours = field.scenario.setup.honest_grid[0] * field.scenario.setup.honest_grid[1]
    with Connection(field.target) as connection:
        session = Session(connection)
        session.configure(grid=types.Grid(rows=8, cols=9))
        session.answer()
        frames = 0
        while frames < 2:  # the credits of a client whose round trip is not known
            frames += session.read_frame(10.0) is not None
        further, made = views_beside(field, ours)
        # One that is being made, one that waits, and two around the time at which it should have acknowledged (decision 0018).
        field.expect("views without credit are rendered four times at most", further <= 4 * (72 - ours),
                     f"{further} views in {made} frames")
        further, made = views_beside(field, ours)
        # The page may be read between the two counts of a frame, so `further` may be off by `ours`.
        field.expect("views without credit are not rendered any more", made > 0 and further < 72 - ours,
                     f"{further} views in {made} frames")


def all_sessions(field):
    """One address opens as many sessions as it gets, and somebody else comes from another one."""
    with Connection(field.target) as connection, Connection(field.target) as further:
        granted = 0
        for each in [connection] * 64 + [further] * 64:
            with contextlib.suppress(Closed):
                session = Session(each)
                session.configure()
                granted += isinstance(session.answer(0.5), v1.Configured)
            if not field.has_time(6.0):
                break
        with Connection(dataclasses.replace(field.target, source="127.0.0.9")) as other:
            session = Session(other)
            session.configure()
            try:
                came = session.read_frame(3.0)
                field.expect("a newcomer from elsewhere gets frames", came is not None, f"{granted} sessions held")
            except Closed as problem:
                field.expect("a newcomer from elsewhere gets frames", False, problem)


RENDERED = Setup(ATELIER)
SCENARIOS = [
    Scenario("never-acknowledged", 6, "72 views for somebody who acknowledges nothing", never_acknowledged,
             Bounds("frames with 72 views more take longer until the credits are used up", share=0.3, attack_s=40.0),
             RENDERED),
    Scenario("all-sessions", 8, "one address takes all sessions that it gets", all_sessions,
             Bounds("sessions of one address are logged three times each, refusals 20 times", log_lines=3 * 17 + 40)),
]
