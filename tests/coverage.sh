#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

# The lines of vcg_core/ that the unit tests and the kept fuzz inputs run, and for each file those that they do not;
# ends with 1 below 90 %. Needs Debian's gcovr and, without the tests labelled repeated_runs, which run few lines more,
# three minutes of processor time.
#   tests/coverage.sh [REGEX]    only tests whose names match REGEX
set -euo pipefail
cd "$(dirname "$0")/.."
command -v gcovr > /dev/null || { echo "gcovr is missing: install it." >&2; exit 2; }
build=build/coverage
cmake --preset coverage > /dev/null
cmake --build --preset coverage --target unit_tests fuzz_cloud -- --quiet
find "$build" -name '*.gcda' -delete
ctest --preset coverage --label-regex 'unit|whole_run|fuzz' --tests-regex "${1:-.}" --parallel "$(nproc)"
# Branches that only exceptions take are not counted.
gcovr --root . --filter vcg_core/ --object-directory "$build" --exclude-unreachable-branches --fail-under-line 90 "$build"
