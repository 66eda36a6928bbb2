# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The plugins for MeshLab 2022.02 and 2025.07, loaded and run by the libraries of those releases without a window.

These come from Debian trixie and sid, in root folders that gui_debian_root.sh makes (800 MB each); without such a
folder the tests are skipped. No root rights are needed here: the releases' own loader runs the program."""

import json
import os
import subprocess
from pathlib import Path

import meshlabserver
import pytest

CACHE = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "neural-mesh"
ROOTS = Path(os.environ.get("NEURAL_MESH_ROOTS") or CACHE / "roots")
SUITES = {"2022.02": "trixie", "2025.07": "sid"}
RELEASES = sorted(SUITES)


def run(build, release, plugin):
    suite = SUITES[release]
    if not Path(f"{ROOTS}/{suite}.complete").exists():
        pytest.skip(f"There is no {ROOTS / suite}: tests/hosts/gui_debian_root.sh {suite} {ROOTS / suite} makes it.")
    libraries = ROOTS / suite / "usr/lib/x86_64-linux-gnu"
    command = [libraries / "ld-linux-x86-64.so.2", "--library-path", f"{libraries}/meshlab:{libraries}",
               build / "tests/run_library_host", libraries / "meshlab/libmeshlab-common.so",
               build / f"tests/liblibrary_host_{release}.so", plugin]
    return subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          check=False, timeout=120,
                          env=dict(os.environ, QT_QPA_PLATFORM="offscreen", QT_PLUGIN_PATH=str(libraries / "qt5/plugins")))


@pytest.mark.parametrize("release", RELEASES)
def test_the_plugin_is_loaded_and_runs(build, release):
    done = run(build, release, meshlabserver.plugin_path(build, f"meshlab-{release}"))
    assert done.returncode == 0, done.stderr
    told, sentence, layers = done.stdout.splitlines()
    told = json.loads(told)
    assert told["label"] == "Neural Mesh" and told["layers"] == 2 and told["cloud_points"] == 5000
    assert told["vn"] == told["vertices"] == 500 and told["faces"] == 996 and told["watertight"]
    assert told["genus"] == 0 and told["components"] == 1 and told["rms_error"] < 0.5
    assert sentence.startswith("The parameter target_vertices ") and sentence.endswith(".")
    assert layers == "2", "the refused run has left a layer"


HOSTS = ("meshlab-2020.09", "meshlab-2022.02", "meshlab-2025.07", "pymeshlab-2025.7")


@pytest.mark.parametrize("release, host", [(release, host) for release in RELEASES for host in HOSTS
                                           if host != f"meshlab-{release}"])
def test_plugins_of_other_hosts_are_refused(build, release, host):
    done = run(build, release, meshlabserver.plugin_path(build, host))
    assert done.returncode == 1, done.stderr
    assert done.stdout.startswith("refused: ") and len(done.stdout) > 40
