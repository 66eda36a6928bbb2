# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Every layer of inputs.py in every host: the result is a correct mesh or an error message, the same in all hosts, and
the layer is unchanged."""

from html import escape

import input_hosts
import inputs
import meshlabserver
import numpy as np
import pytest
from conftest import in_hosts

INPUTS = inputs.all_inputs()
# One for each way in which the adapters and the hosts' layers differ.
ELSEWHERE = ("empty layer", "not finite", "deleted vertices", "selected points", "georeferenced, turned", "quads",
             "texture and attributes", "start from itself")
COUNTS = ("vertices", "faces", "signals", "splits", "collapses", "genus", "components", "stop_reason")


def assert_alike(one, other):
    assert one[0] == other[0], "another result than in the first host"
    if one[1] is not None:
        for here, there in zip(one[1], other[1]):
            assert np.array_equal(here, there), "another mesh than in the first host"


@pytest.mark.parametrize("name, host", in_hosts(INPUTS, ELSEWHERE))
def test_a_correct_mesh_or_an_error_message(build, server, pymeshlab, first_of, tmp_path, name, host):
    layer = INPUTS[name]
    outcome = input_hosts.try_out(build, server, pymeshlab, host, layer, tmp_path)
    result = (outcome.sentence or [outcome.report[key] for key in COUNTS], outcome.mesh_in_single_precision(layer))
    assert_alike(result, first_of.setdefault(name, result))
    input_hosts.check(build, layer, outcome)


def condition_in(sentence):
    """The condition of selection that the error message advises."""
    return sentence.split("the condition ")[1].split(",")[0]


def test_the_remedy_for_vertices_that_are_not_finite_in_pymeshlab(pymeshlab, tmp_path):
    layer = INPUTS["not finite"]
    sentence = input_hosts.in_pymeshlab(pymeshlab, layer, tmp_path).sentence
    meshes = input_hosts.new_mesh_set(pymeshlab)
    meshes.add_mesh(pymeshlab.Mesh(layer.points.astype(float)))
    meshes.compute_selection_by_condition_per_vertex(condselect=condition_in(sentence))
    meshes.meshing_remove_selected_vertices()
    assert meshes.current_mesh().vertex_number() == len(layer.points) - 3
    assert meshes.apply_filter(input_hosts.PYTHON_NAME, target_vertices=100)["vertices"] == 100


REMEDY = """<!DOCTYPE FilterScript>
<FilterScript>
 <filter name="Conditional Vertex Selection">
  <Param type="RichString" name="condSelect" value="{condition}"/>
 </filter>
 <filter name="Delete Selected Vertices"/>"""


def test_the_remedy_for_vertices_that_are_not_finite_in_meshlabserver(build, server, pymeshlab, tmp_path):
    layer = INPUTS["not finite"]
    sentence = input_hosts.in_server(build, server, pymeshlab, layer, tmp_path).sentence
    script = meshlabserver.write_script(build, tmp_path / "remedy.mlx", target_vertices=100)
    _, filters = script.read_text().split("<FilterScript>")
    script.write_text(REMEDY.format(condition=escape(condition_in(sentence))) + filters)
    cloud = inputs.write_ply(layer, tmp_path / "cloud.ply")
    assert meshlabserver.reconstruct(server, cloud, script, tmp_path / "mesh.ply")["vertices"] == 100
