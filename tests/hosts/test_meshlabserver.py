# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""MeshLab 2020.09: error messages for invalid parameters, and a start layer; test_inputs.py has the layers."""

import meshlabserver
from conftest import out_of_range, parameters

FAILED = 255


def assert_refused(code, text, words):
    """The filter failed with one sentence in the log, and the host did not crash."""
    assert code == FAILED, text
    assert "Problem with filter: Surface Reconstruction: Neural Mesh" in text
    lines = [line for line in text.splitlines() if words in line and not line.startswith("LOG")]
    assert len(lines) == 1, text
    assert lines[0].rstrip().endswith(".")
    assert "aborted" not in text.lower() and "assertion" not in text.lower()


def test_learning_goes_on_from_another_layer(build, server, model, tmp_path):
    """The script names the start mesh by its position; the last layer is the current one."""
    cloud, _ = model("bunny")
    script = meshlabserver.write_script(build, tmp_path / "coarse.mlx", target_vertices=500)
    meshlabserver.reconstruct(server, cloud, script, tmp_path / "coarse.ply")
    script = meshlabserver.write_script(build, tmp_path / "fine.mlx", target_vertices=1500, start_mesh=2, start_layer=0)
    out = tmp_path / "fine.ply"
    code, text = meshlabserver.run(server, "-i", tmp_path / "coarse.ply", cloud, "-o", out, "-s", script)
    assert code == 0 and out.exists(), text
    report = meshlabserver.figures(text)
    assert report["vertices"] == 1500 and report["topology_confidence"] == 0
    script = meshlabserver.write_script(build, tmp_path / "wrong.mlx", target_vertices=1500, start_mesh=2, start_layer=1)
    assert_refused(*meshlabserver.run(server, "-i", tmp_path / "coarse.ply", cloud, "-o", out, "-s", script),
                   "The start layer has no faces")


def test_parameters_out_of_range_are_refused(build, server, model, tmp_path):
    """One of each kind; test_pymeshlab.py has all."""
    cloud, _ = model("sphere")
    kinds = {name: kind for name, kind, *_ in parameters(build)}
    cases = {kinds[name]: (name, value) for name, value in out_of_range(build)}
    assert len(cases) == 3
    for name, value in (*cases.values(), ("utility_counter", 7)):
        script = meshlabserver.write_script(build, tmp_path / "s.mlx", **{name: value})
        code, text = meshlabserver.run(server, "-i", cloud, "-o", tmp_path / "out.ply", "-s", script)
        assert_refused(code, text, f"The parameter {name} ")
