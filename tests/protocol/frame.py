# SPDX-License-Identifier: Apache-2.0
"""Frames of docs/protocol.md, "Frames", put together from chunks. Strict: every statement of that section about order,
sizes, formats, key frames and checksums is checked, and what it does not allow raises Violation."""
import dataclasses
import math

import strip
from strip import require

DIFFUSE, SPECULAR, DEPTH, NORMAL, ID, MATERIAL, COLOUR = 1, 2, 3, 4, 5, 6, 7
INVERSE_DEPTH, RESIDUAL_COLOUR, RESIDUAL_INVERSE_DEPTH, TOTAL_LIGHT = 20, 21, 22, 30
LIGHT = {DIFFUSE, SPECULAR, TOTAL_LIGHT}
RESIDUAL = {RESIDUAL_COLOUR, RESIDUAL_INVERSE_DEPTH}
FORMATS = {DIFFUSE: {strip.R11G11B10F}, SPECULAR: {strip.R11G11B10F}, TOTAL_LIGHT: {strip.R11G11B10F},
           DEPTH: {strip.F32}, NORMAL: {strip.OCT2X16, strip.OCT2X8}, ID: {strip.U32}, MATERIAL: {strip.RG8},
           COLOUR: {strip.RGB8}, RESIDUAL_COLOUR: {strip.RGB8}, INVERSE_DEPTH: {strip.R16},
           RESIDUAL_INVERSE_DEPTH: {strip.R16}}
VIEWS = 1  # DeliveryMode


def crc32c_table():
    table = []
    for byte in range(256):
        for _ in range(8):
            byte = byte >> 1 ^ (0x82F63B78 if byte & 1 else 0)
        table.append(byte)
    return table


CRC_TABLE = crc32c_table()


def crc32c(data, crc=0):
    crc ^= 0xFFFFFFFF
    for byte in data:
        crc = CRC_TABLE[(crc ^ byte) & 0xFF] ^ crc >> 8
    return crc ^ 0xFFFFFFFF


@dataclasses.dataclass
class Part:
    semantic: int
    format: int
    codec: int
    width: int
    height: int
    pixels: bytearray = dataclasses.field(default_factory=bytearray)

    def rows(self, first, count):
        row_bytes = self.width * strip.PIXEL_BYTES[self.format]
        return bytes(self.pixels[first * row_bytes:(first + count) * row_bytes])


@dataclasses.dataclass
class Frame:
    id: int
    header: object
    parts: list
    order: list  # parts as they are sent
    reference: list = None  # parts of the key frame that strips may refer to
    trailer: object = None
    slices: list = dataclasses.field(default_factory=list)  # (StripSlice, payload) of the strip under way
    codings: set = dataclasses.field(default_factory=set)
    crc: int = 0
    next_index: int = 1

    def find(self, semantic):
        return next((part for part in self.parts if part.semantic == semantic), None)


def lattice_positions(grid):
    """In half steps, row-major: (row, column)."""
    if grid.anchor == 2:  # CENTRE
        return [(2 * r - (grid.rows - 1), 2 * c - (grid.cols - 1)) for r in range(grid.rows) for c in range(grid.cols)]
    return [(2 * (r - (grid.rows - 1) // 2), 2 * (c - (grid.cols - 1) // 2))
            for r in range(grid.rows) for c in range(grid.cols)]


def base_view(grid):
    positions = lattice_positions(grid)
    return positions.index(tuple(-(half % 2) for half in positions[0]))


def widened(header):
    band = header.guard_band
    return header.source.width_px + band.left_px + band.right_px, header.source.height_px + band.top_px + band.bottom_px


def plane_size(header, semantic):
    if semantic in RESIDUAL:
        return 1024, 8 * max(1, -(-len(header.residual.gaps) // 128))
    width, height = widened(header)
    sources = len(header.sources.positions) or 1
    return width, height * sources * (1 + header.layer_count if semantic in LIGHT else 1)


def check_camera(camera):
    m = camera.world_from_camera
    require(len(m) == 12 and all(math.isfinite(x) and abs(x) <= 1e9 for x in m), "camera: 12 numbers within 1e9")
    axes = [m[0:3], m[3:6], m[6:9]]
    for i, a in enumerate(axes):
        for j, b in enumerate(axes):
            require(abs(sum(x * y for x, y in zip(a, b)) - (i == j)) <= 1e-3, "camera: axes are not orthonormal")
    require(0 < camera.focal_px <= 1e6 and abs(camera.principal_x_px) <= 1e6 and abs(camera.principal_y_px) <= 1e6,
            "camera: focal length or principal point")


def parts_of(header, configured):
    """Parts of a frame and the order in which they come; sizes and formats as announced."""
    check_camera(header.source)
    require(header.layer_count in (0, 2), "header.layer_count")
    if configured.mode == VIEWS:
        require(header.WhichOneof("content") == "views" and header.views.view_set == configured.view_set, "other views")
        announced, = configured.planes
        require((announced.semantic, announced.format) == (COLOUR, strip.RGB8), "views are COLOUR in RGB8")
        view_set = header.views.view_set
        require((announced.width_px, announced.height_px) == (view_set.width_px, view_set.height_px) and
                announced.codec == header.views.codec, "views: another size or codec than announced")
        grid = view_set.grid
        parts = [Part(COLOUR, strip.RGB8, announced.codec, announced.width_px, announced.height_px)
                 for _ in range(grid.rows * grid.cols)]
        base = base_view(grid)
        return parts, [base] + [i for i in range(len(parts)) if i != base]
    planes = header.planes.planes
    require(header.WhichOneof("content") == "planes" and len(planes) == len(configured.planes), "other planes")
    for plane, announced in zip(planes, configured.planes):
        require((plane.semantic, plane.format, plane.codec) == (announced.semantic, announced.format, announced.codec),
                "a plane of another meaning, format or codec than announced")
        require(plane.format in FORMATS[plane.semantic], "a format that the meaning does not have")
        require((plane.width_px, plane.height_px) == plane_size(header, plane.semantic), "not the size of the header")
        require(plane.width_px <= announced.width_px and plane.height_px <= announced.height_px,
                f"{plane.width_px}x{plane.height_px} pixels, {announced.width_px}x{announced.height_px} were announced")
    has_tiles = any(plane.semantic in RESIDUAL for plane in planes)
    require(has_tiles == header.HasField("residual"), "residual layer without its planes")
    require(header.inverse_depth_unit > 0 or not any(p.format == strip.R16 for p in planes), "inverse_depth_unit")
    return [Part(p.semantic, p.format, p.codec, p.width_px, p.height_px) for p in planes], list(range(len(planes)))


class Assembler:
    """One epoch of one stream."""

    def __init__(self, configured, keeps_key_frames):
        self.configured, self.keeps_key_frames = configured, keeps_key_frames
        self.frame, self.key, self.last_id = None, None, 0

    def add(self, chunk):
        """The frame that the chunk completes, or None."""
        require(chunk.epoch == self.configured.epoch, "chunk of another epoch")
        require(len(chunk.payload) <= self.configured.chunk_bytes, "payload beyond chunk_bytes")
        kind = chunk.WhichOneof("content")
        if kind == "header":
            return self.begin(chunk)
        require(self.frame and chunk.frame_id == self.frame.id, f"{kind} of no frame under way")
        require(chunk.index == self.frame.next_index, "chunks are not counted one by one")
        self.frame.next_index += 1
        if kind == "strip":
            return self.add_slice(chunk.strip, chunk.payload)
        require(kind == "trailer" and not chunk.payload, "no trailer, or one with payload")
        return self.finish(chunk.trailer)

    def begin(self, chunk):
        require(self.frame is None, "a frame begins before the last one ends")
        require(chunk.index == 0 and not chunk.payload and chunk.frame_id > self.last_id, "header: index or id")
        self.last_id = chunk.frame_id
        self.frame = Frame(chunk.frame_id, chunk.header, *parts_of(chunk.header, self.configured))
        key_id = chunk.header.key_frame_id
        require(key_id == 0 or self.keeps_key_frames, "a key frame for a client that keeps none")
        if key_id not in (0, chunk.frame_id):
            require(self.key and self.key.id == key_id, "refers to another frame than the last key frame")
            self.frame.reference = self.key.parts
        for part in self.frame.parts:
            part.pixels = bytearray()

    def add_slice(self, piece, payload):
        slices, frame = self.frame.slices, self.frame
        require(payload, "strip without payload")
        if not slices:
            part = frame.parts[piece.part]
            at = len(part.pixels) // (part.width * strip.PIXEL_BYTES[part.format])
            require(piece.part == frame.order[0] and piece.first_row == at and piece.row_count >= 1
                    and at + piece.row_count <= part.height, "parts, or rows of a part, out of order")
        for before, _ in slices[-1:]:
            require((piece.part, piece.first_row, piece.row_count, piece.strip_bytes) ==
                    (before.part, before.first_row, before.row_count, before.strip_bytes), "strips are interleaved")
        require(piece.slice_offset == sum(len(data) for _, data in slices), "slices do not follow each other")
        slices.append((piece, payload))
        frame.crc = crc32c(payload, frame.crc)
        total = sum(len(data) for _, data in slices)
        require(total <= piece.strip_bytes, "slices beyond strip_bytes")
        if total == piece.strip_bytes:
            self.decode(piece, b"".join(data for _, data in slices))
            slices.clear()

    def decode(self, piece, data):
        part = self.frame.parts[piece.part]
        rows = (piece.first_row, piece.row_count)
        may_refer = self.frame.reference is not None and part.semantic not in RESIDUAL
        reference = self.frame.reference[piece.part].rows(*rows) if may_refer else None
        part.pixels += strip.decode(data, part.format, part.width, rows, part.codec, reference)
        self.frame.codings.add((data[1], data[3]))
        if piece.first_row + piece.row_count == part.height:
            self.frame.order.pop(0)

    def finish(self, trailer):
        frame, self.frame = self.frame, None
        require(not frame.order and not frame.slices, "trailer before all rows")
        require(trailer.crc32c == frame.crc, "crc32c")
        views = len(frame.parts) if self.configured.mode == VIEWS else 0
        require(len(trailer.discards) == views, "discards: one per view")
        for counts, part in zip(trailer.discards, frame.parts):
            total = counts.out_of_frustum + counts.id + counts.plane + counts.normal
            require(total <= part.width * part.height, "discards: more pixels than the view has")
        t = trailer.times
        require(t.pose_sampled_ns <= t.render_begin_ns <= t.render_end_ns <= t.encode_begin_ns <= t.encode_end_ns
                <= t.send_begin_ns <= t.send_end_ns, "times are not in order")
        frame.trailer = trailer
        if frame.header.key_frame_id == frame.id:
            self.key = frame
        return frame
