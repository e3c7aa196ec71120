# SPDX-License-Identifier: Apache-2.0
"""Attacks a server as docs/security.md says, beside an honest client, and holds what that costs to stated bounds.

    python3 tests/hostile/run.py --server build/release/server/fieldcast-server [--quick] [--front loopback|envoy|tls]
                                 [--only NAME …] [--list] [--json FILE]

Exit code 1: a bound is broken. 77: what is needed is not installed, as ctest takes for skipped. Loopback only.
"""
import argparse
import json
import pathlib
import sys

import packages


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--server", type=pathlib.Path, required=True)
    parser.add_argument("--only", nargs="+", metavar="NAME", help="these scenarios")
    parser.add_argument("--quick", action="store_true", help="leave out scenarios that take minutes")
    parser.add_argument("--front", nargs="+", choices=("loopback", "tls", "envoy"),
                        help="those where this stands before the server")
    parser.add_argument("--list", action="store_true", help="name the scenarios and end")
    parser.add_argument("--json", type=pathlib.Path, help="write what was measured to this file, too")
    return parser.parse_args()


def chosen(options, scenarios):
    names = {scenario.name for scenario in scenarios}
    unknown = set(options.only or ()) - names
    if unknown:
        sys.exit(f"run.py: --only {' '.join(sorted(unknown))}: no such scenario; there are {', '.join(sorted(names))}")
    return [scenario for scenario in scenarios
            if (not options.only or scenario.name in options.only) and (not options.quick or scenario.is_quick)
            and (not options.front or scenario.setup.front in options.front)]


def print_result(result):
    print(f"{result.name}: {'holds' if result.holds else 'BROKEN'} ({result.seconds:.1f} s)")
    for line in result.lines:
        verdict = "ok" if line.holds else "BROKEN"
        print(f"    {line.bound:<34} {line.allowed:>16}   {line.measured:<40} {verdict}")
    if not result.holds:
        print("    log: " + (", ".join(f"{count} × {kind}" for kind, count in sorted(result.log.items())) or "nothing"))
    sys.stdout.flush()


def run_all(options, wanted, messages):
    import processes
    import scenario as play

    results, skipped = [], []
    for each in wanted:
        if each.setup.front == "envoy" and not processes.ENVOY.exists():
            skipped.append(each.name)
            print(f"{each.name}: skipped, no Envoy at .cache/envoy; tests/deploy/install_envoy.py installs it")
            continue
        try:
            results.append(play.run(each, options.server.resolve(), messages))
        except processes.NotStarted as problem:
            results.append(play.Result(each.name, 0.0, [play.Line("starts", "", str(problem), False)], {}))
        print_result(results[-1])
    return results, skipped


def main():
    options = arguments()
    packages.run_where_they_are()
    messages = options.server.resolve().parents[1] / "tests/hostile/messages"
    packages.make_messages(messages)
    import scenarios

    wanted = chosen(options, scenarios.ALL)
    if options.list:
        for each in wanted:
            print(f"{each.name:<28} {each.setup.front:<9} {each.does}")
        return 0
    results, skipped = run_all(options, wanted, messages)
    if options.json:
        rows = [{"name": r.name, "holds": r.holds, "seconds": r.seconds, "log": r.log,
                 "lines": [vars(line) for line in r.lines]} for r in results]
        options.json.write_text(json.dumps(rows, indent=1), encoding="utf-8")
    broken = [result.name for result in results if not result.holds]
    print(f"{len(results) - len(broken)} of {len(results)} scenarios hold, {len(skipped)} skipped"
          + (": BROKEN " + ", ".join(broken) if broken else ""))
    return 1 if broken else packages.SKIPPED if not results else 0


if __name__ == "__main__":
    sys.exit(main())
