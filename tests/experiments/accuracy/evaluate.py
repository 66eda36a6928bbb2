#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Measures the distance of a mesh from a true surface, and its topology.

    evaluate.py MESH TRUE [--samples 100000] [--json]

Lengths are percentages of the bounding-box diagonal of the true surface. "Forward" is true surface to mesh
(large where the mesh misses parts), "backward" mesh to true surface (large at webs and spikes). Distances are exact ones
from samples to the nearest triangle. The samples are uniform over the area with a fixed seed, so the results are
reproducible.
"""

import argparse
import json
import sys

import numpy as np
import pymeshlab
from scipy.spatial import cKDTree

import models

SAMPLES = 100_000
NORMAL_SAMPLES = 20_000


class Truth:
    """A true surface with its samples, made once and used for many meshes."""

    def __init__(self, vertices, faces, samples=SAMPLES):
        self.vertices, self.faces, self.samples = vertices, faces, samples
        self.diagonal = models.diagonal(vertices)
        self.points, of_face = models.sample_surface(vertices, faces, samples, np.random.default_rng(20030101))
        self.normals = face_normals(vertices, faces)[of_face]


def face_normals(vertices, faces):
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), np.finfo(float).tiny)


def rms(lengths):
    return float(np.sqrt(np.mean(lengths**2)))


def distances(points, vertices, faces):
    """Of points from the nearest face, or from the nearest vertex if there are no faces."""
    if len(faces) == 0:
        return cKDTree(vertices).query(points)[0]
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(vertices, faces))
    meshes.add_mesh(pymeshlab.Mesh(points))
    # By default, points farther away than half a diagonal count as that far.
    meshes.compute_scalar_by_distance_from_another_mesh_per_vertex(
        measuremesh=1, refmesh=0, signeddist=False,
        maxdist=pymeshlab.PureValue(1e3 * models.diagonal(np.vstack([points, vertices]))))
    return np.abs(meshes.mesh(1).vertex_scalar_array())


def both_ways(vertices, faces, truth):
    """The distances of the true surface's samples from the mesh, and of the mesh's samples from the true surface, in %
    of the diagonal: ((points, distances), (points, distances)), and the faces of the latter."""
    points, of_face = models.sample_surface(vertices, faces, truth.samples, np.random.default_rng(20030102))
    percent = 100 / truth.diagonal
    return ((truth.points, percent * distances(truth.points, vertices, faces)),
            (points, percent * distances(points, truth.vertices, truth.faces))), of_face


def evaluate(vertices, faces, truth):
    """All measures of one mesh, as a dictionary. Raises ValueError for a mesh without faces or with NaN."""
    if len(faces) == 0:
        raise ValueError("The mesh has no faces, so there is nothing to compare.")
    if not np.isfinite(vertices).all():
        raise ValueError("The mesh has vertices whose coordinates are not finite numbers.")
    ((_, forward), (points, backward)), of_face = both_ways(vertices, faces, truth)
    result = {"forward_rms": rms(forward), "forward_max": float(forward.max()),
              "backward_rms": rms(backward), "backward_max": float(backward.max()),
              "sum_rms": rms(forward) + rms(backward)}
    result["normal_error"], result["inside_out"] = _normal_error(truth, points, face_normals(vertices, faces)[of_face])
    valence = np.bincount(faces.ravel(), minlength=len(vertices))
    return {**result, **topology(vertices, faces), "valence_5_to_7": float(np.mean((valence >= 5) & (valence <= 7)))}


def _normal_error(truth, points, normals):
    """Mean angle in degrees between the true normal and that of the mesh's sample next to it, and whether the mesh is
    inside out, in which case the angle is that of the mesh turned over."""
    # Every few-th sample of the truth is enough for a mean; the mesh keeps all its samples, for nearness.
    step = max(1, truth.samples // NORMAL_SAMPLES)
    _, nearest = cKDTree(points).query(truth.points[::step])
    cosine = np.einsum("ij,ij->i", truth.normals[::step], normals[nearest])
    angle = float(np.degrees(np.arccos(cosine.clip(-1, 1))).mean())
    return min(angle, 180 - angle), angle > 90


def topology(vertices, faces):
    """Counts of a mesh, whether it is a manifold whose faces agree in orientation, and how many faces cut others."""
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(vertices, faces))
    measures = meshes.get_topological_measures()
    meshes.compute_selection_by_self_intersections_per_face()
    directed = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    return {
        "vertices": measures["vertices_number"] - measures["unreferenced_vertices"],
        "faces": measures["faces_number"],
        "components": measures["connected_components_number"],
        "genus": measures["genus"],  # -1: not a manifold, so there is none
        "boundary_loops": measures["number_holes"],
        "boundary_edges": measures["boundary_edges"],
        "manifold": bool(measures["is_mesh_two_manifold"]),
        "oriented": len(np.unique(directed, axis=0)) == len(directed),
        "self_intersecting_faces": meshes.current_mesh().selected_face_number(),
    }


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh", help="the mesh to judge")
    parser.add_argument("true", help="the true surface: a mesh file, or the name of a model of models.py")
    parser.add_argument("--samples", type=int, default=SAMPLES, help="per direction (default %(default)s)")
    parser.add_argument("--data", help="data folder for models by name (default: NEURAL_MESH_DATA)")
    parser.add_argument("--json", action="store_true", help="print JSON")
    options = parser.parse_args(arguments)
    try:
        named = options.true in models.MODELS
        surface = models.load_model(options.true, options.data) if named else models.load_mesh(options.true)
        result = evaluate(*models.load_mesh(options.mesh), Truth(*surface, options.samples))
    except (models.ModelError, ValueError) as error:
        sys.exit(str(error))
    if options.json:
        print(json.dumps(result))
        return
    for key, value in result.items():
        print(f"{key:24} {value:.5f}" if isinstance(value, float) else f"{key:24} {value}")


if __name__ == "__main__":
    main()
