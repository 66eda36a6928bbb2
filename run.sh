#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

# Everything from a bare Debian 12 in one command:
#   ./run.sh build                         the plugins for all MeshLabs, in build/plugins/
#   ./run.sh demo [CLOUD [VERTICES [OUT]]] a neural mesh of a point cloud, with a picture; default: the Stanford bunny
#   ./run.sh package                       the packages for others, in dist/
#   ./run.sh test [full]                   the tests for daily work; `full`: all, before a piece of work is finished
#   ./run.sh release                       installs each package in a bare Debian and uses it; needs root
#   ./run.sh platform NAME                 the unit tests on arm64, windows, libcxx (clang's) or portable (plain C++)
#   ./run.sh bench                         the performance tables
#   ./run.sh figures                       the tables and pictures of the documentation
# Missing packages are installed with apt, through sudo unless run by root. Installed packages are not changed.
set -euo pipefail
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
called_from="$PWD"
cd "$here"

build=build
sanitizers=address  # of the second core, see vcg_core/CMakeLists.txt
venv="$build/venv"
compile_packages="ca-certificates cmake g++ libeigen3-dev libglew-dev libqt5opengl5-dev meshlab ninja-build python3
    qtbase5-dev xz-utils"
venv_packages="python3-venv"
demo_packages="glmark2-data libgl1-mesa-dri python3-numpy python3-pil xauth xvfb"
figures_packages="xdotool"
bench_packages="libcgal-dev"  # CGAL's surface reconstruction is timed beside ours
test_packages="binutils libbenchmark-dev libgtest-dev valgrind"
release_packages="debootstrap lintian qemu-user wine64"
declare -A platform_packages=([arm64]="g++-aarch64-linux-gnu googletest qemu-user" [portable]="libgtest-dev"
    [windows]="g++-mingw-w64-x86-64-posix googletest wine64" [libcxx]="clang googletest libc++-dev libc++abi-dev")
python=/usr/bin/python3

say() { printf '== %s\n' "$*"; }

fail() {
    printf '%s\n' "$*" >&2
    exit 1
}

as_root() {
    if [ "$(id -u)" = 0 ]; then "$@"; else sudo "$@"; fi
}

# must_be_debian_12: ends with an error on other systems, whose packages and MeshLab differ.
must_be_debian_12() {
    local system="an unknown system"
    [ ! -r /etc/os-release ] || system="$(. /etc/os-release && echo "${ID:-linux} ${VERSION_ID:-}")"
    [ "$system" = "debian 12" ] && command -v dpkg-query > /dev/null || fail "This script is for Debian 12, and this is" \
        "$system. Build with 'cmake -S . -B build/own -DMESHLAB_SOURCE_DIR=DIR && cmake --build build/own', where DIR" \
        "contains the sources of your MeshLab."
}

# must_be_root REASON COMMAND: ends with an error that names COMMAND if neither root rights nor sudo are available.
must_be_root() {
    [ "$(id -u)" = 0 ] || command -v sudo > /dev/null ||
        fail "$1, and sudo is not installed. Run this command as root, then start again:"$'\n'"  $2"
}

# missing_of PACKAGE...: prints the packages that are not installed.
missing_of() {
    local package
    # dpkg-query prints one line for each architecture of the package.
    for package in "$@"; do
        dpkg-query --show --showformat='${db:Status-Status}\n' "$package" 2> /dev/null | grep -q '^installed$' ||
            echo "$package"
    done
}

# need PACKAGE...: installs the missing packages.
need() {
    must_be_debian_12
    local missing
    mapfile -t missing < <(missing_of "$@")
    [ "${#missing[@]}" -gt 0 ] || return 0
    must_be_root "Packages are missing" \
        "apt-get update && apt-get install --no-install-recommends ${missing[*]}"
    say "Installing ${missing[*]}"
    install_packages "${missing[@]}" > "$build/install.log" 2>&1 ||
        { tail -n 20 "$build/install.log" >&2; fail "The packages could not be installed; see $build/install.log."; }
}

# Waits while another apt is running, and first completes an interrupted installation.
install_packages() {
    local apt="env DEBIAN_FRONTEND=noninteractive apt-get -q -q -o DPkg::Lock::Timeout=300 -o Dpkg::Use-Pty=0"
    as_root dpkg --configure -a || true  # missing dependencies are installed by apt-get below
    as_root $apt update && as_root $apt install --fix-broken --yes --no-install-recommends "$@"
}

need_sources() {
    if [ -z "$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Origin: Debian')" ] &&
        ! [ -e "${XDG_CACHE_HOME:-$HOME/.cache}/neural-mesh/meshlab-2025.07/ML_VERSION" ]; then
        must_be_root "apt has no package lists" "apt-get update"
        as_root apt-get -q -q update
    fi
    filter_neuralmesh/sources/fetch_meshlab.sh
}

# environment FOLDER REQUIREMENTS WHAT: makes a virtual environment of Python anew unless it is what REQUIREMENTS say.
environment() {
    local folder="$1" requirements="$2" what="$3" wanted
    wanted="$(sha256sum < "$requirements")"
    [ "$(cat "$folder/complete" 2> /dev/null)" = "$wanted" ] && return 0
    say "Installing $what into $folder"
    rm -rf "$folder"
    "$python" -m venv "$folder"
    "$folder/bin/pip" install --quiet --disable-pip-version-check --only-binary :all: \
        --no-compile --require-hashes --requirement "$requirements"
    echo "$wanted" > "$folder/complete"
}

need_venv() { environment "$venv" tests/requirements.txt "pymeshlab and the tools of the tests"; }

need_checks() { environment "$build/checks" packaging/checks.txt "what checks wheels"; }

need_zig() { environment "$build/zig" packaging/requirements.txt "zig, which compiles for other systems,"; }

# cached NAME: the value of NAME in the CMake cache of the build folder.
cached() { sed -n "s/^$1:[A-Z]*=//p" "$build/CMakeCache.txt"; }

# compile TARGET...: configures and builds. A cache made with another generator, in another place or for a MeshLab in
# MESHLAB_SOURCE_DIR is discarded.
compile() {
    need_sources
    say "Compiling"
    local fresh=()
    if [ -e "$build/CMakeCache.txt" ] && ! { [ "$(cached CMAKE_GENERATOR)" = Ninja ] &&
        [ "$(cached CMAKE_HOME_DIRECTORY)" = "$here" ] && [ -z "$(cached MESHLAB_SOURCE_DIR)" ]; }; then
        fresh=(--fresh)
    fi
    cmake "${fresh[@]}" -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DNEURALMESH_SANITIZERS="$sanitizers" \
        > "$build/configure.log" 2>&1 ||
        { cat "$build/configure.log" >&2; fail "The configuration failed."; }
    cmake --build "$build" --target "$@" -- --quiet
}

# path_of PATH: PATH seen from the folder in which this script was called.
path_of() { case "$1" in /*) echo "$1" ;; *) echo "$called_from/$1" ;; esac; }

build() {
    need $compile_packages $venv_packages
    need_venv
    compile plugins neuralmesh_c_api
    say "Built:"
    ls -1 "$build"/plugins/*/libfilter_neuralmesh.so "$build"/c_api/libneural_mesh.so
}

package() {
    need $compile_packages $venv_packages
    need_venv
    need_zig
    compile plugins neuralmesh_c_api
    say "Compiling the library for other systems"
    "$python" packaging/libraries.py --zig "$build/zig" --build "$build/cross" --out "$build/libraries"
    say "Packages:"
    "$python" packaging/package.py --plugins "$build/plugins" --libraries "$build/libraries" --out dist
}

# What a release must pass besides the tests. Not part of them: it takes half an hour.
release() {
    need $compile_packages $demo_packages $test_packages $release_packages $venv_packages
    need_venv
    compile all second_tier
    export NEURALMESH_BUILD="$here/$build"
    package
    need_checks
    as_root env NEURALMESH_BUILD="$NEURALMESH_BUILD" "$build/checks/bin/python" -m pytest -v -rs --noconftest \
        tests/hosts/wheels.py
    "$venv/bin/python" -m pytest -v -rs tests/hosts/upstream.py
    as_root env NEURALMESH_BUILD="$NEURALMESH_BUILD" "$venv/bin/python" -m pytest -v -rs tests/hosts/installs.py
}

platform() {
    local name="${1:-}"
    [ -n "$name" ] && [ -n "${platform_packages[$name]:-}" ] || fail "The platforms are ${!platform_packages[*]}."
    need $compile_packages ${platform_packages[$name]}
    need_sources
    tests_of_preset "$name"
}

demo() {
    need $compile_packages $demo_packages
    compile filter_neuralmesh_meshlab-2020.09 parameter_table
    local arguments=()
    [ $# -ge 1 ] && arguments+=(--cloud "$(path_of "$1")")
    [ $# -ge 2 ] && arguments+=(--vertices "$2")
    [ $# -ge 3 ] && arguments+=(--out "$(path_of "$3")")
    "$python" tests/hosts/demo.py --build "$build" "${arguments[@]}"
}

# tests_of_preset NAME [OPTION...]: builds a preset of CMakePresets.json, with options for the build, and runs its tests.
tests_of_preset() {
    local name="$1"
    shift
    cmake --preset "$name" > "$build/configure_$name.log" 2>&1 ||
        { cat "$build/configure_$name.log" >&2; fail "The configuration of $name failed."; }
    cmake --build --preset "$name" "$@" -- --quiet
    ctest --preset "$name" --parallel "$(nproc)" | without_passed
}

# Removes ctest's lines about tests that pass.
without_passed() { grep -v -e '^ *Start ' -e ' Passed '; }

# tests_of [OPTION...]: the tests of ctest that the options select.
tests_of() {
    ctest --test-dir "$build" --output-on-failure --no-tests=error --parallel "$(nproc)" --output-junit tests.xml "$@" |
        without_passed || fail "Tests have failed; their output is above."
}

# The two tiers are described in tests/README.md.
run_tests() {
    [ $# = 0 ] || [ "$*" = full ] || fail "'./run.sh test' takes no word but 'full'."
    need $compile_packages $demo_packages $test_packages $venv_packages
    if [ ! -e "$venv/complete" ]; then
        need_venv &
        compile neuralmesh_core  # what needs nothing of it, meanwhile
        wait "$!"
    fi
    need_venv  # before the configuration, which looks for pymeshlab there
    if [ $# = 0 ]; then
        compile all
        tests_of --label-exclude '^full$'
    else
        export NEURALMESH_FULL=1
        sanitizers=address,undefined,float-cast-overflow
        compile all second_tier
        tests_of
        say "With the thread sanitizer"
        tests_of_preset threads --target thread_tests
    fi
    say "All tests have passed"
}

bench() {
    need $compile_packages $demo_packages $test_packages $bench_packages $venv_packages
    need_venv
    compile all benches cgal_peers
    say "Commit $(git rev-parse --short HEAD 2> /dev/null || echo unknown)$(git diff --quiet HEAD 2> /dev/null || echo ', changed')"
    local program
    for program in "$build"/tests/bench_*; do
        [ -x "$program" ] && [ -f "$program" ] || continue
        say "${program##*/}"
        "$program" --benchmark_out="$build/${program##*/}.json" --benchmark_out_format=json
    done
    say "Error over time, compared with common methods on one thread"
    "$venv/bin/python" tests/bench/error_over_time.py --out "$build/error_over_time.json" --repeats 1 \
        --plot "$build/error_over_time.png" --cgal "$build/tests/cgal_peers" \
        --plugin "$build/plugins/pymeshlab-2025.7/libfilter_neuralmesh.so"
    say "A cloud larger than memory"
    "$venv/bin/python" tests/bench/stream.py --out "$build/stream.json" --points 20 --memory 500MB --all 10 \
        --plugin "$build/plugins/pymeshlab-2025.7/libfilter_neuralmesh.so"
}

figures() {
    need $compile_packages $demo_packages $figures_packages $test_packages $venv_packages
    need_venv
    compile plugins
    local plugin="$build/plugins/pymeshlab-2025.7/libfilter_neuralmesh.so"
    say "Accuracy against Poisson and quadric collapse"
    "$venv/bin/python" tests/experiments/accuracy/accuracy_table.py --plugin "$plugin" --out out/figures
    say "Pictures"
    "$venv/bin/python" tests/experiments/pictures/pictures.py --plugin "$plugin"
    local table
    for table in features crease_table; do
        "$venv/bin/python" "tests/experiments/paper/$table.py" --plugin "$plugin" --out out/figures
    done
    say "Pictures of MeshLab"
    "$venv/bin/python" tests/experiments/pictures/host_pictures.py --build "$build"
}

mkdir -p "$build"
word="${1:-}"
[ $# -gt 0 ] && shift
case "$word" in
    build) build ;;
    demo) demo "$@" ;;
    package) package ;;
    release) release ;;
    platform) platform "$@" ;;
    test) run_tests "$@" ;;
    bench) bench ;;
    figures) figures ;;
    *)
        sed -n '5,14s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"
        exit 2
        ;;
esac
