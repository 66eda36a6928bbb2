# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The measures of a mesh file: size, topology, volume, and distances from a surface or a cloud."""

import evaluate
import models
import numpy as np
import pymeshlab

SAMPLES = 200_000


def check_mesh(mesh, reference=None):
    """A dictionary. With a reference, RMS and largest distances both ways in % of its diagonal, from points or, of a surface,
    from samples."""
    meshes = _loaded(mesh)
    layer = meshes.current_mesh()
    vertices, faces = layer.vertex_matrix(), layer.face_matrix()
    found = {"vertices": len(vertices), "quality": layer.has_vertex_scalar(), "color": layer.has_vertex_color(),
             "selected": int(layer.vertex_selection_array().sum())}
    if len(faces):
        a, b, c = np.moveaxis((vertices - vertices.mean(axis=0))[faces], 1, 0)
        found.update(evaluate.topology(vertices, faces), volume=np.einsum("ij,ij->", a, np.cross(b, c)) / 6)
        found["watertight"] = found["manifold"] and found["boundary_edges"] == 0
    if reference:
        others = _loaded(reference)  # which owns its layer
        true = others.current_mesh()
        here, there = (vertices, faces), (true.vertex_matrix(), true.face_matrix())
        for name, one, other in (("to_mesh", there, here), ("to_reference", here, there)):
            points = models.sample_surface(*one, SAMPLES, np.random.default_rng(1))[0] if len(one[1]) else one[0]
            distances = 100 / models.diagonal(there[0]) * evaluate.distances(points, *other)
            found[f"rms_{name}"], found[f"max_{name}"] = evaluate.rms(distances), distances.max()
    return found


def _loaded(path):
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.load_new_mesh(str(path))
    return meshes
