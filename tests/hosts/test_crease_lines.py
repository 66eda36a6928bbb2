# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The layer with the creases of the mesh as lines, in every host: what it holds, and that the surface stays current."""

import input_hosts
import inputs
import meshlabserver
import numpy as np

LABEL = "Neural Mesh creases"


def box(count=20_000, **parameters):
    """The surface of the cube [-1, 1]^3: 12 creases that meet at 8 corners."""
    random = np.random.default_rng(1)
    points = 2 * random.random((count, 3)) - 1
    points[np.arange(count), random.integers(0, 3, count)] = random.choice((-1, 1), count)
    return inputs.Input(points, target=400, parameters={"crease_lines": True, **parameters})


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


def test_a_script_of_meshlabserver_saves_surface_and_lines(build, server, pymeshlab, tmp_path):
    layer = box()
    meshes, report = in_pymeshlab(pymeshlab, layer, tmp_path)
    script = meshlabserver.write_script(build, tmp_path / "script.mlx", **layer.all_parameters())
    surface, lines = tmp_path / "surface.ply", tmp_path / "lines.obj"  # its PLY files have no edges
    code, text = meshlabserver.run(server, "-i", inputs.write_ply(layer, tmp_path / "cloud.ply"), "-o", surface,
                                   "-o", lines, "-l", 2, "-s", script)
    assert code == 0, text
    assert meshlabserver.figures(text)["crease_lines"] == report["crease_lines"]
    assert "The mesh has 12 crease lines with 8 corners" in text
    saved = input_hosts.new_mesh_set(pymeshlab)
    saved.load_new_mesh(str(surface))
    assert saved.current_mesh().face_number() == report["faces"]
    saved.load_new_mesh(str(lines))
    assert np.array_equal(saved.current_mesh().edge_matrix(), meshes.mesh(2).edge_matrix())
    assert np.allclose(saved.current_mesh().vertex_matrix(), meshes.mesh(2).vertex_matrix(), atol=1e-5)
