# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""A plugin in a host for which it is not built is refused with an error message, and does not run."""

import sys

import meshlabserver
import programs
import pytest
from conftest import FULL, PYTHON_NAME


def run_in_2020(build, model, tmp_path, plugin):
    """What MeshLab 2020.09 prints that fails to run the filter."""
    folder = meshlabserver.make_folder(tmp_path / "meshlab", plugin)
    script = meshlabserver.write_script(build, tmp_path / "s.mlx", target_vertices=100)
    code, text = meshlabserver.run(folder, "-i", model("sphere")[0], "-o", tmp_path / "out.ply", "-s", script)
    assert code == 255 and not (tmp_path / "out.ply").exists(), text
    return text


@pytest.mark.parametrize("host", meshlabserver.HOSTS[1:])
def test_meshlab_2020_loads_no_later_plugin(build, model, tmp_path, host):
    """Its loader reports that it cannot load the file, and the host runs without the filter."""
    text = run_in_2020(build, model, tmp_path, meshlabserver.plugin_path(build, host))
    assert "Cannot load library" in text and "libfilter_neuralmesh.so" in text
    assert "filter Surface Reconstruction: Neural Mesh not found" in text


@FULL  # two more plugins to compile
@pytest.mark.parametrize("kind, built", [("older_release", "2020.07 (float)"), ("other_scalar", "2020.09 (double)")])
def test_the_plugin_itself_refuses_to_run_in_meshlab_2020(build, model, tmp_path, kind, built):
    """This host does not check plugins; running these would corrupt its memory."""
    text = run_in_2020(build, model, tmp_path, build / "tests/wrong_plugins" / kind / "libfilter_neuralmesh.so")
    assert (f"This Neural Mesh plugin is built for MeshLab {built}, but the running MeshLab is 2020.09 (float). "
            "Replace the plugin by the one built for this MeshLab.") in text.splitlines()


LOAD = """import pymeshlab, sys
try:
    pymeshlab.load_plugin(sys.argv[1])
except pymeshlab.PyMeshLabException as error:
    sys.exit("refused: " + str(error))
pymeshlab.MeshSet(verbose=False).apply_filter(sys.argv[2])
"""


@pytest.mark.parametrize("host", meshlabserver.HOSTS[:3])
def test_pymeshlab_loads_no_plugin_of_another_host(build, host):
    done = programs.run(sys.executable, "-c", LOAD, meshlabserver.plugin_path(build, host), PYTHON_NAME)
    assert done.returncode == 1
    assert done.stderr.startswith("refused: ") and "libfilter_neuralmesh.so" in done.stderr
