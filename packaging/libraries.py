#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Compiles the library for other systems: `./run.sh package` calls it, and package.py makes a wheel of each.

    libraries.py --zig build/zig --build build/cross --out build/libraries [TAG...]

--zig: an environment of Python with PyPI's `ziglang`, which has compilers, C++ library and system headers for all of them.
--out gets a folder for each TAG, default: all, with the library in it. Needs cmake, ninja, Eigen and MeshLab's sources."""

import argparse
import os
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


@dataclass
class Target:
    """A system, as zig names it, and the name of its library. The oldest release that it runs on is part of both names:
    the glibc of manylinux2014, and the first macOS for arm64."""

    zig: str
    file: str


TARGETS = {  # by the tag of the wheel, several joined by dots
    "manylinux_2_17_aarch64.manylinux2014_aarch64": Target("aarch64-linux-gnu.2.17", "libneural_mesh.so"),
    "win_amd64": Target("x86_64-windows-gnu", "neural_mesh.dll"),
    "macosx_11_0_arm64": Target("aarch64-macos.11.0", "libneural_mesh.dylib"),
    "macosx_11_0_x86_64": Target("x86_64-macos.11.0", "libneural_mesh.dylib"),
}


def program_of(zig):
    """zig's program in an environment of Python."""
    return next(zig.glob("lib/python3*/site-packages/ziglang/zig")).absolute()


def make_library(tag, zig, build, out):
    target, folder = TARGETS[tag], build / tag
    # Its caches stay with it, which is removed and made anew for another release.
    environment = dict(os.environ, ZIG_GLOBAL_CACHE_DIR=str(zig.absolute() / "cache"),
                       ZIG_LOCAL_CACHE_DIR=str(zig.absolute() / "cache"))
    # The compiler's arguments are not those of another compiler that a script may have set.
    options = {"CMAKE_BUILD_TYPE": "Release", "CMAKE_TOOLCHAIN_FILE": ROOT / "packaging/zig.cmake",
               "NEURALMESH_ZIG": program_of(zig), "NEURALMESH_ZIG_TARGET": target.zig, "NEURALMESH_PLUGINS": "OFF",
               "NEURALMESH_TESTS": "OFF", "Eigen3_DIR": "/usr/share/eigen3/cmake"}
    run(environment, "cmake", "-S", ROOT, "-B", folder, "-G", "Ninja",
        *(f"-D{name}={value}" for name, value in options.items()))
    run(environment, "cmake", "--build", folder, "--target", "neuralmesh_c_api", "--", "--quiet")
    shutil.rmtree(out / tag, ignore_errors=True)
    (out / tag).mkdir(parents=True)
    shutil.copy(folder / "c_api" / target.file, out / tag)


def run(environment, *command):
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          check=False, env=environment)
    if done.returncode:
        sys.exit(f"{done.stdout[-4000:]}\n'{' '.join(map(str, command))}' failed; its output is above.")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("tags", nargs="*", metavar="TAG", default=list(TARGETS), help=f"of: {', '.join(TARGETS)}")
    parser.add_argument("--zig", type=Path, default=ROOT / "build/zig")
    parser.add_argument("--build", type=Path, default=ROOT / "build/cross")
    parser.add_argument("--out", type=Path, default=ROOT / "build/libraries")
    given = parser.parse_args()
    for tag in given.tags:
        print(f"{tag}: compiling", flush=True)
        make_library(tag, given.zig, given.build, given.out)


if __name__ == "__main__":
    main()
