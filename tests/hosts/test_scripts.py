# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The example scripts, up to date and run in meshlabserver 2020.09, where vcglib checks the results; the page of parameters;
the Python of the first page; the demo, with and without a cloud that MeshLab reads."""

import re
import shutil
from pathlib import Path

import library_clouds
import meshlabserver
from check_mesh import check_mesh
import numpy as np
import parameters_page
import programs
import pytest

FIRST_PAGE = Path(__file__).resolve().parents[2] / "README.md"
PYTHON = re.findall(r"^```python\n(.*?)^```", FIRST_PAGE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)


def test_the_page_and_the_scripts_agree_with_the_tables_of_parameters(build):
    texts = parameters_page.texts(build)
    assert set(texts) == {parameters_page.PAGE, *parameters_page.SCRIPTS.glob("*.mlx")}
    for path, text in texts.items():
        assert path.read_text(encoding="utf-8") == text, f"{path} is out of date: run tests/hosts/parameters_page.py"


@pytest.mark.parametrize("number", range(2))
def test_the_python_of_the_first_page_runs(build, site, model, tmp_path, number):
    shutil.copy(model("sphere")[0], tmp_path / "cloud.ply")
    np.savetxt(tmp_path / "cloud.xyz", library_clouds.directions(20_000, 1))
    done = programs.python(site, "-c", PYTHON[number], cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    found = check_mesh(tmp_path / "mesh.ply")
    assert found["vertices"] == 5000 and found["watertight"]
    assert found["quality"] and (number == 0 or done.stdout.startswith("5000 0 "))


def test_a_script_with_an_unknown_parameter_is_not_written(build, tmp_path):
    with pytest.raises(meshlabserver.ServerError, match="target_vertexes"):
        meshlabserver.write_script(build, tmp_path / "wrong.mlx", target_vertexes=5)


def test_the_script_with_the_defaults_makes_a_sound_mesh(build, server, model, tmp_path):
    cloud, surface = model("bunny")
    script = parameters_page.SCRIPTS / "reconstruct.mlx"
    report = meshlabserver.reconstruct(server, cloud, script, tmp_path / "out.ply")
    found = check_mesh(tmp_path / "out.ply", surface)
    wanted = int(re.search(r'name="target_vertices" value="(\d+)"', script.read_text()).group(1))

    assert found["vertices"] == report["vertices"] == wanted
    assert found["faces"] == report["faces"] == 2 * wanted - 4
    assert report["stop_reason"] == 0
    assert found["watertight"] and found["oriented"]
    assert (found["genus"], found["components"], found["boundary_loops"]) == (0, 1, 0)
    assert (report["genus"], report["components"], report["boundary_loops"]) == (0, 1, 0)
    assert found["volume"] > 0, "the faces look inwards"
    assert found["quality"] and found["color"]
    # The mean edge is about 170 / sqrt(vertices) % of the diagonal; the error is proportional to its square.
    assert max(found["rms_to_mesh"], found["rms_to_reference"], report["rms_error"]) <= 0.08 * 10000 / wanted
    assert found["selected"] == 0


def test_the_script_of_counters_selects_the_creases(build, server, model, tmp_path):
    """Of a layer that is mesh and points at once."""
    surface = model("crossed-cylinders")[1]
    script = parameters_page.SCRIPTS / "counters_of_a_mesh.mlx"
    report = meshlabserver.reconstruct(server, surface, script, tmp_path / "out.ply")
    found = check_mesh(tmp_path / "out.ply")
    assert report["stop_reason"] == 0 and found["quality"]
    assert 0 < found["selected"] == report["feature_vertices"] < report["vertices"] == found["vertices"]


def demo(build, *words):
    """The finished process, run by Debian's Python as in run.sh."""
    return programs.run("/usr/bin/python3", Path(__file__).with_name("demo.py"), "--build", build, *words, timeout=300)


def test_a_cloud_becomes_a_mesh_and_a_picture(build, model, tmp_path):
    done = demo(build, "--cloud", model("sphere")[0], "--vertices", 500, "--out", tmp_path / "out" / "ball.ply")
    assert done.returncode == 0, done.stdout + done.stderr
    assert check_mesh(tmp_path / "out" / "ball.ply")["vertices"] == 500
    assert (tmp_path / "out" / "ball.png").exists()
    assert "996, closed, genus 0" in done.stdout


def test_a_format_that_meshlab_cannot_read_is_reported(build, tmp_path):
    (tmp_path / "cloud.las").write_text("LASF")
    done = demo(build, "--cloud", tmp_path / "cloud.las", "--vertices", 500, "--out", tmp_path / "ball.ply")
    assert done.returncode == 1 and "made no mesh of" in done.stderr and "Traceback" not in done.stderr
