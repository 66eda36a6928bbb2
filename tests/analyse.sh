#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

# Static analysis of our sources; ends with 1 if there is a finding:
#   tests/analyse.sh [FILE...]    files in vcg_core/, filter_neuralmesh/ and tests/; default: all
# Runs clang-tidy with the options of the preset "clang" (on a plugin's file once for each host), then cppcheck. Needs
# `./run.sh build` before, and Debian's clang, clang-tidy and cppcheck. Most files take 10 to 50 seconds of processor
# time, the adapters more.
set -euo pipefail
cd "$(dirname "$0")/.."
for tool in clang++ clang-tidy cppcheck; do
    command -v "$tool" > /dev/null || { echo "$tool is missing: install clang, clang-tidy, cppcheck." >&2; exit 2; }
done
files=("$@")
if [ $# = 0 ]; then
    # bench/cgal/ is left out: it is compiled only if CGAL is installed.
    mapfile -t files < <(
        find vcg_core filter_neuralmesh tests -name "*.cpp" -not -path "tests/bench/cgal/*" | sort)
fi

mkdir -p build
cmake --preset clang > build/configure.log 2>&1 ||
    { cat build/configure.log >&2; echo "The configuration of clang failed." >&2; exit 2; }
for file in "${files[@]}"; do
    grep -q "$PWD/$file\"" build/clang/compile_commands.json ||
        { echo "$file cannot be analysed: the preset clang does not compile it. Are GTest and benchmark there?" >&2; exit 2; }
done
failed=0
printf '%s\0' "${files[@]}" | xargs -0 -n 1 -P "$(nproc)" clang-tidy --quiet -p build/clang || failed=1

mkdir -p build/cppcheck
cppcheck --quiet --enable=warning,performance,portability --std=c++17 --language=c++ --error-exitcode=1 \
    --suppressions-list=tests/cppcheck_suppressions.txt --cppcheck-build-dir=build/cppcheck \
    --library=googletest --library=qt -I . "${files[@]}" || failed=1
exit "$failed"
