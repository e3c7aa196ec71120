# SPDX-License-Identifier: Apache-2.0
"""A server that answers every call with a status whose text means to steer the terminal of whoever reads it."""
import socket
import threading

import h2.config
import h2.connection
import h2.events
import h2.exceptions

PATIENCE_S = 0.2


class FakeServer:
    def __init__(self, message):
        self._message = message
        self._listener = socket.create_server(("127.0.0.1", 0))
        self._listener.settimeout(PATIENCE_S)
        self.port = self._listener.getsockname()[1]
        self._end = threading.Event()
        self._thread = threading.Thread(target=self._accept, daemon=True)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._end.set()
        self._thread.join()
        self._listener.close()

    def _accept(self):
        while not self._end.is_set():
            try:
                connection, _ = self._listener.accept()
            except TimeoutError:
                continue
            threading.Thread(target=self._serve, args=(connection,), daemon=True).start()

    def _serve(self, connection):
        connection.settimeout(PATIENCE_S)
        state = h2.connection.H2Connection(h2.config.H2Configuration(client_side=False))
        state.initiate_connection()
        with connection:
            while not self._end.is_set():
                try:
                    connection.sendall(state.data_to_send())
                    data = connection.recv(1 << 16)
                    if not data:
                        return
                    events = state.receive_data(data)
                except TimeoutError:
                    continue
                except (OSError, h2.exceptions.ProtocolError):
                    return
                for event in events:
                    if isinstance(event, h2.events.RequestReceived):
                        state.send_headers(event.stream_id, [(":status", "200"), ("content-type", "application/grpc"),
                                                             ("grpc-status", "3"), ("grpc-message", self._message)],
                                           end_stream=True)
