# SPDX-License-Identifier: Apache-2.0
"""A bad connection to a server on this machine: forwards TCP with delay, jitter, a limited rate and stalls.

    with Relay(target_port, Network("slow", delay_ms=10, rate_mbit=20)) as relay:
        connect to 127.0.0.1:relay.port

It works on the bytes of a connection, not on packets. It models a lost packet by its effect on the reader: it
and all later packets arrive a round trip later. The sender's congestion control does not notice the loss.
"""
import asyncio
import dataclasses
import random
import socket
import threading

PACKET_BYTES = 1448
QUEUE_BYTES = 256 * 1024  # of the slow router; when it is full, the sender waits
READ_BYTES = 16 * 1024


@dataclasses.dataclass(frozen=True)
class Network:
    """Properties of each direction of a network."""
    name: str
    delay_ms: float = 0.0
    jitter_ms: float = 0.0  # +-, uniform
    loss_percent: float = 0.0  # of packets
    rate_mbit: float = 0.0  # 0: unlimited


class Direction:
    """One direction of one connection: reads data and writes it after its delay."""

    def __init__(self, network, reader, writer, seed):
        self.network, self.reader, self.writer = network, reader, writer
        self.random = random.Random(seed)
        self.queue = asyncio.Queue()
        self.link_free = 0.0
        self.last_arrival = 0.0

    def arrival(self, size, now):
        """Arrival time of `size` bytes that are read now; never before that of earlier bytes."""
        network = self.network
        self.link_free = max(self.link_free, now)
        if network.rate_mbit > 0:
            self.link_free += size * 8 / (network.rate_mbit * 1e6)
        delay = network.delay_ms + network.jitter_ms * self.random.uniform(-1, 1)
        packets = -(-size // PACKET_BYTES)
        if self.random.random() < 1 - (1 - network.loss_percent / 100) ** packets:
            delay += 2 * network.delay_ms
        self.last_arrival = max(self.last_arrival, self.link_free + max(delay, 0) / 1000)
        return self.last_arrival

    async def read(self):
        loop = asyncio.get_running_loop()
        while data := await self.reader.read(READ_BYTES):
            self.queue.put_nowait((self.arrival(len(data), loop.time()), data))
            if self.network.rate_mbit > 0:  # wait while the queue is full
                full = QUEUE_BYTES * 8 / (self.network.rate_mbit * 1e6)
                await asyncio.sleep(max(self.link_free - loop.time() - full, 0))
        self.queue.put_nowait(None)

    async def write(self):
        loop = asyncio.get_running_loop()
        while item := await self.queue.get():
            at, data = item
            await asyncio.sleep(max(at - loop.time(), 0))
            self.writer.write(data)
            await self.writer.drain()
        self.writer.close()

    async def run(self):
        try:
            await asyncio.gather(self.read(), self.write())
        except (OSError, asyncio.CancelledError):
            pass  # one end or the relay was closed
        finally:
            self.writer.close()


class Relay:
    """Listens on a port of loopback within its `with` block, in a thread of its own."""

    def __init__(self, target_port, network):
        self.target_port, self.network = target_port, network
        self.port = 0
        self.loop = asyncio.new_event_loop()
        self.is_ready = threading.Event()
        self.thread = threading.Thread(target=self.run, daemon=True)

    def __enter__(self):
        self.thread.start()
        self.is_ready.wait()
        return self

    def __exit__(self, *_):
        self.loop.call_soon_threadsafe(self.loop.stop)
        self.thread.join()

    def run(self):
        asyncio.set_event_loop(self.loop)
        server = self.loop.run_until_complete(asyncio.start_server(self.pass_on, "127.0.0.1", 0, limit=READ_BYTES))
        self.port = server.sockets[0].getsockname()[1]
        self.is_ready.set()
        self.loop.run_forever()
        server.close()
        tasks = asyncio.all_tasks(self.loop)
        for task in tasks:
            task.cancel()
        self.loop.run_until_complete(asyncio.gather(*tasks, return_exceptions=True))
        self.loop.close()

    async def pass_on(self, reader, writer):
        # A small buffer: otherwise the system buffers megabytes that have not passed the slow link.
        target = socket.socket()
        target.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 64 * 1024)
        target.setblocking(False)
        await asyncio.get_running_loop().sock_connect(target, ("127.0.0.1", self.target_port))
        target.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        target_reader, target_writer = await asyncio.open_connection(sock=target, limit=READ_BYTES)
        await asyncio.gather(Direction(self.network, reader, target_writer, 1).run(),
                             Direction(self.network, target_reader, writer, 2).run())
