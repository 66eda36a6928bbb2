# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The documented scripts that make meshes of a folder of clouds."""

import shutil
import subprocess
import sys
from pathlib import Path

import meshlabserver
import pytest
from conftest import write_points

pytestmark = pytest.mark.full

EXAMPLES = Path(__file__).resolve().parent / "examples"
NAMES = ("sphere", "filleted-cube", "bunny")


@pytest.fixture
def folder(build, model, tmp_path):
    (tmp_path / "clouds").mkdir()
    for name in NAMES:
        shutil.copy(model(name)[0], tmp_path / "clouds" / f"{name}.ply")
    meshlabserver.write_script(build, tmp_path / "reconstruct.mlx", target_vertices=2000)
    return tmp_path


def assert_all_learned(build, folder):
    assert sorted(path.stem for path in (folder / "meshes").iterdir()) == sorted(NAMES)
    for name in NAMES:
        found = meshlabserver.check_mesh(build, folder / "meshes" / f"{name}.ply", folder / "clouds" / f"{name}.ply")
        assert found["vertices"] == 2000 and found["watertight"] and found["quality"]
        assert found["rms_to_mesh"] < 0.4


def test_meshlabserver_with_gnu_parallel(build, server, folder):
    done = subprocess.run(["bash", str(EXAMPLES / "folder_meshlabserver.sh")], cwd=folder, check=False,
                          env=meshlabserver.environment(server), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, timeout=300)
    assert done.returncode == 0, done.stdout
    assert_all_learned(build, folder)


def test_pymeshlab_with_a_process_pool(build, folder):
    """One of the clouds cannot be learned."""
    write_points(folder / "clouds" / "c_point.ply", [[1, 2, 3]])
    plugin = meshlabserver.plugin_path(build, "pymeshlab-2025.7")
    done = subprocess.run([sys.executable, str(EXAMPLES / "folder_pymeshlab.py"), str(plugin)], cwd=folder, check=False,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=300)
    assert done.returncode == 0, done.stdout
    assert done.stdout.count("2000 vertices") == len(NAMES)
    assert done.stdout.count("c_point.ply: ") == done.stdout.count("at least 4 distinct points.") == 1
    assert_all_learned(build, folder)
