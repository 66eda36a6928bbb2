#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Counts the instructions per signal of the learning loop with callgrind and compares them with the recorded count.

    count.py build/tests/learning_loop            fails if they are over 5 % more than recorded
    count.py --record build/tests/learning_loop   records the present count

Instructions, unlike seconds, do not depend on the load of the machine, nor on its processor, because the program is
compiled for one instruction set. Only Learner::run() and its callees are counted. The recorded count is that of
Debian 12's compiler: record it again after a change of the compiler or an intended change of the work per signal.
"""

import argparse
import re
import subprocess
import sys
import tempfile
from pathlib import Path

RECORDED = Path(__file__).resolve().parent / "recorded.txt"
MOST_ABOVE = 0.05


def instructions_per_signal(program):
    with tempfile.TemporaryDirectory() as folder:
        counts = Path(folder) / "counts"
        done = subprocess.run(
            ["valgrind", "--tool=callgrind", "--toggle-collect=neuralmesh::Learner::run(*",
             f"--callgrind-out-file={counts}", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
            check=False)
        if done.returncode != 0:
            sys.exit(f"{program} under callgrind ended with {done.returncode}:\n{done.stderr}")
        total = int(re.search(r"^(?:totals|summary): (\d+)", counts.read_text(), re.MULTILINE).group(1))
    signals = int(done.stdout)
    # So few instructions mean that callgrind has not found the function.
    if total < 100 * signals:
        sys.exit(f"callgrind has counted only {total} instructions for {signals} signals: is Learner::run() inlined?")
    return total / signals


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--record", action="store_true", help="record the count instead of comparing it")
    parser.add_argument("program")
    options = parser.parse_args()
    now = instructions_per_signal(options.program)
    if options.record:
        RECORDED.write_text(f"{now:.0f}\n")
        print(f"Recorded: {now:.0f} instructions per signal")
        return 0
    recorded = float(RECORDED.read_text())
    print(f"{now:.0f} instructions per signal, recorded {recorded:.0f}: {100 * (now / recorded - 1):+.1f} %")
    if now > recorded * (1 + MOST_ABOVE):
        print("That is over 5 % more than recorded. If the increase is intended, record the new count:\n"
              f"  {Path(__file__).name} --record {options.program}")
        return 1
    if now < recorded * (1 - MOST_ABOVE):
        print("That is over 5 % less than recorded: record the new count, so that a later increase is noticed.")
    return 0


if __name__ == "__main__":
    sys.exit(main())
