# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""pymeshlab: results as a dictionary, errors as exceptions that leave the MeshSet unchanged, and the same mesh as in
meshlabserver, bit by bit."""

import subprocess
import sys

import inputs
import meshlabserver
import numpy as np
import pytest
import shapes
from conftest import CORNERS, PYTHON_NAME, out_of_range, parameters
from input_hosts import state

COUNTS = ("vertices", "faces", "signals", "splits", "collapses", "genus", "boundary_loops", "components",
          "outliers", "feature_vertices", "crease_lines", "warnings", "stop_reason")
MEASURES = meshlabserver.MEASURES


def learn(meshes, **values):
    return meshes.apply_filter(PYTHON_NAME, **values)


@pytest.mark.parametrize("name", ["cup", "bunny"])
def test_exact_count_sound_mesh_and_the_full_dictionary(build, meshes, model, tmp_path, name):
    cloud, _ = model(name)
    meshes.load_new_mesh(str(cloud))
    report = learn(meshes, target_vertices=1500, select_features=True)
    learned = meshes.current_mesh()

    assert set(report) == {*COUNTS, *MEASURES}
    assert all(type(report[key]) is int for key in COUNTS) and all(type(report[key]) is float for key in MEASURES)
    assert learned.vertex_number() == report["vertices"] == 1500
    assert learned.face_number() == report["faces"] == 2996
    selected = learned.vertex_selection_array().copy()  # the next filter changes the selection
    topology = meshes.get_topological_measures()
    assert topology["is_mesh_two_manifold"] and topology["boundary_edges"] == 0
    assert topology["genus"] == report["genus"] == 0 and topology["connected_components_number"] == 1
    assert 0.9 <= report["topology_confidence"] <= 1
    assert topology["unreferenced_vertices"] == 0
    assert report["stop_reason"] == 0 and report["signals"] > 0 and report["splits"] > 0 and report["seconds"] > 0
    assert learned.has_vertex_scalar() and learned.has_vertex_color()
    counters = learned.vertex_scalar_array()
    assert counters.min() >= 0 and report["mean_counter"] == pytest.approx(counters.mean(), rel=1e-4)
    assert selected.sum() == report["feature_vertices"]
    assert (learned.transform_matrix() == np.eye(4)).all()
    assert learned.label() == "Neural Mesh"


def test_the_input_layer_stays_and_the_result_is_current(meshes, model):
    _, surface = model("sphere")
    meshes.load_new_mesh(str(surface))
    before, _ = state(meshes)
    learn(meshes, target_vertices=200)
    after, current = state(meshes)
    assert after[:1] == before and len(after) == 2
    assert current == after[1][0] and after[1][1] == "Neural Mesh"


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


def test_a_target_error_is_a_length_or_a_percentage(pymeshlab, meshes):
    points = shapes.sphere(radius=10, subdivisions=5)[0]
    diagonal = np.linalg.norm(np.ptp(points, axis=0))
    vertices = []
    for error in (pymeshlab.PureValue(0.003 * diagonal), pymeshlab.PercentageValue(0.3)):
        meshes.add_mesh(pymeshlab.Mesh(points))
        report = learn(meshes, target_error=error)
        assert report["held_out_error"] == pytest.approx(0.003 * diagonal, rel=0.25)
        vertices.append(report["vertices"])
    assert vertices[0] == vertices[1] < 2000


@pytest.mark.parametrize("sign", [1, -1])
def test_an_open_cloud_faces_the_side_of_its_normals(pymeshlab, meshes, sign):
    points = shapes.sphere(subdivisions=5)[0]
    points = points[points[:, 2] < .3]
    meshes.add_mesh(pymeshlab.Mesh(points, v_normals_matrix=sign * points))
    report = learn(meshes, target_vertices=300)
    assert report["boundary_loops"] == 1
    corners = meshes.current_mesh().vertex_matrix()[meshes.current_mesh().face_matrix()]
    out = np.einsum("ij,ij->i", np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), corners[:, 0]) > 0
    assert out.mean() > .99 if sign > 0 else out.mean() < .01
    assert np.array_equal(meshes.mesh(0).vertex_normal_matrix(), sign * points)


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
    text = subprocess.run([sys.executable, "-c", LIST_PARAMETERS, str(plugin), filter_name], check=True,
                          stdout=subprocess.PIPE, text=True).stdout
    listed = dict(line.strip().split(" : ") for line in text.splitlines() if " : " in line)
    for name, kind, _, _, default, _ in parameters(build, filter_name):
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


LEARN_AND_LOG = """
import sys
import pymeshlab
pymeshlab.load_plugin(sys.argv[1])
meshes = pymeshlab.MeshSet(verbose=True)
meshes.load_new_mesh(sys.argv[2])
print(meshes.apply_filter(sys.argv[3], target_vertices=100)["warnings"])
"""


def test_warnings_are_counted_and_logged(build, tmp_path):
    """A sheet is learned with warnings, a ball without. In a separate process, because after quiet MeshSets a verbose
    one prints nothing."""
    plugin = str(meshlabserver.plugin_path(build, "pymeshlab-2025.7"))
    counted = []
    for points in (inputs.square(), inputs.ball()):
        cloud = tmp_path / "cloud.ply"
        inputs.write_ply(inputs.Input(points), cloud)
        report = subprocess.run([sys.executable, "-c", LEARN_AND_LOG, plugin, str(cloud), PYTHON_NAME], check=True,
                              capture_output=True, text=True)
        counted.append(int(report.stdout.split()[-1]))
        log = report.stdout + report.stderr
        assert log.count("LOG: 1 ") == counted[-1], log  # the host's number for a warning
    assert counted[0] > 0 and counted[1] == 0


def test_nothing_is_printed(pymeshlab, model, capfd):
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.load_new_mesh(str(model("sphere")[0]))
    capfd.readouterr()
    learn(meshes, target_vertices=200)
    printed = capfd.readouterr()
    assert (printed.out, printed.err) == ("", "")
