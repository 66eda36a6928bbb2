# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""pymeshlab: results as a dictionary, errors as exceptions that leave the MeshSet unchanged, and the same mesh as in
meshlabserver, bit by bit."""

import sys

import inputs
import meshlabserver
import numpy as np
import programs
import pytest
import shapes
from conftest import CORNERS, PYTHON_NAME, out_of_range, parameters
from input_hosts import state

COUNTS = ("vertices", "faces", "signals", "splits", "collapses", "genus", "boundary_loops", "components",
          "outliers", "feature_vertices", "crease_lines", "warnings", "stop_reason")
MEASURES = meshlabserver.MEASURES


def learn(meshes, **values):
    return meshes.apply_filter(PYTHON_NAME, **values)


def test_the_dictionary_is_full_and_right(meshes, model):
    """test_inputs.py checks the mesh and its topology."""
    meshes.load_new_mesh(str(model("bunny")[0]))
    report = learn(meshes, target_vertices=1500, select_features=True)
    learned = meshes.current_mesh()
    assert set(report) == {*COUNTS, *MEASURES}
    assert all(type(report[key]) is int for key in COUNTS) and all(type(report[key]) is float for key in MEASURES)
    assert learned.face_number() == report["faces"] == 2996
    assert 0.9 <= report["topology_confidence"] <= 1
    assert report["stop_reason"] == 0 and report["signals"] > 0 and report["splits"] > 0 and report["seconds"] > 0
    counters = learned.vertex_scalar_array()
    assert learned.has_vertex_color() and counters.min() >= 0
    assert report["mean_counter"] == pytest.approx(counters.mean(), rel=1e-4)
    assert learned.vertex_selection_array().sum() == report["feature_vertices"]


def assert_refused(pymeshlab, meshes, words, **values):
    """Returns the sentence."""
    before = state(meshes)
    with pytest.raises(pymeshlab.PyMeshLabException) as caught:
        learn(meshes, **values)
    assert state(meshes) == before, "the MeshSet has changed"
    sentence = str(caught.value).split("Details: ", 1)[1].strip()
    assert words in sentence and sentence.endswith(".")
    return sentence


def test_every_parameter_out_of_range_raises(build, pymeshlab, meshes):
    meshes.add_mesh(pymeshlab.Mesh(np.array(CORNERS, dtype=float)))
    lengths = [name for name, kind, *_ in parameters(build) if kind == "RichAbsPerc"]
    for name, value in out_of_range(build):
        given = pymeshlab.PureValue(value) if name in lengths else value
        assert_refused(pymeshlab, meshes, f"The parameter {name} ", **{name: given})


def test_a_length_is_given_in_world_units_or_percent(pymeshlab, meshes):
    points = shapes.sphere(radius=10, subdivisions=5)[0]
    for length, loops in ((pymeshlab.PureValue(20), 0), (pymeshlab.PureValue(3), 1), (pymeshlab.PercentageValue(60), 0),
                          (pymeshlab.PercentageValue(10), 1)):
        meshes.add_mesh(pymeshlab.Mesh(points[points[:, 2] < 8]))  # the opening has a diameter of 12
        report = learn(meshes, target_vertices=300, surface="Automatic", close_holes_up_to=length)
        assert report["boundary_loops"] == loops, length


def test_learning_goes_on_from_another_layer(pymeshlab, meshes, model):
    meshes.load_new_mesh(str(model("bunny")[0]))
    learn(meshes, target_vertices=500)
    before = state(meshes)[0]
    meshes.set_current_mesh(0)
    report = learn(meshes, target_vertices=1500, start_mesh=2, start_layer=1)
    assert report["vertices"] == 1500 and report["topology_confidence"] == 0
    assert state(meshes)[0][:2] == before, "the cloud or the start layer has changed"
    meshes.set_current_mesh(0)
    assert_refused(pymeshlab, meshes, "does not exist", start_mesh=2, start_layer=7)
    learn(meshes, target_vertices=100, start_layer=7)  # looked at only where it is needed


LIST_PARAMETERS = """import pymeshlab, sys
pymeshlab.load_plugin(sys.argv[1])
pymeshlab.print_filter_parameter_list(sys.argv[2])
"""


@pytest.mark.parametrize("filter_name", [PYTHON_NAME, inputs.COUNTERS])
def test_parameters_and_defaults_are_those_of_the_table(build, filter_name):
    plugin = meshlabserver.plugin_path(build, "pymeshlab-2025.7")
    text = programs.output_of(sys.executable, "-c", LIST_PARAMETERS, plugin, filter_name)
    listed = dict(line.strip().split(" : ") for line in text.splitlines() if " : " in line)
    for name, kind, _, _, default in parameters(build, filter_name):
        python_type, python_default = listed.pop(name).split(" = ")
        assert python_type == {"RichBool": "bool", "RichInt": "int", "RichFloat": "float", "RichEnum": "str",
                               "RichAbsPerc": "PercentageValue", "RichMesh": "int"}[kind], name
        if kind != "RichEnum":
            assert python_default.lower().rstrip("%") == default, name
    assert not listed


def test_the_same_mesh_as_in_meshlabserver_whatever_the_threads(build, server, meshes, model, tmp_path):
    cloud, _ = model("bunny")
    script = meshlabserver.write_script(build, tmp_path / "s.mlx", target_vertices=1500, random_seed=7, threads=1)
    there = meshlabserver.reconstruct(server, cloud, script, tmp_path / "out.ply")
    meshes.load_new_mesh(str(tmp_path / "out.ply"))
    expected = meshes.current_mesh()
    for threads in (0, 2):
        meshes.load_new_mesh(str(cloud))
        here = learn(meshes, target_vertices=1500, random_seed=7, threads=threads)
        learned = meshes.current_mesh()
        assert (learned.face_matrix() == expected.face_matrix()).all()
        assert (learned.vertex_matrix().astype("f4") == expected.vertex_matrix().astype("f4")).all()
        assert (learned.vertex_scalar_array().astype("f4") == expected.vertex_scalar_array().astype("f4")).all()
        for key in COUNTS:
            assert here[key] == there[key], key
    meshes.load_new_mesh(str(cloud))
    learn(meshes, target_vertices=1500, random_seed=8)
    assert not np.array_equal(meshes.current_mesh().face_matrix(), expected.face_matrix()), "the seed has no effect"


def test_nothing_is_printed(pymeshlab, model, capfd):
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.load_new_mesh(str(model("sphere")[0]))
    capfd.readouterr()
    learn(meshes, target_vertices=200)
    printed = capfd.readouterr()
    assert (printed.out, printed.err) == ("", "")
