#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Measures the distance of a mesh from a true surface, and its topology.

    evaluate.py MESH TRUE [--samples 100000] [--json]

Lengths are percentages of the bounding-box diagonal of the true surface. "Forward" is true surface to mesh
(large where the mesh misses parts), "backward" mesh to true surface (large at webs and spikes). MeshLab's Hausdorff
filter gives the exact distance from each sample to the nearest triangle. The samples are uniform over the area with a
fixed seed, so the results are reproducible.
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


def _measured(vertices, faces, truth):
    """A MeshSet with the truth, its samples, those of the mesh, and the mesh, the samples with their distances; those
    samples and their faces; and the two reports."""
    points, of_face = models.sample_surface(vertices, faces, truth.samples, np.random.default_rng(20030102))
    meshes = pymeshlab.MeshSet(verbose=False)
    for mesh in (pymeshlab.Mesh(truth.vertices, truth.faces), pymeshlab.Mesh(truth.points), pymeshlab.Mesh(points),
                 pymeshlab.Mesh(vertices, faces)):
        meshes.add_mesh(mesh)
    # samplenum's default is the size of the current layer, not of the sampled one.
    every = {"samplevert": True, "samplenum": truth.samples, "maxdist": pymeshlab.PercentageValue(100)}
    forward = meshes.get_hausdorff_distance(sampledmesh=1, targetmesh=3, **every)
    backward = meshes.get_hausdorff_distance(sampledmesh=2, targetmesh=0, **every)
    return meshes, points, of_face, forward, backward


def distances(vertices, faces, truth):
    """The distances of the true surface's samples from the mesh, and of the mesh's samples from the true surface, in %
    of the diagonal: ((points, distances), (points, distances))."""
    meshes, points, *_ = _measured(vertices, faces, truth)
    percent = 100 / truth.diagonal
    return ((truth.points, meshes.mesh(1).vertex_scalar_array() * percent),
            (points, meshes.mesh(2).vertex_scalar_array() * percent))


def evaluate(vertices, faces, truth):
    """All measures of one mesh, as a dictionary. Raises ValueError for a mesh without faces or with NaN."""
    if len(faces) == 0:
        raise ValueError("The mesh has no faces, so there is nothing to compare.")
    if not np.isfinite(vertices).all():
        raise ValueError("The mesh has vertices whose coordinates are not finite numbers.")
    meshes, points, of_face, forward, backward = _measured(vertices, faces, truth)
    percent = 100 / truth.diagonal
    result = {
        "forward_rms": forward["RMS"] * percent,
        "forward_max": forward["max"] * percent,
        "backward_rms": backward["RMS"] * percent,
        "backward_max": backward["max"] * percent,
        "sum_rms": (forward["RMS"] + backward["RMS"]) * percent,
    }
    result["normal_error"], result["inside_out"] = _normal_error(truth, points, face_normals(vertices, faces)[of_face])
    # The filter silently drops samples beyond its search distance.
    if forward["n_samples"] != truth.samples or backward["n_samples"] != truth.samples:
        result["lost_samples"] = 2 * truth.samples - forward["n_samples"] - backward["n_samples"]
    meshes.set_current_mesh(3)
    result.update(_topology(meshes))
    valence = np.bincount(faces.ravel(), minlength=len(vertices))
    result["valence_5_to_7"] = float(np.mean((valence >= 5) & (valence <= 7)))
    return result


def _normal_error(truth, points, normals):
    """Mean angle in degrees between the true normal and that of the mesh's sample next to it, and whether the mesh is
    inside out, in which case the angle is that of the mesh turned over."""
    # Every few-th sample of the truth is enough for a mean; the mesh keeps all its samples, for nearness.
    step = max(1, truth.samples // NORMAL_SAMPLES)
    _, nearest = cKDTree(points).query(truth.points[::step])
    cosine = np.einsum("ij,ij->i", truth.normals[::step], normals[nearest])
    angle = float(np.degrees(np.arccos(cosine.clip(-1, 1))).mean())
    return min(angle, 180 - angle), angle > 90


def _topology(meshes):
    measures = meshes.get_topological_measures()
    meshes.compute_selection_by_self_intersections_per_face()
    return {
        "vertices": measures["vertices_number"] - measures["unreferenced_vertices"],
        "faces": measures["faces_number"],
        "components": measures["connected_components_number"],
        "genus": measures["genus"],  # -1: not a manifold, so there is none
        "boundary_loops": measures["number_holes"],
        "boundary_edges": measures["boundary_edges"],
        "manifold": bool(measures["is_mesh_two_manifold"]),
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
        vertices, faces = models.load_mesh(options.mesh)
        named = options.true in models.MODELS
        surface = models.load_model(options.true, options.data) if named else models.load_mesh(options.true)
        result = evaluate(vertices, faces, Truth(*surface, options.samples))
    except (models.ModelError, ValueError) as error:
        sys.exit(str(error))
    if options.json:
        print(json.dumps(result))
        return
    for key, value in result.items():
        print(f"{key:24} {value:.5f}" if isinstance(value, float) else f"{key:24} {value}")


if __name__ == "__main__":
    main()
