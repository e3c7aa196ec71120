# SPDX-License-Identifier: Apache-2.0
"""Recordings that nobody recorded, made from the one of tests/data (docs/recordings.md, "The file")."""
import struct

from processes import REPLAY

FRAME, INDEX = 3, 4
PREAMBLE_BYTES = 8
POLYNOMIAL = 0x82F63B78  # Castagnoli, reflected


def crc32c(data):
    crc = 0xFFFFFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (POLYNOMIAL if crc & 1 else 0)
    return crc ^ 0xFFFFFFFF


def records():
    """(kind, content) of each record of the golden recording, without its index."""
    data, at = REPLAY.read_bytes(), PREAMBLE_BYTES
    while at + 12 <= len(data):
        kind, size, _ = struct.unpack_from("<III", data, at)
        if kind == INDEX:
            return
        yield kind, data[at + 12:at + 12 + size]
        at += 12 + size


def written(changed):
    """A file of these records, as a recorder leaves it that was killed: readers find the frames without an index."""
    out = bytearray(REPLAY.read_bytes()[:PREAMBLE_BYTES])
    for kind, content in changed:
        head = struct.pack("<II", kind, len(content))
        out += head + struct.pack("<I", crc32c(head + content)) + content
    return bytes(out)


def with_frames_apart(nanoseconds):
    """The golden recording with so little time between frames."""
    changed, frames = [], 0
    for kind, content in records():
        if kind == FRAME:
            content = content[:16] + struct.pack("<q", frames * nanoseconds) + content[24:]
            frames += 1
        changed.append((kind, content))
    return written(changed)


def damaged(noise):
    """One of many ways in which bytes of the golden recording may be wrong."""
    data = bytearray(REPLAY.read_bytes())
    choice = noise.randrange(4)
    if choice == 0:
        return bytes(data[:noise.randrange(len(data))])
    if choice == 1:  # a length of a record that claims a gigabyte
        struct.pack_into("<I", data, PREAMBLE_BYTES + 4, 1 << 30)
    elif choice == 2:
        for _ in range(50):
            data[noise.randrange(len(data))] = noise.randrange(256)
    else:
        begin = noise.randrange(len(data) - 2000)
        data[begin:begin + 2000] = noise.randbytes(2000)
    return bytes(data)
