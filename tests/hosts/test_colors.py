# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Vertex colours: those of the layer, the same in all hosts, and what the filter does if there are none."""

from pathlib import Path

import input_hosts
import inputs
import meshlabserver
import numpy as np
import programs
import pytest
from conftest import FULL, write_points
from PIL import Image

EXAMPLE = Path(__file__).resolve().parent / "examples/texture_pymeshlab.py"
WAVE = 1.0  # the period of waves() over a unit ball, ten edges of its mesh of 1,500 vertices
OUTLIERS = 20


def waves(points):
    """A smooth texture with the full range of codes."""
    phases = 2 * np.pi * np.asarray(points, dtype=float) / WAVE + [0, 1, 2]
    return np.round(127.5 * (1 + np.sin(phases)))


def painted_ball(**parameters):
    """Black outliers lie off the surface."""
    points = np.vstack([inputs.ball(20000), inputs.ball(OUTLIERS, radius=1.5)])
    colors = waves(points)
    colors[-OUTLIERS:] = 0
    return inputs.Input(points, paint=colors, outliers=OUTLIERS, target=1500, parameters=parameters)


def result_in(pymeshlab, outcome):
    """(vertices, colours from 0 to 255) of the result."""
    meshes = input_hosts.new_mesh_set(pymeshlab)
    meshes.load_new_mesh(str(outcome.mesh))
    mesh = meshes.current_mesh()
    return mesh.vertex_matrix(), np.round(255 * mesh.vertex_color_matrix()[:, :3]).astype(int)


@pytest.mark.parametrize("host", input_hosts.HOSTS)
def test_the_mesh_has_the_colours_of_the_layer(build, server, pymeshlab, first_of, tmp_path, host):
    outcome = input_hosts.try_out(build, server, pymeshlab, host, painted_ball(), tmp_path)
    assert outcome.unchanged and outcome.report["outliers"] == OUTLIERS
    vertices, colors = result_in(pymeshlab, outcome)
    assert np.abs(colors - waves(vertices)).mean() < 3
    assert np.array_equal(colors, first_of.setdefault("colors", colors))


def assert_counter_colors(mesh):
    """Lighter where the counter is low."""
    colors, counters = mesh.vertex_color_matrix()[:, :3], mesh.vertex_scalar_array()
    low, high = np.percentile(counters, [25, 75])
    assert colors[counters < low].mean() > colors[counters > high].mean() + .1


def test_a_layer_without_colours_gets_those_of_the_counter(build, server, pymeshlab, tmp_path):
    cloud = write_points(tmp_path / "cloud.ply", inputs.ball(2000))
    script = meshlabserver.write_script(build, tmp_path / "script.mlx", target_vertices=200)
    code, text = meshlabserver.run(server, "-i", cloud, "-o", tmp_path / "out.ply", "-m", "vq", "vc", "-s", script)
    assert code == 0 and "The layer has no colours" in text
    assert meshlabserver.figures(text)["warnings"] == 0
    meshes = input_hosts.new_mesh_set(pymeshlab)
    meshes.load_new_mesh(str(tmp_path / "out.ply"))
    assert_counter_colors(meshes.current_mesh())


def test_the_colours_can_be_chosen(pymeshlab, meshes, tmp_path):
    cloud = inputs.write_ply(painted_ball(), tmp_path / "cloud.ply")
    for choice, there in ((0, True), (2, False)):
        meshes.load_new_mesh(str(cloud))
        meshes.apply_filter(input_hosts.PYTHON_NAME, target_vertices=200, vertex_color=choice)
        assert meshes.current_mesh().has_vertex_color() == there
        if there:
            assert_counter_colors(meshes.current_mesh())


@FULL
def test_the_example_gives_a_coarse_mesh_the_colours_of_all_points(site, pymeshlab, meshes, tmp_path):
    """Stripes that are a third as wide as its edges are long, and finer than its vertex colours."""
    points = inputs.ball(40_000)
    striped = np.modf(points[:, 2] * 20 + 20)[0] < .5
    colors = np.where(striped[:, None], [.9, .2, .1, 1], [.1, .3, .8, 1])
    meshes.add_mesh(pymeshlab.Mesh(points, v_color_matrix=colors))
    meshes.save_current_mesh(str(tmp_path / "cloud.ply"), save_vertex_color=True)
    (tmp_path / "out").mkdir()
    done = programs.python(site, EXAMPLE, "cloud.ply", "out/mesh.obj", 300, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    meshes.load_new_mesh(str(tmp_path / "out/mesh.obj"))
    mesh = meshes.current_mesh()
    assert mesh.vertex_number() == 300 and mesh.textures()
    texture = np.asarray(Image.open(tmp_path / "out/mesh.png").convert("RGB"))
    height = mesh.vertex_matrix()[mesh.face_matrix()][:, :, 2].mean(1) * 20 + 20
    u, v = mesh.wedge_tex_coord_matrix().reshape(-1, 3, 2).mean(1).T
    found = texture[((1 - v) * len(texture)).astype(int), (u * len(texture)).astype(int)]
    within = np.abs(np.modf(height * 2)[0] - .5) < .3  # not at a border of stripes
    assert ((found[:, 0] > found[:, 2]) == (np.modf(height)[0] < .5))[within].mean() > .95
