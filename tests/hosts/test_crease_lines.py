# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The layer with the creases of the mesh as lines, in every host: what it holds, and that the surface stays current."""

import input_hosts
import inputs
import library_hosts
import meshlabserver
import numpy as np
import pytest
from conftest import few_of

LABEL = "Neural Mesh creases"
SHIFT = (1e7, -1e7, 1e7)


def box(count=20_000, matrix=None, **parameters):
    """The surface of the cube [-1, 1]^3: 12 creases that meet at 8 corners."""
    random = np.random.default_rng(1)
    points = 2 * random.random((count, 3)) - 1
    points[np.arange(count), random.integers(0, 3, count)] = random.choice((-1, 1), count)
    return inputs.Input(points, target=400, matrix=np.eye(4) if matrix is None else matrix,
                        parameters={"crease_lines": True, **parameters})


def in_pymeshlab(pymeshlab, layer, folder):
    meshes = input_hosts.load(pymeshlab, layer, folder)
    report = meshes.apply_filter(inputs.RECONSTRUCTION, **layer.all_parameters())
    return meshes, report


def along_edges(points):
    """How far the points are from the nearest edge of the cube."""
    off = np.sort(np.abs(np.abs(points) - 1), axis=1)
    return np.hypot(off[:, 0], off[:, 1])


def test_a_cube_has_twelve_lines(pymeshlab, tmp_path):
    meshes, report = in_pymeshlab(pymeshlab, box(), tmp_path)
    assert [mesh.label() for mesh in meshes] == ["layer.ply", "Neural Mesh", LABEL]
    assert meshes.current_mesh().label() == "Neural Mesh" and report["vertices"] == 400
    lines = meshes.mesh(2)
    edges = lines.edge_matrix()
    assert lines.face_number() == 0 and len(edges) > 60 and report["crease_lines"] == 12
    degrees = np.bincount(edges.ravel(), minlength=lines.vertex_number())
    assert sorted(degrees[degrees != 2]) == [3] * 8
    assert along_edges(lines.vertex_matrix()).max() < .03
    length = np.linalg.norm(np.diff(lines.vertex_matrix()[edges], axis=1), axis=2).sum()
    assert abs(length - 24) < .3
    measure = lines.vertex_scalar_array()
    assert (measure > 0).all() and np.median(measure) > 1.5
    assert np.abs(np.abs([lines.bounding_box().min(), lines.bounding_box().max()]) - 1).max() < .03


def test_the_surface_does_not_depend_on_its_lines(pymeshlab, tmp_path):
    with_lines, without = (in_pymeshlab(pymeshlab, box(crease_lines=wanted), tmp_path)[0] for wanted in (True, False))
    assert len(list(with_lines)) == 3 and len(list(without)) == 2
    for read in ("vertex_matrix", "face_matrix", "vertex_scalar_array"):
        one, other = (getattr(meshes.mesh(1), read)() for meshes in (with_lines, without))
        assert np.array_equal(one, other)


def test_a_ball_has_no_such_layer(pymeshlab, tmp_path):
    layer = inputs.Input(inputs.ball(), parameters={"crease_lines": True})
    meshes, report = in_pymeshlab(pymeshlab, layer, tmp_path)
    assert len(list(meshes)) == 2 and report["crease_lines"] == 0


@pytest.mark.parametrize("release", few_of(library_hosts.RELEASES))
def test_the_libraries_get_the_same_lines(build, pymeshlab, tmp_path, release):
    layer = box(matrix=inputs.moved(*SHIFT))
    meshes, report = in_pymeshlab(pymeshlab, layer, tmp_path)
    outcome = input_hosts.in_library(build, release, layer, tmp_path, layers=4)
    assert outcome.unchanged and outcome.report["crease_lines"] == report["crease_lines"] == 12
    creases = outcome.report["creases"]
    assert creases["label"] == LABEL
    assert (creases["vertices"], creases["edges"]) == (meshes.mesh(2).vertex_number(), meshes.mesh(2).edge_number())
    assert tuple(np.array(creases["matrix"]).reshape(4, 4)[:3, 3]) == SHIFT == outcome.origin


def test_a_script_of_meshlabserver_saves_surface_and_lines(build, server, pymeshlab, tmp_path):
    layer = box()
    meshes, report = in_pymeshlab(pymeshlab, layer, tmp_path)
    script = meshlabserver.write_script(build, tmp_path / "script.mlx", **layer.all_parameters())
    surface, lines = tmp_path / "surface.ply", tmp_path / "lines.obj"  # its PLY files have no edges
    code, text = meshlabserver.run(server, "-i", inputs.write_ply(layer, tmp_path / "cloud.ply"), "-o", surface,
                                   "-o", lines, "-l", 2, "-s", script)
    assert code == 0, text
    assert meshlabserver.figures(text)["crease_lines"] == report["crease_lines"]
    saved = input_hosts.new_mesh_set(pymeshlab)
    saved.load_new_mesh(str(surface))
    assert saved.current_mesh().face_number() == report["faces"]
    saved.load_new_mesh(str(lines))
    assert np.array_equal(saved.current_mesh().edge_matrix(), meshes.mesh(2).edge_matrix())
    assert np.allclose(saved.current_mesh().vertex_matrix(), meshes.mesh(2).vertex_matrix(), atol=1e-5)


@pytest.mark.parametrize("release", few_of(library_hosts.RELEASES))
def test_out_of_memory_leaves_neither_layer_behind(build, tmp_path, release):
    quick = box(count=2000, settling_signals_per_vertex=0, start_mesh=1, fit_to_points=False)
    quick.target = 200
    file = inputs.write_layer(quick, tmp_path / "layer.txt")
    plugin = meshlabserver.plugin_path(build, f"meshlab-{release}")
    first, *starved = library_hosts.outcomes(
        library_hosts.run(build, release, plugin, file, tmp_path / "out.off", "memory"))
    assert first["layers"] == 4 and first["current"] == "Neural Mesh" and len(starved) > 200
    for index, outcome in enumerate(starved):
        expected = (2, "layer") if outcome["sentence"] else (4, "Neural Mesh")
        assert outcome["unchanged"] and (outcome["layers"], outcome["current"]) == expected, f"run {index}: {outcome}"
    assert sum(1 for outcome in starved if outcome["sentence"]) > len(starved) / 2
