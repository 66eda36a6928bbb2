#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

# Compares the benchmarks of two commits:
#   tests/bench/compare.sh REV_A REV_B [FILTER]
# builds both in build/compare/ and runs the benchmarks whose names match the regular expression FILTER (default:
# whole Basic Steps and growth). The two commits alternate, so that both meet the same load. Prints relative
# differences of processor time, negative where B is faster. Needs `./run.sh test` before, and Debian's
# libbenchmark-tools.
set -euo pipefail
[ $# -ge 2 ] || { sed -n '5,10s/^# \{0,1\}//p' "$0" >&2; exit 2; }
cd "$(git -C "$(dirname "$0")" rev-parse --show-toplevel)"
compare=/usr/share/benchmark/compare.py
python="$PWD/build/venv/bin/python"  # compare.py needs its scipy
[ -e "$compare" ] || { echo "$compare is missing: install libbenchmark-tools." >&2; exit 1; }
[ -x "$python" ] || { echo "$python is missing: ./run.sh test makes it." >&2; exit 1; }
filter="${3:-^(basic_step|growth)}"
turns="${TURNS:-5}"
folder="$PWD/build/compare"
mkdir -p "$folder"

# built REV: builds the benchmarks of a commit in a separate work tree; prints the path of the program.
built() {
    local commit tree
    commit="$(git rev-parse --verify --quiet "$1^{commit}")" || { echo "There is no commit $1." >&2; exit 1; }
    tree="$folder/$commit"
    [ -d "$tree" ] || git worktree add --quiet --detach "$tree" "$commit" >&2
    cmake -S "$tree" -B "$tree/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DNEURALMESH_PLUGINS=OFF > "$folder/log" 2>&1 &&
        cmake --build "$tree/build" --target bench_learning >> "$folder/log" 2>&1 ||
        { tail -n 20 "$folder/log" >&2; exit 1; }
    echo "$tree/build/tests/bench_learning"
}

# joined FILE...: one benchmark file from several; compare.py takes repeated names for repetitions.
joined() {
    "$python" - "$@" <<'END'
import json, sys
runs = [json.load(open(name)) for name in sys.argv[1:]]
runs[0]["benchmarks"] = [b for run in runs for b in run["benchmarks"]]
json.dump(runs[0], sys.stdout)
END
}

a="$(built "$1")"
b="$(built "$2")"
for turn in $(seq "$turns"); do
    for side in a b; do
        "${!side}" --benchmark_filter="$filter" --benchmark_format=json > "$folder/$side.$turn.json" 2> /dev/null
    done
done
for side in a b; do joined $(seq -f "$folder/$side.%g.json" "$turns") > "$folder/$side.json"; done
"$python" "$compare" --no-utest benchmarks "$folder/a.json" "$folder/b.json"
git worktree prune
