#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

# Lines of vcg_core/ that the unit tests and the kept fuzz inputs run, per file with those that they do not; ends
# with 1 below 90 %. Needs Debian's gcovr.
#   tests/coverage.sh [GTEST_FILTER]
# Left out unless a filter is given: tests that repeat whole runs with other seeds, places and bad settings. What they
# run, others run, but for a few lines; they look at what comes of it. Three minutes of processor time without them.
set -euo pipefail
cd "$(dirname "$0")/.."
command -v gcovr > /dev/null || { echo "gcovr is missing: install it." >&2; exit 2; }
build=build/coverage
repeated="RandomSettings.*:BatchLimit.ManySignals*:Determinism.*:Reconstruct.Hostile*:Reconstruct.CanBeCancelled*"
repeated+=":Reconstruct.GivesTheExact*"
cmake --preset coverage > /dev/null
cmake --build --preset coverage --target unit_tests fuzz_network fuzz_settings fuzz_cloud -- --quiet
find "$build" -name '*.gcda' -delete
"$build/tests/unit_tests" --gtest_brief=1 --gtest_filter="${1:--$repeated}"
for target in network settings cloud; do
    "$build/tests/fuzz_$target" "tests/fuzz/corpus/$target.txt" > /dev/null
done
# Branches that only an exception takes, and asserts, are no lines of their own.
gcovr --root . --filter vcg_core/ --object-directory "$build" --exclude-unreachable-branches --fail-under-line 90 "$build"
