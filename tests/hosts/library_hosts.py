# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Runs library_host.cpp with the libraries of MeshLab 2022.02 and 2025.07, of Debian trixie and sid.

The libraries are fetched on first use. No root rights are needed: each release's own loader starts the program."""

import functools
import json
import os
from pathlib import Path

import programs

CACHE = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "neural-mesh"
SUITES = {"2022.02": "trixie", "2025.07": "sid"}
RELEASES = tuple(sorted(SUITES))


@functools.lru_cache
def libraries_of(release):
    """The folder of the release's libraries, in the user's cache. RuntimeError says why they cannot be fetched."""
    folder = CACHE / "libraries" / release
    script = Path(__file__).resolve().with_name("fetch_libraries.sh")
    done = programs.run(script, release, SUITES[release], folder, timeout=900)
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip())
    return folder / "usr/lib/x86_64-linux-gnu"


def run(build, release, plugin, out, *mode):
    """Starts library_host.cpp; returns the finished process."""
    libraries = libraries_of(release)
    return programs.run(libraries / "ld-linux-x86-64.so.2", "--library-path", f"{libraries}/meshlab:{libraries}",
                        build / "tests/run_library_host", libraries / "meshlab/libmeshlab-common.so",
                        build / f"tests/liblibrary_host_{release}.so", plugin, out, *mode, timeout=300,
                        env=dict(os.environ, QT_QPA_PLATFORM="offscreen", QT_PLUGIN_PATH=str(libraries / "qt5/plugins")))


def outcomes(done):
    """The JSON objects that the runs have printed. AssertionError: the process has failed."""
    assert done.returncode == 0, f"ended with code {done.returncode}: {done.stderr or done.stdout}"
    return [json.loads(line) for line in done.stdout.splitlines()]
