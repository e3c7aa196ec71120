# SPDX-License-Identifier: Apache-2.0
"""What starts, replays and prints."""
import subprocess
import time

import processes
import recordings
from connection import Connection, Target
from fake_server import FakeServer
from scenario import ATELIER, Bounds, Scenario, Setup
from session import Session
from waiting import comes_true



def escape_sequences(field):
    """A server's status text has bytes that steer a terminal; a client must not print them."""
    client = field.program.parents[1] / "client/fieldcast-client"
    if not client.exists():
        raise processes.NotStarted(f"{client} is not built")
    with FakeServer("%1B]0;owned%07%1B[2J%0D%9B31m%C2%9B31m no such thing") as fake:
        done = subprocess.run([client, "--server", f"127.0.0.1:{fake.port}", "--frames", "1", "--patience", "1",
                               "--save", "none"], capture_output=True, timeout=30, check=False, cwd=field.folder)
    said = done.stdout + done.stderr
    steering = [byte for byte in said if (byte < 0x20 and byte not in b"\n\t") or byte == 0x7F]
    is_clean = not steering and b"\xc2\x9b" not in said and b"\x9b" not in said.replace(b"\xc2\x9b", b"")
    field.expect("the client says what the status was", b"no such thing" in said, said[-200:])
    field.expect("no control characters are printed", is_clean, [hex(byte) for byte in steering[:5]])


def stopped_while_starting(field):
    """TERM before the server serves."""
    log = field.folder / "starting.log"
    port_file = field.folder / "starting.port"
    with processes.Process([field.program, *ATELIER, "--listen", "127.0.0.1:0", "--port-file",
                            port_file, "--log-format", "json"], log) as starting:
        comes_true(lambda: log.read_bytes() or not starting.is_running(), 30.0)
        took, code = starting.stop()
        field.expect("it was still starting", "SERVING" not in starting.text())
    field.expect("ends within 10 s", took <= 10.0, f"{took:.1f} s, exit code {code}")


def frames_without_time(field):
    """A recording whose frames are 1 ns apart."""
    path = field.folder / "fast.fcrec"
    path.write_bytes(recordings.with_frames_apart(1))
    folder = field.folder / "fast"
    folder.mkdir()
    try:
        with processes.Server(field.program, folder, ["--replay", f"fast={path}"]) as server, \
                Connection(Target(server.port)) as connection:
            session, begin, frames = Session(connection), time.monotonic(), 0
            session.configure()
            while time.monotonic() - begin < 2.0:
                frame = session.read_frame(0.5)
                if frame is not None:
                    session.acknowledge(frame)
                    frames += 1
            published = processes.metric(server.metrics_port, 'fieldcast_replayed_frames_total{channel="fast"}')
            took = time.monotonic() - begin
    except processes.NotStarted as problem:
        field.expect("is refused at the start, with the reason", "fast.fcrec" in str(problem), str(problem)[-200:])
        return
    field.expect("frames a second are at most 240", published / took <= 240, f"{published / took:.0f}")


ALONE = Setup(has_honest=False)
NOBODY = "no client is beside it: the attack meets another process"
SCENARIOS = [
    Scenario("term-while-starting", 11, "TERM before the server serves", stopped_while_starting,
             Bounds(NOBODY, attack_s=40.0), ALONE),
    Scenario("frames-without-time", 11, "a recording with frames 1 ns apart", frames_without_time,
             Bounds("two servers share the machine", attack_s=60.0)),
    Scenario("escape-sequences", 14, "a server's status that steers terminals", escape_sequences,
             Bounds(NOBODY, attack_s=30.0), ALONE),
]
