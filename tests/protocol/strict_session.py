# SPDX-License-Identifier: Apache-2.0
"""A session of docs/protocol.md, "Session", and a bundle of "Scene bundle". What the page does not allow raises
Violation."""
import hashlib
import math
import struct
import time

import frame as frames
from strip import Violation, require

from fieldcast.v1 import light_field_pb2 as v1

OPEN = "/fieldcast.v1.LightField/Open"
PATIENCE_S = 60.0  # for frames of a software device on a busy machine

QUALITIES = (0, 10, 25, 40, 55, 75, 90)  # 0 of lossless codecs; 75 is the channel's own, too


def check_configured(asked, configured):
    """What holds for every Configured, and for the planes of channels with one source."""
    require(configured.request_id == asked.request_id and len(configured.scene_hash) == 32, "Configured: id or hash")
    require(16 << 10 <= configured.chunk_bytes <= 2 << 20, "Configured: chunk_bytes")
    require(2 <= configured.max_frames_in_flight <= 8 and configured.max_bytes_in_flight > 0, "Configured: credits")
    require(configured.frames_per_second > 0 and not configured.HasField("adapted"), "Configured: rate or adapted")
    grid = configured.view_set.grid
    require(1 <= grid.rows * grid.cols <= 72 and grid.anchor in (1, 2), "Configured: grid")
    require(all(map(grid.HasField, ("spacing_x_m", "spacing_y_m", "convergence_m"))), "Configured: unset wishes")
    require(0 < configured.view_set.fovy_rad < math.pi, "Configured: field of view")
    named = {preference.semantic: list(preference.codecs) for preference in asked.codecs}
    for plane in configured.planes:
        require(plane.quality in QUALITIES, f"Configured: quality {plane.quality}")
        require(plane.codec in (named.get(plane.semantic) or [2, 1]), "Configured: a codec that was not asked for")
        require(1 <= plane.width_px <= 16384 and 1 <= plane.height_px <= 16384, "Configured: size of a plane")


class Session:
    """Acknowledges every frame. `other` counts the messages of other kinds."""

    def __init__(self, connection, keeps_key_frames=True):
        self.call = connection.call(OPEN)
        self.keeps_key_frames = keeps_key_frames
        self.asked, self.answer, self.assembler, self.epoch = None, None, None, 0
        self.done, self.other = [], {}

    def send(self, **message):
        self.call.send(v1.ClientMessage(**message).SerializeToString())

    def configure(self, **wishes):
        """Configured or Refused; frames of the epoch before may come first."""
        number = self.asked.request_id + 1 if self.asked else 1
        self.asked = v1.Configure(request_id=number, keeps_key_frames=self.keeps_key_frames, **wishes)
        self.answer = None
        self.send(configure=self.asked)
        self.read_until(lambda: self.answer is not None)
        return self.answer

    def frames(self, count):
        self.done.clear()
        self.read_until(lambda: len(self.done) >= count)
        return self.done[:count]

    def read_until(self, is_so):
        deadline = time.monotonic() + PATIENCE_S
        while not is_so():
            data = self.call.receive(deadline - time.monotonic())
            require(data is not None, "nothing came in time")
            self.take(v1.ServerMessage.FromString(data))

    def take(self, message):
        kind = message.WhichOneof("message")
        if kind == "frame_chunk":
            self.take_chunk(message.frame_chunk)
        elif kind == "configured":
            require(self.answer is None and message.configured.epoch > self.epoch, "a second answer, or an old epoch")
            check_configured(self.asked, message.configured)
            require(self.assembler is None or self.assembler.frame is None, "Configured inside a frame")
            self.answer, self.epoch = message.configured, message.configured.epoch
            self.assembler = frames.Assembler(message.configured, self.keeps_key_frames)
        elif kind == "refused":
            require(self.answer is None and message.refused.request_id == self.asked.request_id, "a second answer")
            self.answer = message.refused
        elif kind == "frame_aborted":
            begun = self.assembler.frame
            require(begun and begun.id == message.frame_aborted.frame_id, "aborts another frame")
            self.assembler.frame = None
        elif kind == "time_sync":
            require(message.time_sync.server_receive_ns <= message.time_sync.server_send_ns, "TimeSyncResponse: times")
        self.other[kind] = self.other.get(kind, 0) + 1

    def take_chunk(self, chunk):
        require(self.assembler, "a frame before Configured")
        done = self.assembler.add(chunk)
        if done:
            self.done.append(done)
            now = time.monotonic_ns()
            self.send(frame_ack=v1.FrameAck(frame_id=done.id, epoch=self.epoch, outcome=v1.FRAME_OUTCOME_DECODED,
                                            first_byte_ns=now, last_byte_ns=now, decoded_ns=now))

    def close(self):
        """Half-closes; the status."""
        self.call.half_close()
        return self.call.finish(PATIENCE_S)


class Reader:
    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, size):
        require(size <= len(self.data) - self.at, "bundle: ends early")
        self.at += size
        return self.data[self.at - size:self.at]

    def number(self, code):
        return struct.unpack("<" + code, self.take(struct.calcsize("<" + code)))[0]

    def path(self):
        text = self.take(self.number("H"))
        segments = text.split(b"/")
        is_plain = len(text) <= 1024 and all(0 < len(s) <= 255 and s not in (b".", b"..") for s in segments)
        has_scheme = b":" in segments[0]
        is_plain = is_plain and not has_scheme and b"\\" not in text and min(text) >= 0x20
        require(not text or is_plain, f"bundle: path {text}")
        return text


def read_bundle(data, expected_hash):
    """(sky, glTF path, environment path, {path: bytes})."""
    require(hashlib.sha256(data).digest() == expected_hash, "bundle: SHA-256")
    reader = Reader(data)
    require(reader.take(8) == b"FCBUNDLE" and reader.number("I") == 1, "bundle: magic or version")
    sky = [reader.number("f") for _ in range(3)]
    require(all(0 <= x < math.inf for x in sky), "bundle: sky")
    main, environment = reader.path(), reader.path()
    count, files = reader.number("I"), {}
    require(count <= 65536, "bundle: number of files")
    for _ in range(count):
        path = reader.path()
        require(path and (not files or path > max(files)), "bundle: files are not sorted")
        files[path] = reader.take(reader.number("Q"))
    require(reader.at == len(data), "bundle: bytes after the last file")
    require(main in files and b"/" not in main, "bundle: glTF file")
    has_place = environment in files and environment.startswith(b"environment.fieldcast/sky")
    require(not environment or has_place, "bundle: environment image")
    for path in files:
        parents = [path[:i] for i, byte in enumerate(path) if byte == ord("/")]
        require(not any(parent in files for parent in parents), "bundle: a file is also a folder")
    return sky, main, environment, files


def fetch(connection, catalog, scene_hash, offset=0):
    """Bytes of the bundle from `offset` on, and the status."""
    call = connection.call("/fieldcast.v1.Catalog/FetchScene")
    call.send(catalog.FetchSceneRequest(scene_hash=scene_hash, offset=offset).SerializeToString(), end=True)
    status, data, total = call.finish(PATIENCE_S), b"", None
    while call.messages:
        chunk = catalog.SceneChunk.FromString(call.messages.popleft())
        require(chunk.offset == offset + len(data) and total in (None, chunk.total_bytes), "SceneChunk: gap or total")
        require(1 <= len(chunk.data) <= 1 << 20 or chunk.offset == chunk.total_bytes, "SceneChunk: size")
        total, data = chunk.total_bytes, data + chunk.data
    require(status != 0 or offset + len(data) == total, "FetchScene: ended early")
    return data, status
