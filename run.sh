#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

# Everything from a bare Debian 12 in one command:
#   ./run.sh build                         the plugins for all MeshLabs, in build/plugins/
#   ./run.sh demo [CLOUD [VERTICES [OUT]]] a neural mesh of a cloud, with a picture; default: the Stanford bunny
#   ./run.sh test                          all tests
#   ./run.sh bench                         the performance tables
#   ./run.sh figures                       the tables, figures and screenshots of the documentation
# Missing packages are installed with apt (asking sudo when not root); what is there is left alone.
set -euo pipefail
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
called_from="$PWD"
cd "$here"

build=build
venv="$build/venv"
compile_packages="ca-certificates cmake g++ libeigen3-dev libglew-dev libqt5opengl5-dev meshlab ninja-build python3
    qtbase5-dev xz-utils"
venv_packages="python3-venv"
demo_packages="glmark2-data libgl1-mesa-dri python3-numpy python3-pil xauth xdotool xvfb"
bench_packages="libcgal-dev"  # CGAL, to time it beside ours
test_packages="binutils libbenchmark-dev libgtest-dev parallel valgrind"
python=/usr/bin/python3

say() { printf '== %s\n' "$*"; }

fail() {
    printf '%s\n' "$*" >&2
    exit 1
}

as_root() {
    if [ "$(id -u)" = 0 ]; then "$@"; else sudo "$@"; fi
}

# must_be_debian_12: ends with a sentence elsewhere, where packages have other names and MeshLab is another.
must_be_debian_12() {
    local system="an unknown system"
    [ ! -r /etc/os-release ] || system="$(. /etc/os-release && echo "${ID:-linux} ${VERSION_ID:-}")"
    [ "$system" = "debian 12" ] && command -v dpkg-query > /dev/null || fail "This script is for Debian 12, and this is" \
        "$system. Build with 'cmake -S . -B build/own -DMESHLAB_SOURCE_DIR=DIR && cmake --build build/own', the sources" \
        "of your MeshLab being in DIR."
}

# must_be_root REASON COMMAND: ends with a sentence where nobody can be asked to run COMMAND as root.
must_be_root() {
    [ "$(id -u)" = 0 ] || command -v sudo > /dev/null ||
        fail "$1, and there is no sudo here. Run this as root, then start again:"$'\n'"  $2"
}

missing_of() {
    local package
    # One line for each architecture that the package is there for.
    for package in "$@"; do
        dpkg-query --show --showformat='${db:Status-Status}\n' "$package" 2> /dev/null | grep -q '^installed$' ||
            echo "$package"
    done
}

need() {
    must_be_debian_12
    local missing
    mapfile -t missing < <(missing_of "$@")
    [ "${#missing[@]}" -gt 0 ] || return 0
    must_be_root "Packages are missing" \
        "apt-get update && apt-get install --no-install-recommends ${missing[*]}"
    say "Installing ${missing[*]}"
    install_packages "${missing[@]}" > "$build/install.log" 2>&1 ||
        { tail -n 20 "$build/install.log" >&2; fail "The packages could not be installed; $build/install.log has it all."; }
}

# Waits for another apt to finish, and takes up what an interrupted one has left half installed.
install_packages() {
    local apt="env DEBIAN_FRONTEND=noninteractive apt-get -q -q -o DPkg::Lock::Timeout=300 -o Dpkg::Use-Pty=0"
    as_root dpkg --configure -a || true  # what lacks its dependencies yet is mended by apt-get below
    as_root $apt update && as_root $apt install --fix-broken --yes --no-install-recommends "$@"
}

need_sources() {
    if [ -z "$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Origin: Debian')" ] &&
        ! [ -e "${XDG_CACHE_HOME:-$HOME/.cache}/neural-mesh/meshlab-2025.07/ML_VERSION" ]; then
        must_be_root "apt does not know its mirrors' packages" "apt-get update"
        as_root apt-get -q -q update
    fi
    filter_neuralmesh/sources/fetch_meshlab.sh
}

need_venv() {
    local wanted
    wanted="$(sha256sum < tests/requirements.txt)"
    [ "$(cat "$venv/complete" 2> /dev/null)" = "$wanted" ] && return 0
    say "Installing pymeshlab and the tools of the tests into $venv"
    rm -rf "$venv"
    "$python" -m venv "$venv"
    "$venv/bin/pip" install --quiet --disable-pip-version-check --only-binary :all: \
        --require-hashes --requirement tests/requirements.txt
    echo "$wanted" > "$venv/complete"
}

# kept NAME: what cmake has kept as NAME in the build folder.
kept() { sed -n "s/^$1:[A-Z]*=//p" "$build/CMakeCache.txt"; }

# compile TARGET...: configures where needed, and compiles. What another configuration has left in the build folder,
# by another generator, of another place or for a MeshLab of one's own, is configured anew.
compile() {
    need_sources
    say "Compiling"
    local fresh=()
    if [ -e "$build/CMakeCache.txt" ] && ! { [ "$(kept CMAKE_GENERATOR)" = Ninja ] &&
        [ "$(kept CMAKE_HOME_DIRECTORY)" = "$here" ] && [ -z "$(kept MESHLAB_SOURCE_DIR)" ]; }; then
        fresh=(--fresh)
    fi
    cmake "${fresh[@]}" -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release > "$build/configure.log" 2>&1 ||
        { cat "$build/configure.log" >&2; fail "The configuration failed."; }
    cmake --build "$build" --target "$@" -- --quiet
}

# A path as the caller meant it, whatever folder this script works in.
path_of() { case "$1" in /*) echo "$1" ;; *) echo "$called_from/$1" ;; esac; }

build() {
    need $compile_packages $venv_packages
    need_venv
    compile plugins
    say "Built:"
    ls -1 "$build"/plugins/*/libfilter_neuralmesh.so
}

demo() {
    need $compile_packages $demo_packages
    compile filter_neuralmesh_meshlab-2020.09 write_mlx check_mesh
    local arguments=()
    [ $# -ge 1 ] && arguments+=(--cloud "$(path_of "$1")")
    [ $# -ge 2 ] && arguments+=(--vertices "$2")
    [ $# -ge 3 ] && arguments+=(--out "$(path_of "$3")")
    "$python" tests/hosts/demo.py --build "$build" "${arguments[@]}"
}

# sanitized PRESET TARGET...: the targets as CMakePresets.json's PRESET instruments them, in build/PRESET.
sanitized() {
    local preset="$1"
    shift
    cmake --preset "$preset" > "$build/configure.log" 2>&1 ||
        { cat "$build/configure.log" >&2; fail "The configuration of $preset failed."; }
    cmake --build --preset "$preset" --target "$@" -- --quiet
}

# matching PROGRAM PATTERN...: runs the tests of PROGRAM that each pattern names; one that names none is an error, which
# GoogleTest would pass over.
matching() {
    local program="$1" pattern
    shift
    for pattern in "$@"; do
        "$program" --gtest_list_tests --gtest_filter="$pattern" | grep -q '^  ' ||
            { echo "$program has no test $pattern: its name in run.sh is out of date." >&2; return 1; }
        "$program" --gtest_brief=1 --gtest_filter="$pattern" || return 1
    done
}

# Where a wrong access, undefined behaviour or a race ends the program. CMakePresets.json and the names below say
# what runs; tests/README.md says what does not, and why.
sanitizer_tests() {
    say "Unit tests with the address and undefined-behaviour sanitizers"
    sanitized sanitize unit_tests fuzz_network fuzz_settings || return 1
    ctest --preset sanitize --parallel "$(nproc)" || return 1
    say "Whole runs with the address sanitizer and lighter checks"
    sanitized sanitize-light fuzz_cloud || return 1
    "$build/sanitize-light/tests/fuzz_cloud" tests/fuzz/corpus/cloud.txt || return 1
    say "Tests of threads with the thread sanitizer"
    sanitized threads thread_tests || return 1
    matching "$build/threads/tests/thread_tests" 'ThreadTeam.*' 'BasicStepBatch.*' Learner.IsTheReferenceInBatches \
        'Learner.SettlesAlike*' Fit.GivesTheSameBytesForAnyNumberOfThreads Shell.PiecesOfASparseCloudAreNoComponents
}

run_tests() {
    need $compile_packages $demo_packages $test_packages $venv_packages
    need_venv
    compile all
    say "Unit tests"
    ctest --test-dir "$build" --output-on-failure --no-tests=error --parallel "$(nproc)"
    local file failed=0
    sanitizer_tests || failed=1
    say "Tests in the hosts"
    # A process for each file: a crash inside a host's libraries ends one file only, and says which.
    for file in tests/hosts/test_*.py; do
        NEURALMESH_BUILD="$here/$build" "$venv/bin/python" -m pytest "$file" -q || failed=1
    done
    say "Accuracy and topology, the small form"
    "$venv/bin/python" tests/experiments/accuracy/accuracy_table.py --small --out "$build/experiments" \
        --plugin "$build/plugins/pymeshlab-2025.7/libfilter_neuralmesh.so" || failed=1
    return "$failed"
}

bench() {
    need $compile_packages $demo_packages $test_packages $bench_packages $venv_packages
    need_venv
    compile all cgal_peers
    say "Commit $(git rev-parse --short HEAD 2> /dev/null || echo unknown)$(git diff --quiet HEAD 2> /dev/null || echo ', changed')"
    local program
    for program in "$build"/tests/bench_*; do
        [ -x "$program" ] && [ -f "$program" ] || continue
        say "${program##*/}"
        "$program" --benchmark_out="$build/${program##*/}.json" --benchmark_out_format=json
    done
    say "In a host, beside what people use today"
    "$venv/bin/python" tests/bench/in_host.py --out "$build/in_host.json" --cgal "$build/tests/cgal_peers" \
        --plugin "$build/plugins/pymeshlab-2025.7/libfilter_neuralmesh.so"
}

figures() {
    need $compile_packages $demo_packages $test_packages $venv_packages
    need_venv
    compile all
    local plugin="$build/plugins/pymeshlab-2025.7/libfilter_neuralmesh.so"
    say "Accuracy against Poisson and quadric collapse"
    "$venv/bin/python" tests/experiments/accuracy/accuracy_table.py --plugin "$plugin" --out out/figures
    say "Counters against curvature"
    "$venv/bin/python" tests/experiments/accuracy/compare_curvature.py --plugin "$plugin" --out out/figures
    demo
    tests/experiments/pictures/figures.sh "$build" screenshots out/figures
}

mkdir -p "$build"
word="${1:-}"
[ $# -gt 0 ] && shift
case "$word" in
    build) build ;;
    demo) demo "$@" ;;
    test) run_tests ;;
    bench) bench ;;
    figures) figures ;;
    *)
        sed -n '5,11s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"
        exit 2
        ;;
esac
