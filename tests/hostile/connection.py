# SPDX-License-Identifier: Apache-2.0
"""gRPC calls over HTTP/2 on one socket, as docs/protocol.md says, without gRPC. One thread uses a connection."""
import collections
import dataclasses
import select
import socket
import ssl
import time

import h2.config
import h2.connection
import h2.errors
import h2.events
import h2.exceptions
import h2.settings

STREAM_WINDOW = 4 << 20
PATIENCE_S = 10.0  # for a connection and for the room to send


class Closed(Exception):
    """The other side ended the connection or the call."""


@dataclasses.dataclass(frozen=True)
class Target:
    """Where the service is, and as whom one comes."""
    port: int
    host: str = "127.0.0.1"
    ca: str = None  # PEM file: speak TLS
    token: str = None
    source: str = None  # address that we come from

    def open_socket(self):
        came_from = (self.source, 0) if self.source else None
        plain = socket.create_connection((self.host, self.port), timeout=PATIENCE_S, source_address=came_from)
        plain.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        if self.ca is None:
            return plain
        context = ssl.create_default_context(cafile=self.ca)
        context.check_hostname = False
        context.set_alpn_protocols(["h2"])
        return context.wrap_socket(plain)

    def headers(self, path):
        found = [(":method", "POST"), (":scheme", "https" if self.ca else "http"), (":path", path),
                 (":authority", f"{self.host}:{self.port}"), ("te", "trailers"), ("content-type", "application/grpc")]
        return found + ([("authorization", f"Bearer {self.token}")] if self.token else [])


class Call:
    """One call. What came lies in `messages`; `status` is the gRPC status once the call has ended."""

    def __init__(self, connection, stream):
        self.connection, self.stream = connection, stream
        self.messages = collections.deque()
        self.status = None
        self.status_message = ""
        self.is_over = False
        self.is_read = True  # False: leaves the window as it is, so that the server must stop
        self._bytes = bytearray()

    def take(self, data):
        self._bytes += data
        while len(self._bytes) >= 5:
            size = int.from_bytes(self._bytes[1:5], "big")
            if len(self._bytes) < 5 + size:
                return
            self.messages.append(bytes(self._bytes[5:5 + size]))
            del self._bytes[:5 + size]

    def take_headers(self, headers):
        found = {str(name): str(value) for name, value in headers}
        if "grpc-status" in found:
            self.status, self.status_message = int(found["grpc-status"]), found.get("grpc-message", "")
        elif found.get(":status", "200") != "200":
            self.status, self.status_message = 2, "HTTP status " + found[":status"]

    def send(self, message, end=False):
        self.connection.send(self.stream, b"\0" + len(message).to_bytes(4, "big") + message, end)

    def half_close(self):
        self.connection.send(self.stream, b"", True)

    def reset(self):
        self.connection.reset(self.stream)

    def receive(self, timeout_s):
        """The next message; None when none came in time. Closed: the call has ended."""
        deadline = time.monotonic() + timeout_s
        while not self.messages:
            if self.is_over:
                raise Closed(f"status {self.status}: {self.status_message}")
            left = deadline - time.monotonic()
            if left <= 0:
                return None
            self.connection.pump(left)
        return self.messages.popleft()

    def finish(self, timeout_s):
        """Waits for the end; the status, None if it did not come in time."""
        deadline = time.monotonic() + timeout_s
        while not self.is_over and time.monotonic() < deadline:
            try:
                self.connection.pump(deadline - time.monotonic())
            except Closed:
                break
        return self.status


class Connection:
    def __init__(self, target, stream_window=STREAM_WINDOW):
        self.target = target
        self.calls = {}
        self.is_over = False
        self._socket = target.open_socket()
        self._state = h2.connection.H2Connection(h2.config.H2Configuration(header_encoding="utf-8"))
        self._state.initiate_connection()
        self._state.update_settings({h2.settings.SettingCodes.INITIAL_WINDOW_SIZE: stream_window})
        self._state.increment_flow_control_window(64 << 20)
        self._flush()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self.is_over = True
        self._socket.close()

    def call(self, path, further=()):
        """Opens a stream; waits while the server allows no more of them."""
        deadline = time.monotonic() + PATIENCE_S
        while True:
            try:
                stream = self._state.get_next_available_stream_id()
                self._state.send_headers(stream, self.target.headers(path) + list(further))
                break
            except h2.exceptions.TooManyStreamsError:
                if time.monotonic() > deadline:
                    raise Closed("no room for a further stream") from None
                self.pump(0.1)
            except h2.exceptions.ProtocolError as problem:
                raise Closed(f"the connection takes no streams: {problem}") from problem
        self.calls[stream] = Call(self, stream)
        self._flush()
        return self.calls[stream]

    def ask(self, path, message=b"", timeout_s=PATIENCE_S):
        """A unary call: the answer's bytes. Closed: there is none."""
        call = self.call(path)
        call.send(message, end=True)
        answer = call.receive(timeout_s)
        if answer is None:
            raise Closed("no answer in time")
        return answer

    def send(self, stream, data, end):
        deadline = time.monotonic() + PATIENCE_S
        try:
            while True:
                room = min(self._state.local_flow_control_window(stream), self._state.max_outbound_frame_size)
                if room > 0 or not data:
                    is_last = len(data) <= room
                    self._state.send_data(stream, data[:room], end_stream=end and is_last)
                    self._flush()
                    data = data[room:]
                    if is_last:
                        return
                elif time.monotonic() > deadline:
                    raise Closed("the server does not read")
                else:
                    self.pump(0.05)
        except h2.exceptions.ProtocolError as problem:
            raise Closed(f"the stream takes no data: {problem}") from problem

    def reset(self, stream):
        try:
            self._state.reset_stream(stream, h2.errors.ErrorCodes.CANCEL)
        except h2.exceptions.ProtocolError:
            return  # it has ended already
        self._flush()

    def pump(self, timeout_s):
        """Takes in what has come, or comes within that time."""
        if self.is_over:
            raise Closed("the connection has ended")
        has_rest = isinstance(self._socket, ssl.SSLSocket) and self._socket.pending() > 0
        if not has_rest and not select.select([self._socket], [], [], max(0.0, timeout_s))[0]:
            return
        try:
            data = self._socket.recv(1 << 18)
            events = self._state.receive_data(data)
        except (OSError, h2.exceptions.ProtocolError) as problem:
            self._end(f"broken: {problem}")
            return
        for event in events:
            self._take(event)
        if data:
            self._flush()
        else:
            self._end("closed")

    def _take(self, event):
        call = self.calls.get(getattr(event, "stream_id", None))
        if isinstance(event, h2.events.ConnectionTerminated):
            self._end(f"GOAWAY {event.error_code}")
        elif call is None:
            return
        elif isinstance(event, h2.events.DataReceived):
            call.take(event.data)
            if call.is_read and event.flow_controlled_length:
                self._state.acknowledge_received_data(event.flow_controlled_length, event.stream_id)
        elif isinstance(event, (h2.events.ResponseReceived, h2.events.TrailersReceived)):
            call.take_headers(event.headers)
        elif isinstance(event, (h2.events.StreamEnded, h2.events.StreamReset)):
            call.is_over = True

    def _end(self, why):
        self.is_over = True
        for call in self.calls.values():
            if not call.is_over:
                call.is_over, call.status_message = True, why

    def _flush(self):
        try:
            self._socket.sendall(self._state.data_to_send())
        except OSError as problem:
            self._end(f"broken: {problem}")
            raise Closed(f"the connection broke: {problem}") from problem
