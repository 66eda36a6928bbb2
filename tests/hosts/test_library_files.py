# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The mesh of neural_mesh.reconstruct() as files, and as objects of other modules."""

import types

import library_clouds
import numpy as np
import pytest

FEW = library_clouds.directions(500, 1)
FAST = {"target_vertices": 40, "settling_signals_per_vertex": 0}


@pytest.fixture(scope="module")
def painted(library):
    return library.reconstruct(FEW, colors=library_clouds.paint(FEW), **FAST)


def test_ply_is_what_pymeshlab_writes(painted, meshes, tmp_path):
    painted.save(tmp_path / "mesh.ply")
    meshes.add_mesh(painted.to_pymeshlab())
    meshes.save_current_mesh(str(tmp_path / "theirs.ply"), save_vertex_quality=True)
    theirs = (tmp_path / "theirs.ply").read_bytes().replace(b"comment VCGLIB generated\n", b"")
    assert (tmp_path / "mesh.ply").read_bytes() == theirs


@pytest.mark.parametrize("ending", ["ply", "obj"])
def test_files_hold_the_mesh(painted, meshes, tmp_path, ending):
    painted.save(tmp_path / f"mesh.{ending}")
    meshes.load_new_mesh(str(tmp_path / f"mesh.{ending}"))
    layer = meshes.current_mesh()
    assert np.array_equal(layer.vertex_matrix(), painted.vertices) and np.array_equal(layer.face_matrix(), painted.faces)
    assert np.array_equal(np.rint(layer.vertex_color_matrix()[:, :3] * 255), painted.colors)
    assert ending == "obj" or np.array_equal(layer.vertex_scalar_array(), painted.quality)


def test_other_endings_are_refused(painted, tmp_path):
    with pytest.raises(ValueError, match="must end in .ply or .obj"):
        painted.save(tmp_path / "mesh.stl")


def test_trimesh_gets_the_mesh(painted):
    pytest.importorskip("trimesh")  # not among the requirements of the tests; installs.py has it
    mesh = painted.to_trimesh()
    assert np.array_equal(mesh.vertices, painted.vertices) and np.array_equal(mesh.faces, painted.faces)
    assert mesh.is_watertight and mesh.volume > 0
    assert np.array_equal(mesh.visual.vertex_colors[:, :3], painted.colors)
    assert np.array_equal(mesh.vertex_attributes["quality"], painted.quality)


def test_meshes_of_other_modules_are_taken(library, painted):
    expected = library.counters(painted, FEW).quality
    for mesh in (types.SimpleNamespace(vertices=painted.vertices, faces=painted.faces.astype(np.int64)),  # as trimesh's
                 types.SimpleNamespace(vertices=painted.vertices, triangles=painted.faces)):  # as Open3D's
        assert np.array_equal(library.counters(mesh, FEW).quality, expected)
