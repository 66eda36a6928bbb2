#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""How far each part of a whole run is from what the machine allows: its instructions at four in a cycle, and the bytes
that miss the second-level cache at the bandwidth of a copy. The larger of the two is the limit.

    limits.py build/tests/bench_run_parts --vertices 1000,10000

Seconds are medians of --runs runs on one thread; instructions and misses are counted by callgrind, which takes 60 to
100 times as long: 7 minutes for 10,000 vertices. It simulates caches of 32 and 48 KiB and 2 MiB.
"""

import argparse
import json
import re
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np

CACHES = ["--cache-sim=yes", "--I1=32768,8,64", "--D1=49152,12,64", "--LL=2097152,16,64"]
LINE = 64
PER_CYCLE = 4
# Each part: the counters of run_parts, and the function that does its work, by how its signature begins.
PARTS = {
    "start mesh": (["start_mesh"], "prepare("),
    "landing, settling": (["landing", "settling"], "Learner::settle("),
    "growth": (["growth"], "PaperLearner::grow("),
    "reduction": (["reduction"], "Fitter::reduce_to("),
    "rounds of the fit": (["rounds"], "(anonymous namespace)::FitRounds::run("),
}


def arguments(vertices):
    points = max(100000, 10 * vertices)
    return [f"--benchmark_filter=run_parts/{vertices}/{points}/1/", "--benchmark_min_time=0.001"]


def seconds(program, vertices, runs):
    times = []
    for _ in range(runs):
        done = subprocess.run([program, *arguments(vertices), "--benchmark_format=json"], stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL, check=True)
        row = json.loads(done.stdout)["benchmarks"][0]
        times.append({part: sum(row[name] for name in names) for part, (names, _) in PARTS.items()})
    return {part: statistics.median(t[part] for t in times) for part in PARTS}


def counts(program, vertices):
    """(instructions, misses of the second-level cache) of each part, with all that its functions call."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "counts"
        subprocess.run(["valgrind", "--tool=callgrind", *CACHES, f"--callgrind-out-file={file}", program,
                        *arguments(vertices)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True)
        text = subprocess.run(["callgrind_annotate", "--inclusive=yes", "--threshold=100", "--show=Ir,ILmr,DLmr,DLmw",
                               file], stdout=subprocess.PIPE, text=True, check=True).stdout
    result = {}
    for part, (_, begin) in PARTS.items():
        lines = [line for line in text.splitlines() if ":neuralmesh::" + begin in line]
        if not lines:
            raise SystemExit(f"callgrind has not found {begin}: is it inlined?")
        instructions, *misses = (int(n.replace(",", "")) for n in re.findall(r"([\d,]+) \([ \d.]+%\)", lines[0]))
        result[part] = instructions, sum(misses)
    return result


def bandwidth():
    """Bytes a second, read and written, of the fastest of ten copies of 256 MB."""
    source = np.ones(1 << 25)
    to = np.empty_like(source)
    best = float("inf")
    for _ in range(10):
        begin = time.perf_counter()
        np.copyto(to, source)
        best = min(best, time.perf_counter() - begin)
    return 2 * source.nbytes / best


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--vertices", default="1000,10000")
    parser.add_argument("--runs", type=int, default=3)
    options = parser.parse_args()
    clock = 1e6 * float(re.search(r"cpu MHz\s*: ([\d.]+)", Path("/proc/cpuinfo").read_text(encoding="utf-8")).group(1))
    bytes_per_second = bandwidth()
    print(f"{clock / 1e9:.1f} GHz, {bytes_per_second / 1e9:.1f} GB/s\n")
    print("| vertices | part | seconds | 10⁹ instructions | GB missed | limit: instructions | bytes | time over limit |")
    print("|---|---|---|---|---|---|---|---|")
    for vertices in map(int, options.vertices.split(",")):
        of_parts = counts(options.program, vertices)
        for part, taken in seconds(options.program, vertices, options.runs).items():
            instructions, misses = of_parts[part]
            limits = instructions / (PER_CYCLE * clock), misses * LINE / bytes_per_second
            print(f"| {vertices:,} | {part} | {taken:.2f} | {instructions / 1e9:.2f} | {misses * LINE / 1e9:.2f} "
                  f"| {limits[0]:.2f} | {limits[1]:.2f} | {taken / max(limits):.1f} |", flush=True)


if __name__ == "__main__":
    main()
