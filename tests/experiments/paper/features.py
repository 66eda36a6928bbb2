#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Feature detection: the learned counters compared with analyses of the final mesh and of the cloud.

    features.py --learn build/tests/learn [--data FOLDER] [--out FOLDER]

Prints a table (markdown) and writes OUT/features.md and OUT/features.json. An interrupted run continues where it
stopped (OUT/features/rows.jsonl).

True features are the edges of the true mesh with an angle of more than 30 degrees between their faces. A vertex of
the result is a feature if its distance from one is at most half the mean length of the edges at the vertex. F1 is
given at the best threshold (found with the truth, for each model, noise level and measure) and, for the crease
measure, also at its default threshold of 1. Two columns are upper bounds: the *oracle* takes, for each vertex, the
largest angle between two of 400,000 true normals within half an edge; the *oracle mesh* analyses the final mesh with
the true normals of its faces.
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
from scipy.stats import rankdata

import import_paths  # noqa: F401
import cad_parts
import models
import paper_runs
from compare_accuracy import numbers, table

CREASE_DEGREES = 30
DEFAULT_THRESHOLD = 1.0
UTILITY = {"even": 1, "adaptive": 0}
STAGES = {"learned": False, "fitted": True}  # the parameter fit_to_points
MODELS = ("fandisk", "block", "crossed-cylinders", "half-filleted-cube", "filleted-cube")
CURVATURES = ("Mean Curvature", "RMS Curvature", "ABS Curvature")
NEIGHBOURS = (20, 40, 80)


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
        sharp = cosine < np.cos(np.radians(CREASE_DEGREES))
        self.middles, self.cosines = v[ends[sharp]].mean(axis=1), cosine[sharp]
        for a, b in v[ends[sharp]]:
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

    def dihedral(self, normals=None):
        """The largest angle at any edge, as 1 - cosine, of the faces or of other normals given for them."""
        n = unit_normals(self.positions, self.faces) if normals is None else normals
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


def surface_variation(points, places, neighbours):
    """Least eigenvalue over the trace of the covariance of the nearest points (Pauly et al. 2002)."""
    near = points[cKDTree(points).query(places, k=neighbours)[1]]
    near = near - near.mean(axis=1, keepdims=True)
    values = np.linalg.eigvalsh(np.einsum("vki,vkj->vij", near, near))
    return values[:, 0] / values.sum(axis=1)


class Oracle:
    """Normals of the true surface at 400,000 points."""

    def __init__(self, vertices, faces, samples=400_000):
        points, of_face = models.sample_surface(vertices, faces, samples, np.random.default_rng(20030105))
        self.tree, self.normals = cKDTree(points), unit_normals(vertices, faces)[of_face]

    def around(self, mesh):
        """For every vertex the largest 1 - cosine between the normal at one place and those within half an edge."""
        turn = np.zeros(len(mesh.positions))
        for i, near in enumerate(self.tree.query_ball_point(mesh.positions, 0.5 * mesh.edge_length())):
            if near:
                turn[i] = 1 - (self.normals[near] @ self.normals[near[0]]).min()
        return turn

    def turn(self, places, radius):
        """The largest angle in degrees between two true normals within radius of each place."""
        angles = []
        for near in self.tree.query_ball_point(places, radius):
            normals = self.normals[near[:300]]
            angles.append(np.degrees(np.arccos((normals @ normals.T).min().clip(-1, 1))) if len(near) else 0.0)
        return np.array(angles)

    def of_faces(self, mesh):
        return mesh.dihedral(self.normals[self.tree.query(mesh.positions[mesh.faces].mean(axis=1))[1]])


def best_f1(x, truth):
    order = np.argsort(-x, kind="stable")
    f1 = 2 * np.cumsum(truth[order]) / (np.arange(1, len(x) + 1) + truth.sum())
    return float(f1.max())


def f1_at(x, truth, threshold):
    found = x > threshold
    return float(2 * (found & truth).sum() / max(1, found.sum() + truth.sum()))


def roc_area(x, truth):
    positives, negatives = truth.sum(), (~truth).sum()
    return float((rankdata(x)[truth].sum() - positives * (positives + 1) / 2) / max(1, positives * negatives))


def measures_of(mesh, cloud, oracle):
    yield "eq 6 counter", mesh.eq6
    yield "dihedral", mesh.dihedral()
    yield "normal spread", mesh.spread()
    yield from mesh.curvatures()
    for k in NEIGHBOURS:
        yield f"cloud variation {k}", surface_variation(cloud, mesh.positions, k)
    yield "oracle", oracle.around(mesh)
    yield "oracle mesh", oracle.of_faces(mesh)


def judged(x, truth):
    return {"best": best_f1(x, truth), "roc": roc_area(x, truth)}


def judge(mesh, creases, cloud, oracle):
    """All figures of one mesh. Without creases in the truth: the share of vertices called features."""
    if creases.tree is None:
        return {"false positives": float((mesh.measure > DEFAULT_THRESHOLD).mean())}
    distance = creases.distance(mesh.positions)
    truth = distance <= 0.5 * mesh.edge_length()
    figures = {"features": float(truth.mean()),
               "crease measure": {"default": f1_at(mesh.measure, truth, DEFAULT_THRESHOLD),
                                  **judged(mesh.measure, truth)}}
    for name, x in measures_of(mesh, cloud, oracle):
        figures[name] = judged(x, truth)
    # "Half an edge" as half of the mean edge of the mesh, the same for all vertices.
    even = distance <= 0.5 * mesh.edge_length().mean()
    figures["by mean edge"] = {"default": f1_at(mesh.measure, even, DEFAULT_THRESHOLD),
                               "best": best_f1(mesh.measure, even), "dihedral": best_f1(mesh.dihedral(), even)}
    return figures


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
        points = models.make_cloud(*self.surface, self.options.samples, self.noise)
        models.save_ply(self.folder / "cloud.ply", points)
        return points

    @cached_property
    def truth(self):
        return Creases(*self.surface), self.cloud, Oracle(*self.surface)

    def learned(self, utility, fit):
        """The mesh, learned twice, once for each measure."""
        assert len(self.cloud)  # writes the file
        paths = [self.folder / f"mesh{measure}.ply" for measure in (0, 1)]
        for measure, path in enumerate(paths):
            paper_runs.learn(self.options.learn, self.folder / "cloud.ply", path, feature_measure=measure,
                             target_vertices=self.options.vertices, utility_counter=UTILITY[utility],
                             fit_to_points=int(fit))
        return Mesh.from_files(paths)

    def row(self, utility, fit):
        """The figures of one mesh."""
        mesh = self.learned(utility, STAGES[fit])
        return {"model": self.name, "noise": self.noise, "mesh": utility, "stage": fit, **judge(mesh, *self.truth)}

    def chamfer(self):
        """Whether the creases are edges of the true mesh: medians of the angle at an edge that counts as a crease, and
        of the turn of the surface within .5 % of the diagonal around it. None without creases."""
        creases, _, oracle = self.truth
        if creases.tree is None:
            return None
        some = np.random.default_rng(1).permutation(len(creases.middles))[:1000]
        return {"edge": float(np.median(np.degrees(np.arccos(creases.cosines[some].clip(-1, 1))))),
                "surface": float(np.median(oracle.turn(creases.middles[some], models.diagonal(self.surface[0]) / 200)))}


def all_rows(options):
    """The rows of the table, and per model what chamfer() found."""
    kept = paper_runs.Kept(options.out / "features" / "rows.jsonl", options.learn)
    rows, chamfers = [], {}
    for name in options.models:
        for noise in options.noise:
            case = Case(name, noise, options)
            try:
                if name not in chamfers:
                    chamfers[name] = kept.row(case.chamfer, name=name,
                                              surface=paper_runs.digest(case.surface[0].tobytes()))
                key = {"name": name, "noise": noise, "samples": options.samples, "vertices": options.vertices,
                       "surface": paper_runs.digest(case.surface[0].tobytes())}
                rows += [kept.row(partial(case.row, utility, fit), utility=utility, fit=fit, **key)
                         for utility in UTILITY for fit in STAGES]
            except models.ModelError as error:
                print(error, file=sys.stderr)
        print(f"{name}: done", file=sys.stderr, flush=True)
    return rows, chamfers


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


def best_of(row, names):
    return max(row[name]["best"] for name in names)


MESH_MEASURES = ("dihedral", "normal spread", *CURVATURES)
CLOUD_MEASURES = tuple(f"cloud variation {k}" for k in NEIGHBOURS)


def line_of(row):
    ours, final = row["crease measure"], best_of(row, MESH_MEASURES)
    mark = "" if ours["default"] >= final else " (short)"
    figures = [final, row["dihedral"]["best"], row["normal spread"]["best"], best_of(row, CURVATURES),
               best_of(row, CLOUD_MEASURES), row["oracle"]["best"], row["oracle mesh"]["best"],
               row["by mean edge"]["default"], row["by mean edge"]["dihedral"]]
    return [row["model"], row["mesh"], row["stage"], f"{row['noise']:g}", f"{ours['default']:.3f}{mark}",
            f"{ours['best']:.3f}", f"{ours['roc']:.3f}", f"{row['eq 6 counter']['best']:.3f}",
            *(f"{figure:.3f}" for figure in figures)]


def report(rows, chamfers):
    judged_rows = [row for row in rows if "crease measure" in row]
    text = [table(["model", "mesh", "stage", "noise %", "crease measure at 1", "at its best", "ROC area", "eq 6",
                   "best of the final mesh", "dihedral", "spread", "curvature", "cloud", "oracle", "oracle mesh",
                   "mean edge: at 1", "mean edge: dihedral"], map(line_of, judged_rows)), ""]
    for stage in STAGES:
        of_stage = [row for row in judged_rows if row["stage"] == stage]
        wins = sum(row["crease measure"]["default"] >= best_of(row, MESH_MEASURES) for row in of_stage)
        text.append(f"{stage}: at its threshold of 1 the crease measure is at least as good as the best final-mesh measure "
                    f"at its best threshold in {wins} of {len(of_stage)} cases.")
    for row in rows:
        if "false positives" in row:
            text.append(f"{row['model']}, {row['mesh']}, {row['stage']}, noise {row['noise']:g} %: no creases, "
                        f"{100 * row['false positives']:.2f} % of the vertices above 1.")
    for name, angles in chamfers.items():
        if angles:
            text.append(f"{name}: an edge that counts as a crease has {angles['edge']:.0f} degrees (median); the surface "
                        f"turns by {angles['surface']:.0f} within .5 % of the diagonal around it.")
    return "\n".join(text)


def parser_of(description, default_models):
    """The options that tables of features have in common."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", default=os.environ.get("NEURAL_MESH_DATA"), help="data folder")
    parser.add_argument("--models", type=numbers(str), default=default_models)
    parser.add_argument("--noise", type=numbers(float), default=(0, 0.1, 0.3, 0.6), help="%% of the diagonal")
    parser.add_argument("--samples", type=int, default=200_000)
    parser.add_argument("--vertices", type=int, default=5000)
    parser.add_argument("--out", type=Path, default=Path("out/figures"))
    return parser


def parse(arguments):
    parser = parser_of(__doc__, MODELS)
    parser.add_argument("--learn", required=True, help="the core as a program (target learn)")
    return parser.parse_args(arguments)


def main(arguments=None):
    options = parse(arguments)
    try:
        rows, chamfers = all_rows(options)
    except paper_runs.RunError as error:
        sys.exit(str(error))
    text = report(rows, chamfers)
    (options.out / "features.md").write_text(text + "\n")
    (options.out / "features.json").write_text(json.dumps(rows, indent=1))
    print(text)


if __name__ == "__main__":
    main()
