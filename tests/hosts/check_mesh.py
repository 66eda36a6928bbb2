# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The measures of a mesh file by pymeshlab: size, topology, volume, and distances from a surface or a cloud."""

import models
import numpy as np
import pymeshlab
from scipy.spatial import cKDTree

SAMPLES = 200_000
_kept = []  # a MeshSet that is deleted after a filter has failed crashes later


def check_mesh(mesh, reference=None):
    """A dictionary. With a reference, RMS and largest distances both ways in % of its diagonal, from points or, of a surface,
    from samples."""
    vertices, faces, layer, meshes = _loaded(mesh)
    found = {"vertices": len(vertices), "faces": len(faces), "quality": layer.has_vertex_scalar(),
             "color": layer.has_vertex_color(), "selected": int(layer.vertex_selection_array().sum())}
    if len(faces):
        measures = meshes.get_topological_measures()
        a, b, c = np.moveaxis((vertices - vertices.mean(axis=0))[faces], 1, 0)
        directed = np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
        found.update(
            watertight=measures["boundary_edges"] == measures["non_two_manifold_edges"] == 0,
            non_manifold_edges=measures["non_two_manifold_edges"], non_manifold_vertices=measures["non_two_manifold_vertices"],
            oriented=len(np.unique(directed, axis=0)) == len(directed), genus=measures["genus"],
            components=measures["connected_components_number"], boundary_loops=measures["number_holes"],
            unreferenced_vertices=measures["unreferenced_vertices"], volume=np.einsum("ij,ij->", a, np.cross(b, c)) / 6)
    if reference:
        here, there = (vertices, faces), _loaded(reference)[:2]
        per_cent = 100 / models.diagonal(there[0])
        for name, distances in (("to_mesh", _distances(there, here)), ("to_reference", _distances(here, there))):
            found[f"rms_{name}"] = per_cent * np.sqrt(np.mean(distances**2))
            found[f"max_{name}"] = per_cent * distances.max()
    return found


def _loaded(path):
    _kept.append(pymeshlab.MeshSet(verbose=False))
    _kept[-1].load_new_mesh(str(path))
    layer = _kept[-1].current_mesh()
    return layer.vertex_matrix(), layer.face_matrix(), layer, _kept[-1]


def _distances(one, other):
    """Of the points, or samples of the surface, `one` from the surface or the points `other`."""
    points = models.sample_surface(*one, SAMPLES, np.random.default_rng(1))[0] if len(one[1]) else one[0]
    if not len(other[1]):
        return cKDTree(other[0]).query(points)[0]
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(*other))
    meshes.add_mesh(pymeshlab.Mesh(points))
    meshes.compute_scalar_by_distance_from_another_mesh_per_vertex(
        measuremesh=1, refmesh=0, signeddist=False, maxdist=pymeshlab.PureValue(1e3 * models.diagonal(np.vstack([points, other[0]]))))
    return np.abs(meshes.current_mesh().vertex_scalar_array())
