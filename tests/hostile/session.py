# SPDX-License-Identifier: Apache-2.0
"""One session of LightField.Open, as docs/protocol.md says."""
import dataclasses
import time

from connection import Closed
from fieldcast.v1 import light_field_pb2 as v1

OPEN = "/fieldcast.v1.LightField/Open"


@dataclasses.dataclass(frozen=True)
class Frame:
    frame_id: int
    epoch: int
    payload_bytes: int


class Broken(Exception):
    """The server does not keep to the protocol."""


class Session:
    def __init__(self, connection):
        self.call = connection.call(OPEN)
        self._requests = 0
        self._chunks = 0  # of the frame that is coming; 0: none is
        self._payload_bytes = 0

    def send(self, **message):
        self.call.send(v1.ClientMessage(**message).SerializeToString())

    def configure(self, **wishes):
        """Asks; the answer comes with `answer`."""
        self._requests += 1
        self.send(configure=v1.Configure(request_id=self._requests, **wishes))

    def read(self, timeout_s):
        """The next message; None when none came in time."""
        data = self.call.receive(timeout_s)
        return None if data is None else v1.ServerMessage.FromString(data)

    def read_until(self, kinds, timeout_s):
        """The next message of one of these kinds; None when none came in time."""
        deadline = time.monotonic() + timeout_s
        while (left := deadline - time.monotonic()) > 0:
            message = self.read(left)
            if message is not None and message.WhichOneof("message") in kinds:
                return message
        return None

    def answer(self, timeout_s=10.0):
        """Configured or Refused; None when neither came in time."""
        found = self.read_until(("configured", "refused"), timeout_s)
        return None if found is None else getattr(found, found.WhichOneof("message"))

    def read_frame(self, timeout_s):
        """The next complete frame; None when none came in time. Broken: chunks do not follow each other."""
        deadline = time.monotonic() + timeout_s
        while (left := deadline - time.monotonic()) > 0:
            message = self.read_until(("frame_chunk", "frame_aborted", "going_away"), left)
            if message is None:
                return None
            if message.HasField("going_away"):
                raise Closed("GoingAway: " + message.going_away.reason)
            frame = self._take(message) if message.HasField("frame_chunk") else self._forget()
            if frame is not None:
                return frame
        return None

    def _forget(self):
        self._chunks = 0

    def _take(self, message):
        chunk = message.frame_chunk
        if chunk.index != self._chunks:
            raise Broken(f"chunk {chunk.index} of frame {chunk.frame_id} comes where {self._chunks} should")
        self._payload_bytes = len(chunk.payload) + (self._payload_bytes if chunk.index else 0)
        self._chunks += 1
        if not chunk.HasField("trailer"):
            return None
        self._chunks = 0
        return Frame(chunk.frame_id, chunk.epoch, self._payload_bytes)

    def acknowledge(self, frame):
        now = time.monotonic_ns()
        self.send(frame_ack=v1.FrameAck(frame_id=frame.frame_id, epoch=frame.epoch, outcome=v1.FRAME_OUTCOME_DECODED,
                                        first_byte_ns=now, last_byte_ns=now, decoded_ns=now))
