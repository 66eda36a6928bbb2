#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Runs the fuzz targets of build/fuzz in turn, starting from the kept corpus, and reports the findings.

    cmake --preset fuzz && cmake --build --preset fuzz --target fuzz_cloud fuzz_mesh
    tests/fuzz/fuzz.py --minutes 60

Inputs that reach new code are kept in build/fuzz/inputs/TARGET for the next run, inputs that break a promise in
build/fuzz/findings. Added to corpus/TARGET.txt as a line (--hex FILE prints it), such an input becomes a test.
"""

import argparse
import hashlib
import re
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
BUILD = HERE.parents[1] / "build" / "fuzz"
TARGETS = ("cloud", "mesh")
LONGEST = {"cloud": 1600, "mesh": 400}


def unpack(target):
    """Writes the kept inputs as files for libFuzzer; returns their folder."""
    folder = BUILD / "inputs" / target
    folder.mkdir(parents=True, exist_ok=True)
    for line in (HERE / "corpus" / f"{target}.txt").read_text().splitlines():
        if not line.startswith("#"):
            data = bytes.fromhex(line)
            (folder / hashlib.sha1(data).hexdigest()).write_bytes(data)
    return folder


def fuzz(target, minutes):
    """Whether a promise was broken."""
    findings = BUILD / "findings"
    findings.mkdir(exist_ok=True)
    done = subprocess.run(
        [BUILD / "tests" / f"fuzz_{target}", f"-max_total_time={round(60 * minutes)}", f"-max_len={LONGEST[target]}",
         "-len_control=0", "-timeout=600", "-rss_limit_mb=3000", f"-artifact_prefix={findings}/{target}-",
         "-print_final_stats=1", unpack(target)],
        stderr=subprocess.PIPE, text=True, errors="replace", check=False)
    executions = re.findall(r"number_of_executed_units: (\d+)", done.stderr)
    if done.returncode != 0:
        print("\n".join(line for line in done.stderr.splitlines() if not line.startswith("#"))[-6000:])
    print(f"{target}: {executions[-1] if executions else 0} executions{', A FINDING' if done.returncode != 0 else ''}", flush=True)
    return done.returncode != 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--minutes", type=float, default=60, help="for all targets together")
    parser.add_argument("--targets", nargs="+", choices=TARGETS, default=TARGETS)
    parser.add_argument("--hex", metavar="FILE", type=Path, help="print an input as a line of the corpus, and end")
    options = parser.parse_args()
    if options.hex:
        print(options.hex.read_bytes().hex())
        return 0
    return int(any([fuzz(target, options.minutes / len(options.targets)) for target in options.targets]))


if __name__ == "__main__":
    sys.exit(main())
