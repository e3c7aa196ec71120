# SPDX-License-Identifier: Apache-2.0
"""What a scenario is, how it is run beside an honest client, and when its bounds hold."""
import contextlib
import dataclasses
import pathlib
import subprocess
import tempfile
import time
import typing

import probes
import processes
from connection import Closed, Target
from honest import Honest
from waiting import let_pass

ATTACK_S = 10.0  # the longest that a quick attack may take
FIRST_FRAMES_S = 60.0
BASELINE_S = 1.5
SETTLE_S = 1.0  # after the attack: what it caused shows, and still counts
# AddressSanitizer multiplies memory by 3.4 on average (Serebryany et al., USENIX ATC 2012, table 2), and its quarantine
# keeps 8 MiB of what was freed (processes.ASAN_OPTIONS).
ASAN_FACTOR = 3.4
ASAN_QUARANTINE_MIB = 8.0

REPLAY = ("--replay", f"golden={processes.REPLAY}", "--replay-fps", "30")
ATELIER = ("--scene", str(processes.ATELIER), "--size", "64x36", "--clock", "frames")


@dataclasses.dataclass(frozen=True)
class Setup:
    """The server, and what stands before it."""
    channels: tuple = REPLAY
    flags: tuple = ()
    front: str = "loopback"  # or `envoy`, or `tls`: the server itself ends it
    role: str = None  # of the token that everybody shows; None: the server asks for none
    max_descriptors: int = None
    has_honest: bool = True
    honest_grid: tuple = (2, 2)  # rows, columns
    honest_source: str = None  # address that the honest client comes from


@dataclasses.dataclass(frozen=True)
class Bounds:
    """What an attack may cost; `why` says where the numbers are from that are not these.

    These are for a server of 40 MiB on two cores that were both busy with other work: attacks that held took 0 to 8 MiB,
    and the honest client beside them got 98 to 103 % of its frames with gaps of at most 8 intervals. A quarter of the
    memory that the smallest attack of the past took (97 MiB), half of the frames, and a second without any (30 intervals)
    tell these apart from what went wrong before: 1 to 30 % of the frames, gaps of 170 intervals.
    """
    why: str
    memory_mib: float = 24.0  # growth of the server at its peak
    envoy_memory_mib: float = 64.0  # likewise, of Envoy
    descriptors: int = 8  # more than before, once the attack has ended
    threads: int = 16  # likewise; gRPC makes one for each core that waits, and one more now and then
    log_lines: int = 40  # in all
    share: float = 0.5  # of the frames per second that the honest client got before
    gap_frames: float = 30.0  # longest time without a frame, in intervals of those before
    attack_s: float = 30.0  # all of it, with the starts of programs and what the server takes to answer, on a busy machine
    stop_s: float = 10.0  # from TERM to the end
    exit_codes: tuple = (0,)


@dataclasses.dataclass(frozen=True)
class Scenario:
    name: str
    point: int  # of the list in docs/security.md; 0: a class that has always held
    does: str  # what the attacker does, for people
    attack: typing.Callable
    bounds: Bounds
    setup: Setup = Setup()
    is_quick: bool = True


@dataclasses.dataclass
class Field:
    """What an attack sees."""
    scenario: Scenario
    folder: pathlib.Path
    server: processes.Server
    target: Target  # as a client comes in
    direct: Target  # past Envoy
    honest: Honest = None
    envoy: processes.Envoy = None
    program: pathlib.Path = None
    facts: dict = dataclasses.field(default_factory=dict)  # name -> (holds, what was seen)
    began: float = dataclasses.field(default_factory=time.monotonic)

    def expect(self, name, holds, seen=""):
        """A promise of this scenario besides its bounds."""
        self.facts[name] = (bool(holds), str(seen))

    def has_time(self, seconds=ATTACK_S):
        return time.monotonic() - self.began < seconds


@dataclasses.dataclass(frozen=True)
class Line:
    """One row of the table."""
    bound: str
    allowed: str
    measured: str
    holds: bool


@dataclasses.dataclass
class Result:
    name: str
    seconds: float
    lines: list
    log: dict

    @property
    def holds(self):
        return all(line.holds for line in self.lines)


def at_most(name, limit, value, unit=""):
    return Line(name, f"≤ {limit:.4g}{unit}", f"{value:.4g}{unit}", value <= limit)


def at_least(name, limit, value, unit=""):
    return Line(name, f"≥ {limit:.4g}{unit}", f"{value:.4g}{unit}", value >= limit)


def memory_bound(mib, has_sanitizer):
    return mib * ASAN_FACTOR + ASAN_QUARANTINE_MIB if has_sanitizer else mib


def write_tokens(folder, program, role):
    """A token file with one line; the token that belongs to it."""
    made = subprocess.run([program, "--make-token", "tester", role], capture_output=True, text=True, check=True,
                          timeout=30).stdout.splitlines()
    token, line = [text for text in made if text and not text.startswith("#")]
    (folder / "tokens.txt").write_text(line + "\n", encoding="utf-8")
    return token


@contextlib.contextmanager
def field_of(scenario, program, messages):
    """Server, Envoy and honest client of a scenario."""
    setup = scenario.setup
    with contextlib.ExitStack() as stack:
        folder = pathlib.Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="hostile-")))
        flags, token, ca = [*setup.channels, *setup.flags], None, None
        if setup.role:
            token = write_tokens(folder, program, setup.role)
            flags += ["--tokens", folder / "tokens.txt"]
        if setup.front == "tls":
            ca, key = processes.make_certificate(folder)
            flags += ["--tls-cert", ca, "--tls-key", key]
        server = stack.enter_context(processes.Server(program, folder, flags, setup.max_descriptors))
        direct = Target(server.port, ca=ca, token=token)
        found = Field(scenario, folder, server, direct, direct, program=program)
        if setup.front == "envoy":
            found.envoy = stack.enter_context(processes.Envoy(folder, server.port))
            found.target = Target(found.envoy.port, ca=found.envoy.ca, token=token)
        if setup.has_honest:
            comes_from = dataclasses.replace(found.target, source=setup.honest_source)
            found.honest = stack.enter_context(Honest(messages, folder, comes_from, setup.honest_grid))
            if not found.honest.wait_for_frames(10, FIRST_FRAMES_S):
                raise processes.NotStarted("the honest client gets no frames: " + str(found.honest.said()[-3:]))
        yield found


def honest_lines(bounds, honest, before, begin, end):
    rate = honest.frames_per_second(*before)
    share = honest.frames_per_second(begin, end) / rate
    gap = honest.longest_gap_s(begin, end) * rate
    return [at_least("honest frames", 100 * bounds.share, 100 * share, " %"),
            at_most("longest gap", bounds.gap_frames, gap, " intervals"),
            at_most("streams lost", 0, honest.losses(begin, end))]


def run(scenario, program, messages):
    """Runs a scenario; everything that it started has ended afterwards."""
    begun, bounds = time.monotonic(), scenario.bounds
    has_sanitizer = processes.has_address_sanitizer(program)
    with field_of(scenario, program, messages) as field:
        pid = field.server.pid
        pids = [pid] + ([field.envoy.pid] if field.envoy else [])
        before = (time.monotonic(), time.monotonic() + BASELINE_S)
        if field.honest:
            let_pass(BASELINE_S)
        memory = {each: probes.resident_mib(each) for each in pids}
        open_files, threads, processor_s = probes.descriptors(pid), probes.threads(pid), probes.cpu_s(pid)
        log = probes.log_lines(field.server.log)
        field.began = time.monotonic()
        with probes.Peak(pids) as peak:
            with contextlib.suppress(Closed, ConnectionError):  # whoever attacks may be cut
                scenario.attack(field)
            attack_s = time.monotonic() - field.began
            if field.honest:
                let_pass(SETTLE_S)
        lines = [at_most("memory", memory_bound(bounds.memory_mib, has_sanitizer), peak.memory_mib[pid] - memory[pid],
                         " MiB")]
        if field.envoy:
            grown = peak.memory_mib[field.envoy.pid] - memory[field.envoy.pid]
            lines.append(at_most("memory of Envoy", bounds.envoy_memory_mib, grown, " MiB"))
        if field.server.is_running():
            lines.append(at_most("descriptors", bounds.descriptors, probes.descriptors(pid) - open_files))
            lines.append(at_most("threads", bounds.threads, probes.threads(pid) - threads))
            lines.append(Line("processor time", "", f"{probes.cpu_s(pid) - processor_s:.2f} s", True))
        if field.honest:
            lines += honest_lines(bounds, field.honest, before, field.began, time.monotonic())
        said = probes.log_lines(field.server.log) - log
        lines.append(at_most("log lines", bounds.log_lines, said.total()))
        stop_s, code = field.server.stop()
        lines.append(at_most("end after TERM", bounds.stop_s, stop_s, " s"))
        lines.append(Line("exit code", " or ".join(map(str, bounds.exit_codes)), str(code), code in bounds.exit_codes))
        lines += [Line(name, "", seen, holds) for name, (holds, seen) in field.facts.items()]
        lines.append(at_most("attack took", bounds.attack_s, attack_s, " s"))
        return Result(scenario.name, time.monotonic() - begun, lines, dict(said))
