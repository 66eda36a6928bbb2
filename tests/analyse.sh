#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

# Static analysis of our sources; ends with 1 where there is a finding:
#   tests/analyse.sh [FILE...]    files under vcg_core/, filter_neuralmesh/ and tests/; none: all of them
# clang-tidy by .clang-tidy, on what the preset "clang" compiles (no Qt, no MeshLab), then cppcheck on all.
# Needs Debian's clang, clang-tidy and cppcheck; about 10 minutes of processor time for everything.
set -euo pipefail
cd "$(dirname "$0")/.."
for tool in clang++ clang-tidy cppcheck; do
    command -v "$tool" > /dev/null || { echo "$tool is missing: install clang, clang-tidy, cppcheck." >&2; exit 2; }
done
files=("$@")
if [ $# = 0 ]; then
    mapfile -t files < <(ls vcg_core/*.cpp filter_neuralmesh/*.cpp tests/{unit,memory,fuzz,bench,hosts,experiments}/*.cpp)
fi

cmake --preset clang > /dev/null
failed=0
mapfile -t compiled < <(
    for file in "${files[@]}"; do grep -q "/$file\"" build/clang/compile_commands.json && echo "$file"; done)
if [ "${#compiled[@]}" -gt 0 ]; then
    printf '%s\0' "${compiled[@]}" | xargs -0 -n 1 -P "$(nproc)" clang-tidy --quiet -p build/clang || failed=1
fi

mkdir -p build/cppcheck
cppcheck --quiet --enable=warning,performance,portability --std=c++17 --language=c++ --error-exitcode=1 \
    --suppressions-list=tests/cppcheck_suppressions.txt --cppcheck-build-dir=build/cppcheck \
    --library=googletest --library=qt -I . -I vcg_core "${files[@]}" || failed=1
exit "$failed"
