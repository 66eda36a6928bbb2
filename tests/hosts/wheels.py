# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The wheels for all systems: what their libraries need and export, their names and metadata, the recorded bytes on
arm64 by Debian's Python under qemu, and the mesh of the example in C on Windows under wine. Started by `./run.sh release`, after
`./run.sh package`; needs debootstrap, qemu-user and wine64. No Mac is at hand: of its wheels only the files are checked."""

import os
import re
import shutil
import sys
import zipfile
from pathlib import Path

import library_clouds
import lief
import programs
import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "packaging"))

import libraries  # noqa: E402

BUILD = Path(os.environ.get("NEURALMESH_BUILD") or ROOT / "build")
WHEELS = sorted((ROOT / "dist").glob("neural_mesh-*.whl"))
HEADER = (ROOT / "vcg_core/c_api/neural_mesh.h").read_text()
FUNCTIONS = set(re.findall(r"^NEURAL_MESH_API .*?\b(neural_mesh_\w+)\(", HEADER, re.MULTILINE))
# Of the C library and the loader, which each system has.
LINUX = {"libc.so.6", "libm.so.6", "libpthread.so.0", "libdl.so.2", "ld-linux-aarch64.so.1"}
WITH_LIBSTDCXX = LINUX | {"libstdc++.so.6", "libgcc_s.so.1"}  # which PyPI's policy allows, too
WINDOWS = re.compile(r"(kernel32|ntdll|bcrypt|advapi32|ucrtbase|msvcrt|api-ms-win-crt-[\w-]+)\.dll", re.IGNORECASE)
TIMEOUT = 3000  # seconds; emulators take some 60 times as long


def tag_of(wheel):
    return wheel.stem.split("-", 4)[4]


def wheel_for(words):
    """The wheel whose tag has these words, a regular expression."""
    return next(wheel for wheel in WHEELS if re.search(words, tag_of(wheel)))


@pytest.fixture
def library(tmp_path):
    """library(words) -> the library in the wheel whose tag has these words, by lief."""
    def parsed(words):
        with zipfile.ZipFile(wheel_for(words)) as archive:
            name = next(name for name in archive.namelist() if Path(name).stem.endswith("neural_mesh")
                        and Path(name).suffix in (".so", ".dll", ".dylib"))
            return lief.parse(archive.extract(name, tmp_path))
    return parsed


def test_there_is_a_wheel_for_each_system():
    assert len(WHEELS) == len(libraries.TARGETS) + 1 and {tag_of(wheel) for wheel in WHEELS} > set(libraries.TARGETS)
    assert all(wheel.stat().st_size < 3_000_000 for wheel in WHEELS)


def test_names_and_metadata_are_those_of_the_standards():
    for tool in (["twine", "check", "--strict"], ["check_wheel_contents"]):
        programs.output_of(sys.executable, "-m", *tool, *WHEELS)


@pytest.mark.parametrize("words, machine, needed", [("manylinux.*x86_64", "X86_64", WITH_LIBSTDCXX),
                                                    ("manylinux.*aarch64", "AARCH64", LINUX)])
def test_linux(library, words, machine, needed):
    file = library(words)
    assert file.header.machine_type.name == machine and set(file.libraries) <= needed
    assert {symbol.name for symbol in file.exported_symbols} - {"NEURAL_MESH_1"} == FUNCTIONS
    versions = [int(found[1]) for requirement in file.symbols_version_requirement
                for version in requirement.get_auxiliary_symbols()
                if (found := re.fullmatch(r"GLIBC_2\.(\d+)(\.\d+)?", version.name))]
    assert max(versions) <= int(re.search(r"manylinux_2_(\d+)", tag_of(wheel_for(words)))[1])


def test_windows(library):
    file = library("win_amd64")
    assert file.header.machine.name == "AMD64"
    assert all(WINDOWS.fullmatch(name) for name in file.libraries), file.libraries
    assert {entry.name for entry in file.get_export().entries} == FUNCTIONS


@pytest.mark.parametrize("words, machine", [("macosx_11_0_arm64", "ARM64"), ("macosx_11_0_x86_64", "X86_64")])
def test_macos(library, words, machine):
    file = library(words)
    assert file.header.cpu_type.name == machine
    assert file.build_version.minos[:2] == [11, 0]
    assert {entry.name for entry in file.libraries} <= {"/usr/lib/libSystem.B.dylib", "@rpath/libneural_mesh.dylib"}
    exported = {entry.symbol.name.removeprefix("_") for entry in (file.dyld_info or file.dyld_exports_trie).exports}
    assert exported - {"__dso_handle", "_mh_dylib_header"} == FUNCTIONS  # these are of every file of zig's
    # Apple's processors run signed code only; the linker signs it ad hoc.
    assert machine != "ARM64" or file.has_code_signature


def test_arm64_gives_the_recorded_bytes(tmp_path):
    """Python and numpy of Debian for arm64, unpacked without being installed."""
    mirror = programs.output_of(ROOT / "filter_neuralmesh/sources/debian_mirror.sh").strip()
    root = tmp_path / "root"
    programs.output_of("debootstrap", "--foreign", "--arch=arm64", "--variant=minbase", "--include=python3,python3-numpy",
                       "bookworm", root, mirror)
    for package in (root / "var/cache/apt/archives").glob("*.deb"):
        programs.output_of("dpkg", "-x", package, root)
    with zipfile.ZipFile(wheel_for("aarch64")) as archive:
        archive.extractall(tmp_path / "site")
    libraries_of_numpy = "/usr/lib/aarch64-linux-gnu/blas:/usr/lib/aarch64-linux-gnu/lapack"  # as installing would link
    done = programs.run("qemu-aarch64", "-L", root, "-E", f"LD_LIBRARY_PATH={libraries_of_numpy}",
                        root / "usr/bin/python3.11", library_clouds.__file__, timeout=TIMEOUT,
                        env=dict(os.environ, PYTHONPATH=str(tmp_path / "site")))
    assert done.stdout == "6 clouds, other bytes than recorded: none\n"


def test_windows_gives_the_mesh_of_this_system(tmp_path):
    """By the example in C."""
    with zipfile.ZipFile(wheel_for("win_amd64")) as archive:
        shutil.copyfileobj(archive.open("neural_mesh/neural_mesh.dll"), (tmp_path / "neural_mesh.dll").open("wb"))
    programs.output_of(libraries.program_of(BUILD / "zig"), "cc", "-target", libraries.TARGETS["win_amd64"].zig, "-std=c89",
                       "-pedantic-errors", "-I", ROOT / "vcg_core/c_api", ROOT / "vcg_core/c_api/example.c",
                       "neural_mesh.dll", "-o", "example.exe", cwd=tmp_path)
    points = "".join(" ".join(map(repr, map(float, point))) + "\n" for point in library_clouds.directions(2000, 1))
    here, there = (programs.output_of(*command, "150", input=points, cwd=tmp_path, timeout=TIMEOUT,
                                      env=dict(os.environ, WINEDEBUG="-all", WINEPREFIX=str(tmp_path / "wine"))).splitlines()
                   for command in ([BUILD / "tests/c_example"], ["/usr/lib/wine/wine64", "example.exe"]))
    assert len(here) > 400 and here == there
