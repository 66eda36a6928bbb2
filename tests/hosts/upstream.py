# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The filter as a folder of MeshLab 2025.07's own sources: configured and compiled by MeshLab's build without a warning,
then run in MeshLab's library with the same result as the plugin of `./run.sh build`. Started by `./run.sh release`."""

import json
import os
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import library_hosts
import meshlabserver
import programs
import pytest

ROOT = Path(__file__).resolve().parents[2]
OPTIONS = ("-DMESHLAB_PLUGINS=meshlabplugins/filter_neuralmesh", "-DMESHLAB_BUILD_ONLY_LIBRARIES=ON",
           "-DMESHLAB_USE_DEFAULT_BUILD_AND_INSTALL_DIRS=ON", "-DMESHLAB_ALLOW_OPTIONAL_EXTERNAL_LIBRARIES=OFF",
           "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS=-Wall -Wextra", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON")


def run(*command):
    return programs.output_of(*command, stderr=subprocess.STDOUT)


@pytest.fixture(scope="module")
def objects(tmp_path_factory):
    """What the compiler printed, and the filter's object files. Called by hand as MeshLab's build would call it, since
    that would first build MeshLab's library."""
    meshlab = tmp_path_factory.mktemp("upstream") / "meshlab"
    shutil.copytree(library_hosts.CACHE / "meshlab-2025.07", meshlab, symlinks=True)
    run(ROOT / "packaging/upstream/copy.sh", meshlab)
    build = meshlab / "build"
    run("cmake", "-S", meshlab, "-B", build, "-G", "Ninja", *OPTIONS)
    folder = build / "src/meshlabplugins/filter_neuralmesh"
    run("cmake", "-E", "cmake_autogen", folder / "CMakeFiles/filter_neuralmesh_autogen.dir/AutogenInfo.json", "Release")
    commands = [entry["command"] for entry in json.loads((build / "compile_commands.json").read_text())]
    commands = [command for command in commands if "/filter_neuralmesh.dir/" in command]
    assert len(commands) > 50
    outputs = [build / words[words.index("-o") + 1] for words in map(str.split, commands)]
    for output in outputs:
        output.parent.mkdir(parents=True, exist_ok=True)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        printed = list(pool.map(lambda command: run("sh", "-c", f"cd '{build}' && {command}"), commands))
    return "".join(printed), outputs


def test_its_cmakelists_has_ten_lines_and_sets_its_standard():
    text = (ROOT / "packaging/upstream/CMakeLists.txt").read_text()
    assert len(text.splitlines()) == 10 and "CXX_STANDARD 17" in text and "-ffp-contract=off" in text


def test_meshlabs_build_compiles_it_without_a_warning(objects):
    ours = [line for line in objects[0].splitlines() if "warning:" in line and "filter_neuralmesh/" in line.split(":")[0]]
    assert not ours, "\n".join(ours)


def test_it_gives_the_same_mesh_as_the_plugin(build, objects, tmp_path):
    plugin = tmp_path / "libfilter_neuralmesh.so"
    run("g++", "-shared", "-o", plugin, *objects[1], "-lQt5Core", "-lQt5Widgets", "-pthread")
    for file in (plugin, meshlabserver.plugin_path(build, "meshlab-2025.07")):
        done = library_hosts.run(build, "2025.07", file, tmp_path / f"{file.parent.name}.off")
        assert library_hosts.outcomes(done)[0]["vertices"] == 100
    assert (tmp_path / f"{tmp_path.name}.off").read_bytes() == (tmp_path / "meshlab-2025.07.off").read_bytes()
