#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Processor time of each test.

    times.py --of NAME COMMAND...    runs the command and notes its processor time
    times.py --report FILE           prints the slowest tests in FILE, and those without a reason in slow_tests.txt

Every program of tests adds lines to the file that the environment variable NEURALMESH_TIMES names: seconds of processor
time, those of processes it has started included, and the name of a test."""

import argparse
import os
import resource
import subprocess
import sys
from pathlib import Path

REASONS = Path(__file__).with_name("slow_tests.txt")
LIMIT = 5  # seconds that a test of the first tier may take without a reason
SHOWN = 10


def processor_time():
    """The seconds of this process and of those it has waited for."""
    usages = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(usage.ru_utime + usage.ru_stime for usage in usages)


def note(name, seconds):
    """Adds a line, in one call, because other programs write to the file at the same time."""
    path = os.environ.get("NEURALMESH_TIMES")
    if path:
        with open(path, "a", encoding="utf-8") as file:
            file.write(f"{seconds:.3f} {name}\n")


def read(path):
    """{name: seconds}"""
    lines = Path(path).read_text(encoding="utf-8").splitlines()
    return {name: float(seconds) for seconds, name in (line.split(" ", 1) for line in lines)}


def reasons(path=REASONS):
    """{name: why the test may take longer}. A name that ends with * stands for all that begin so."""
    lines = (line.strip() for line in path.read_text(encoding="utf-8").splitlines())
    return dict(map(str.strip, line.split(":: ", 1)) for line in lines if line and not line.startswith("#"))


def has_reason(name, known):
    return any(name == one or (one.endswith("*") and name.startswith(one[:-1])) for one in known)


def report(times, known):
    """The lines to print."""
    slowest = sorted(times.items(), key=lambda item: -item[1])
    lines = [f"{len(times)} tests took {sum(times.values()):.0f} s of processor time. The slowest:"]
    lines += [f"{seconds:8.1f} s  {name}" for name, seconds in slowest[:SHOWN]]
    unexplained = [name for name, seconds in slowest if seconds > LIMIT and not has_reason(name, known)]
    if unexplained:
        lines += [f"Above {LIMIT} s and without a reason in tests/{REASONS.name}:", *(f"    {name}" for name in unexplained)]
    return lines


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--report", metavar="FILE")
    parser.add_argument("--of", metavar="NAME")
    parser.add_argument("command", nargs=argparse.REMAINDER)
    options = parser.parse_args()
    if options.report:
        print("\n".join(report(read(options.report), reasons())))
        return 0
    done = subprocess.run(options.command, check=False)
    note(options.of, processor_time())
    return done.returncode if done.returncode >= 0 else 128 - done.returncode


if __name__ == "__main__":
    sys.exit(main())
