#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""What selects features best: the two learned measures at the default threshold, and measures of the final mesh.

    features.py --plugin LIBRARY.so [--data FOLDER]

True features are the edges of the true mesh with an angle of more than 30 degrees between their faces. A vertex of
the result is a feature if its distance from one is at most half the mean length of the edges at the vertex. Each
measure of the final mesh has one threshold for all models, the best for the noise level of the row; it is found with
the truth. Curvatures are multiplied by the mean edge of the mesh, so that the size of a model does not matter; the
counter is divided by its mean (eq 7). Prints the F1, mean over the models.
"""

import sys
from pathlib import Path

import numpy as np
import pymeshlab
from scipy.spatial import cKDTree

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "accuracy"))

import models  # noqa: E402
from compare_accuracy import note, numbers, parsed, parser, table  # noqa: E402
from evaluate import face_normals  # noqa: E402

CREASE_DEGREES = 30
MODELS = ("fandisk", "block", "crossed-cylinders", *models.CAD_PARTS)
CURVATURES = ("Mean Curvature", "RMS Curvature", "ABS Curvature")
RECONSTRUCTION = "generate_surface_reconstruction_neural_mesh"
COUNTERS = "compute_scalar_by_neural_normal_counter_per_vertex"
REMESHING_ROUNDS = 8
THRESHOLDS = np.geomspace(1e-3, 1e2, 401)
DEFAULT = int(np.argmin(np.abs(np.log(THRESHOLDS))))  # the threshold of 1
LEARNED = ("crease measure", "normal counter")


def inner_edges(faces):
    """The edges that two faces share, as vertex pairs, and those faces."""
    ends = np.sort(np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    owner = np.tile(np.arange(len(faces)), 3)
    order = np.lexsort(ends.T)
    ends, owner = ends[order], owner[order]
    i = np.flatnonzero((ends[1:] == ends[:-1]).all(axis=1))
    return ends[i], np.column_stack([owner[i], owner[i + 1]])


def sharp_edges(vertices, faces):
    """The edges with more than CREASE_DEGREES between their faces, as (n, 2, 3) places of ends."""
    ends, sides = inner_edges(faces)
    normals = face_normals(vertices, faces)
    cosine = (normals[sides[:, 0]] * normals[sides[:, 1]]).sum(axis=1)
    return vertices[ends[cosine < np.cos(np.radians(CREASE_DEGREES))]]


def true_creases(vertices, faces):
    """Those of a true mesh, whose vertices need not be merged."""
    v, index = np.unique(np.round(vertices, 9), axis=0, return_inverse=True)
    f = index.ravel()[faces]
    n = np.cross(v[f[:, 1]] - v[f[:, 0]], v[f[:, 2]] - v[f[:, 0]])
    return sharp_edges(v, f[np.linalg.norm(n, axis=1) > 1e-14])


def along(ends, step):
    """Points on the segments ends[:, 0] to ends[:, 1], at most step apart; each stands for the same length on its segment.
    Returns the points and those lengths."""
    points, lengths = [np.empty((0, 3))], [np.empty(0)]
    for a, b in ends:
        length = np.linalg.norm(b - a)
        count = max(1, int(np.ceil(length / step)))
        points.append(a + (b - a) * ((np.arange(count) + .5) / count)[:, None])
        lengths.append(np.full(count, length / count))
    return np.vstack(points), np.concatenate(lengths)


class Mesh:
    """A mesh with its two counters, and the feature measures that use the mesh only."""

    def __init__(self, positions, faces, eq6, measure):
        """eq6, measure: the normal counter and the crease measure of each vertex."""
        self.positions, self.faces, self.eq6, self.measure = positions, faces, eq6, measure
        self.ends, self.sides = inner_edges(faces)
        self.valence = np.bincount(self.ends.ravel(), minlength=len(positions))

    def of_edges(self, values):
        """Mean over the edges at each vertex."""
        total = sum(np.bincount(self.ends[:, k], values, len(self.positions)) for k in (0, 1))
        return total / np.maximum(self.valence, 1)

    def edge_length(self):
        along = self.positions[self.ends[:, 0]] - self.positions[self.ends[:, 1]]
        return self.of_edges(np.linalg.norm(along, axis=1))

    def dihedral(self):
        """The largest angle at any edge, as 1 - cosine."""
        n = face_normals(self.positions, self.faces)
        bend = 1 - (n[self.sides[:, 0]] * n[self.sides[:, 1]]).sum(axis=1)
        most = np.zeros(len(self.positions))
        for k in (0, 1):
            np.maximum.at(most, self.ends[:, k], bend)
        return most

    def spread(self):
        n = face_normals(self.positions, self.faces)
        total, count = np.zeros_like(self.positions), np.zeros(len(self.positions))
        for k in range(3):
            np.add.at(total, self.faces[:, k], n)
            np.add.at(count, self.faces[:, k], 1)
        return 1 - np.linalg.norm(total, axis=1) / np.maximum(count, 1)

    def curvatures(self):
        meshes = pymeshlab.MeshSet(verbose=False)
        meshes.add_mesh(pymeshlab.Mesh(self.positions, self.faces))
        for kind in CURVATURES:
            meshes.compute_scalar_by_discrete_curvature_per_vertex(curvaturetype=kind)
            yield kind, np.nan_to_num(np.abs(meshes.current_mesh().vertex_scalar_array()))


def truth_of(mesh, surface):
    """Which vertices of the mesh are features of the true surface."""
    creases = along(true_creases(*surface), models.diagonal(surface[0]) / 4000)[0]
    return cKDTree(creases).query(mesh.positions)[0] <= 0.5 * mesh.edge_length()


def noisy_mesh(surface, count, noise):
    """The true surface with about count evenly spaced vertices, moved by noise in % of the diagonal; creases stay."""
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(*surface))
    meshes.meshing_merge_close_vertices()
    area = meshes.get_geometric_measures()["surface_area"]
    edge = np.sqrt(2 * area / (np.sqrt(3) * count))  # of equilateral triangles, two per vertex
    meshes.meshing_isotropic_explicit_remeshing(iterations=REMESHING_ROUNDS, targetlen=pymeshlab.PureValue(edge),
                                                checksurfdist=False)
    vertices, faces = meshes.current_mesh().vertex_matrix(), meshes.current_mesh().face_matrix()
    spread = noise / 100 * models.diagonal(surface[0])
    return vertices + spread * np.random.default_rng(7).standard_normal(vertices.shape), faces


def counted(vertices, faces, cloud=None):
    """A given mesh with the counters by signals from the cloud, or from its faces."""
    meshes = pymeshlab.MeshSet(verbose=False)
    if cloud is not None:
        meshes.add_mesh(pymeshlab.Mesh(cloud))
    meshes.add_mesh(pymeshlab.Mesh(vertices, faces))
    values = []
    for measure in (0, 1):
        meshes.apply_filter(COUNTERS, signal_layer=0, feature_measure=measure)
        values.append(meshes.current_mesh().vertex_scalar_array().copy())
    return Mesh(vertices, faces, *values)


def learned(cloud, vertices, **parameters):
    """A MeshSet whose current mesh is learned from the cloud."""
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(cloud))
    meshes.apply_filter(RECONSTRUCTION, target_vertices=vertices, even_sampling=False, **parameters)
    return meshes


def learned_mesh(cloud, vertices):
    """The mesh, learned twice, once for each measure."""
    meshes = [learned(cloud, vertices, feature_measure=measure) for measure in (0, 1)]
    one, other = (each.current_mesh() for each in meshes)
    assert np.array_equal(one.vertex_matrix(), other.vertex_matrix()), "the measure changed more than the quality"
    return Mesh(one.vertex_matrix(), one.face_matrix(), one.vertex_scalar_array(), other.vertex_scalar_array())


def rows_of(row_of, options):
    """row_of(name, noise, surface, cloud, vertices) for every model and noise level."""
    pymeshlab.load_plugin(options.plugin)
    rows = []
    for name in options.models:
        surface = models.load_model(name, options.data)
        for noise in options.noise:
            cloud = models.make_cloud(*surface, options.samples, noise)
            rows.append(row_of(name, noise, surface, cloud, options.vertices))
            note(f"{name}, {noise:g} %: done")
    return rows


def f1_curve(values, truth):
    """F1 at each of THRESHOLDS."""
    found = np.sort(values)
    right = np.sort(values[truth])
    count = len(found) - np.searchsorted(found, THRESHOLDS, side="right")
    hits = len(right) - np.searchsorted(right, THRESHOLDS, side="right")
    return (2 * hits / np.maximum(1, count + truth.sum())).tolist()


def measures_of(mesh):
    yield "crease measure", mesh.measure
    yield "normal counter", mesh.eq6 / mesh.eq6.mean()
    yield "dihedral", mesh.dihedral()
    yield "normal spread", mesh.spread()
    edge = mesh.edge_length().mean()
    for kind, values in mesh.curvatures():
        yield kind, edge * values


def row_of(name, noise, surface, cloud, vertices):
    """The curves of one model at one noise level."""
    mesh = learned_mesh(cloud, vertices)
    truth = truth_of(mesh, surface)
    return {"model": name, "noise": noise, "curves": {k: f1_curve(x, truth) for k, x in measures_of(mesh)}}


def report(rows):
    names = list(rows[0]["curves"])
    lines = []
    for noise in sorted({r["noise"] for r in rows}):
        mean = {name: np.mean([r["curves"][name] for r in rows if r["noise"] == noise], axis=0) for name in names}
        lines.append([f"{noise:g}", *(f"{mean[name][DEFAULT]:.3f}" for name in LEARNED),
                      *(f"{mean[name].max():.3f}" for name in names)])
    return table(["noise %", *(f"{name} at 1" for name in LEARNED), *(f"{name} at its best" for name in names)], lines)


def parse(arguments, description=__doc__, noise=(0, 0.1, 0.3, 0.6)):
    """The options that tables of features have in common."""
    options = parser(description)
    options.add_argument("--noise", type=numbers(float), default=noise, help="%% of the diagonal")
    options.add_argument("--samples", type=int, default=200_000)
    options.add_argument("--vertices", type=int, default=5000)
    options.set_defaults(models=MODELS)
    return parsed(options, arguments)


if __name__ == "__main__":
    print(report(rows_of(row_of, parse(None))))
