#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""What selects features best: the two learned measures at the default threshold, and measures of the final mesh.

    features.py --learn build/tests/learn [--data FOLDER] [--out FOLDER]

True features are the edges of the true mesh with an angle of more than 30 degrees between their faces. A vertex of
the result is a feature if its distance from one is at most half the mean length of the edges at the vertex. Each
measure of the final mesh has one threshold for all models, the best for the noise level of the row; it is found with
the truth. Curvatures are multiplied by the mean edge of the mesh, so that the size of a model does not matter; the
counter is divided by its mean (eq 7). Prints the F1, mean over the models, and writes OUT/features.md and
OUT/features.json. Rows are kept in OUT/features, so an interrupted run continues where it stopped.
"""

import argparse
import json
import os
import sys
from functools import cached_property, partial
from pathlib import Path

import numpy as np
import pymeshlab
from scipy.spatial import cKDTree

import import_paths  # noqa: F401
import cad_parts
import models
import paper_runs
from compare_accuracy import numbers, table

CREASE_DEGREES = 30
MODELS = ("fandisk", "block", "l-block", "crossed-cylinders", "half-filleted-cube", "stepped-shaft", "plate-with-bores",
          "chamfered-wedge")
CURVATURES = ("Mean Curvature", "RMS Curvature", "ABS Curvature")
COUNTERS = "compute_scalar_by_neural_normal_counter_per_vertex"
REMESHING_ROUNDS = 8
THRESHOLDS = np.geomspace(1e-3, 1e2, 401)
DEFAULT = int(np.argmin(np.abs(np.log(THRESHOLDS))))  # the threshold of 1
LEARNED = ("crease measure", "normal counter")

def load(name, data):
    return cad_parts.PARTS[name]() if name in cad_parts.PARTS else models.load_model(name, data)


def unit_normals(vertices, faces):
    n = np.cross(vertices[faces[:, 1]] - vertices[faces[:, 0]], vertices[faces[:, 2]] - vertices[faces[:, 0]])
    return n / np.maximum(np.linalg.norm(n, axis=1, keepdims=True), 1e-300)


def inner_edges(faces):
    """The edges that two faces share, as vertex pairs, and those faces."""
    ends = np.sort(np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    owner = np.tile(np.arange(len(faces)), 3)
    order = np.lexsort(ends.T)
    ends, owner = ends[order], owner[order]
    i = np.flatnonzero((ends[1:] == ends[:-1]).all(axis=1))
    return ends[i], np.column_stack([owner[i], owner[i + 1]])


class Creases:
    """The creases of a true mesh, and the distance from them."""

    def __init__(self, vertices, faces):
        v, index = np.unique(np.round(vertices, 9), axis=0, return_inverse=True)
        f = index.ravel()[faces]
        n = np.cross(v[f[:, 1]] - v[f[:, 0]], v[f[:, 2]] - v[f[:, 0]])
        f = f[np.linalg.norm(n, axis=1) > 1e-14]
        ends, sides = inner_edges(f)
        n = unit_normals(v, f)
        cosine = (n[sides[:, 0]] * n[sides[:, 1]]).sum(axis=1)
        step = models.diagonal(v) / 4000
        points = []
        for a, b in v[ends[cosine < np.cos(np.radians(CREASE_DEGREES))]]:
            count = int(np.ceil(np.linalg.norm(b - a) / step)) + 1
            points.append(a + (b - a) * np.linspace(0, 1, count)[:, None])
        self.tree = cKDTree(np.vstack(points)) if points else None

    def distance(self, points):
        return self.tree.query(points)[0] if self.tree else np.full(len(points), np.inf)


class Mesh:
    """A mesh with its two counters, and the feature measures that use the mesh only."""

    def __init__(self, positions, faces, eq6, measure):
        """eq6, measure: the normal counter and the crease measure of each vertex."""
        self.positions, self.faces, self.eq6, self.measure = positions, faces, eq6, measure
        self.ends, self.sides = inner_edges(faces)
        self.valence = np.bincount(self.ends.ravel(), minlength=len(positions))

    @classmethod
    def from_files(cls, paths):
        """paths: the same mesh twice, with the normal counter and with the crease measure as its quality."""
        meshes = pymeshlab.MeshSet(verbose=False)
        for path in paths:
            meshes.load_new_mesh(str(path))
        one, other = meshes
        if not np.array_equal(one.vertex_matrix(), other.vertex_matrix()):
            raise paper_runs.RunError(f"{paths[0]} and {paths[1]} are different meshes: the feature measure changed more "
                                      "than the quality.")
        return cls(one.vertex_matrix(), one.face_matrix(), one.vertex_scalar_array(), other.vertex_scalar_array())

    def of_edges(self, values):
        """Mean over the edges at each vertex."""
        total = sum(np.bincount(self.ends[:, k], values, len(self.positions)) for k in (0, 1))
        return total / np.maximum(self.valence, 1)

    def edge_length(self):
        along = self.positions[self.ends[:, 0]] - self.positions[self.ends[:, 1]]
        return self.of_edges(np.linalg.norm(along, axis=1))

    def dihedral(self):
        """The largest angle at any edge, as 1 - cosine."""
        n = unit_normals(self.positions, self.faces)
        bend = 1 - (n[self.sides[:, 0]] * n[self.sides[:, 1]]).sum(axis=1)
        most = np.zeros(len(self.positions))
        for k in (0, 1):
            np.maximum.at(most, self.ends[:, k], bend)
        return most

    def spread(self):
        n = unit_normals(self.positions, self.faces)
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


def truth_of(mesh, creases):
    return creases.distance(mesh.positions) <= 0.5 * mesh.edge_length()


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


class Case:
    """A model with noise: its cloud and its true surface, both made on first use."""

    def __init__(self, name, noise, options):
        self.name, self.noise, self.options = name, noise, options
        self.folder = options.out / "features"

    @cached_property
    def surface(self):
        return load(self.name, self.options.data)

    @cached_property
    def cloud(self):
        path = self.folder / "cloud.ply"
        models.save_ply(path, models.make_cloud(*self.surface, self.options.samples, self.noise))
        return path

    def learned(self):
        """The mesh, learned twice, once for each measure."""
        paths = [self.folder / f"mesh{measure}.ply" for measure in (0, 1)]
        for measure, path in enumerate(paths):
            paper_runs.learn(self.options.learn, self.cloud, path, feature_measure=measure,
                             target_vertices=self.options.vertices)
        return Mesh.from_files(paths)


def kept_rows(row_of, options, file):
    """row_of(case) for every model and noise level; those that an earlier run has kept in the file are not made again."""
    kept = paper_runs.Kept(options.out / "features" / file, options.learn)
    rows = []
    for name in options.models:
        for noise in options.noise:
            case = Case(name, noise, options)
            rows.append(kept.row(partial(row_of, case), name=name, noise=noise, samples=options.samples,
                                 vertices=options.vertices))
        print(f"{name}: done", file=sys.stderr, flush=True)
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


def row_of(case):
    """The curves of one model at one noise level."""
    mesh = case.learned()
    truth = truth_of(mesh, Creases(*case.surface))
    return {"model": case.name, "noise": case.noise, "curves": {k: f1_curve(x, truth) for k, x in measures_of(mesh)}}


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
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--learn", required=True, help="the core as a program (target learn)")
    parser.add_argument("--data", default=os.environ.get("NEURAL_MESH_DATA"), help="data folder")
    parser.add_argument("--models", type=numbers(str), default=MODELS)
    parser.add_argument("--noise", type=numbers(float), default=noise, help="%% of the diagonal")
    parser.add_argument("--samples", type=int, default=200_000)
    parser.add_argument("--vertices", type=int, default=5000)
    parser.add_argument("--out", type=Path, default=Path("out/figures"))
    return parser.parse_args(arguments)


def write(options, name, text, rows):
    (options.out / f"{name}.md").write_text(text + "\n")
    (options.out / f"{name}.json").write_text(json.dumps(rows))
    print(text)


def main(arguments=None):
    options = parse(arguments)
    try:
        rows = kept_rows(row_of, options, "rows.jsonl")
    except paper_runs.RunError as error:
        sys.exit(str(error))
    write(options, "features", report(rows), rows)


if __name__ == "__main__":
    main()
