# SPDX-License-Identifier: Apache-2.0
"""Tokens that are revoked while their streams run."""
import time

from connection import Closed, Connection
from scenario import Bounds, Scenario, Setup
from session import Session

REVOKED_WITHIN_S = 5.0  # docs/operations.md, "Who may call": from the change of the file to the end of streams


def revoked(field, change):
    """Changes the token file while a stream of its only token runs; both old and new streams must end."""
    tokens = field.folder / "tokens.txt"
    with Connection(field.target) as connection:
        session = Session(connection)
        session.configure()
        frame = session.read_frame(5.0)
        field.expect("the token is good before", frame is not None)
        begin = time.monotonic()
        change(tokens)
        ended = None
        while ended is None and time.monotonic() - begin < 9.0:
            try:
                frame = session.read_frame(0.2)
                if frame is not None:
                    session.acknowledge(frame)
            except Closed:
                ended = time.monotonic() - begin
        field.expect(f"the stream ends within {REVOKED_WITHIN_S:g} s", ended is not None and ended <= REVOKED_WITHIN_S,
                     "never" if ended is None else f"{ended:.1f} s")
    with Connection(field.target) as connection:
        call = connection.call("/fieldcast.v1.Catalog/GetServerInfo")
        call.send(b"", end=True)
        status = call.finish(2.0)
        field.expect("the token opens nothing afterwards", status == 16, f"status {status}")


def tokens_emptied(field):
    """The only line of the token file goes."""
    revoked(field, lambda path: path.write_text("", encoding="utf-8"))


def tokens_deleted(field):
    """The token file goes."""
    revoked(field, lambda path: path.unlink())


WITH_TOKENS = Setup(role="view", has_honest=False)
NOBODY = "no client is beside it: it would lose its token, too"
SCENARIOS = [
    Scenario("tokens-emptied", 12, "the only token taken out of the file", tokens_emptied, Bounds(NOBODY), WITH_TOKENS),
    Scenario("tokens-deleted", 12, "the token file deleted", tokens_deleted, Bounds(NOBODY), WITH_TOKENS),
]
