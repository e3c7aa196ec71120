# SPDX-License-Identifier: Apache-2.0
"""HTTP/2 frames as bytes, in an order that no library would send them in."""
import contextlib
import select
import time

import hpack

PREFACE = b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"
HEADERS, RST_STREAM, SETTINGS, CONTINUATION = 0x1, 0x3, 0x4, 0x9
END_HEADERS = 0x4


def frame(kind, flags, stream, payload=b""):
    return len(payload).to_bytes(3, "big") + bytes([kind, flags]) + stream.to_bytes(4, "big") + payload


def literal_field(name, value):
    """A header field without indexing (RFC 7541, section 6.2.2), however large."""
    return b"\0" + hpack.hpack.encode_integer(len(name), 7) + name + hpack.hpack.encode_integer(len(value), 7) + value


def header_frames(stream, block, flags=0, size=16_000):
    """A whole header block, however large: HEADERS and as many CONTINUATIONs as it needs."""
    parts = [block[at:at + size] for at in range(0, len(block), size)]
    kinds = [HEADERS] + [CONTINUATION] * (len(parts) - 1)
    ends = [0] * (len(parts) - 1) + [END_HEADERS]
    return b"".join(frame(kind, end | (flags if kind == HEADERS else 0), stream, part)
                    for kind, end, part in zip(kinds, ends, parts))


class RawConnection:
    """A connection that has said its preface; what the server says is thrown away."""

    def __init__(self, target, speaks=True):
        self.target = target
        self._socket = target.open_socket()
        self._socket.settimeout(0.2)
        self._encoder = hpack.Encoder()
        self.is_over = False
        if speaks:
            self.push(PREFACE + frame(SETTINGS, 0, 0))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        with contextlib.suppress(OSError):
            self._socket.close()

    def header_block(self, path, further=()):
        """Without entries of the dynamic table, so that every block stands alone."""
        headers = [*self.target.headers(path), *further]
        return self._encoder.encode([hpack.NeverIndexedHeaderTuple(name, value) for name, value in headers],
                                    huffman=False)

    def push(self, data):
        """False once the server has ended the connection, or has not read for 5 s."""
        view, deadline = memoryview(data), time.monotonic() + 5.0
        while view and not self.is_over:
            readable, writable, _ = select.select([self._socket], [self._socket], [], 0.2)
            try:
                if readable and not self._socket.recv(1 << 16):
                    self.is_over = True
                elif writable:
                    view = view[self._socket.send(view[:1 << 16]):]
                    deadline = time.monotonic() + 5.0
                elif time.monotonic() > deadline:
                    self.is_over = True
            except TimeoutError:
                continue
            except OSError:
                self.is_over = True
        return not self.is_over

    def is_closed_within(self, seconds):
        """Whether the server ends the connection in that time."""
        deadline = time.monotonic() + seconds
        while not self.is_over and time.monotonic() < deadline:
            if select.select([self._socket], [], [], deadline - time.monotonic())[0]:
                try:
                    self.is_over = not self._socket.recv(1 << 16)
                except TimeoutError:
                    continue
                except OSError:
                    self.is_over = True
        return self.is_over
