#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Feature detection: what learning knows against every analysis of the final mesh and of the cloud.

    features.py --program FEATURES [--data FOLDER] [--out FOLDER]

FEATURES is features.cpp, built. Prints a table (markdown) and writes OUT/features.md and OUT/features.json.

Truth: the edges of the true mesh with an angle of more than 30 degrees between their faces. A vertex of the
result is a feature if it lies within half a mean length of its own edges from one. F1 is given at the best
threshold (for each model, noise level and measure its own, found with the truth) and, for the feature statistic,
at its one default of 1.
"""

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pymeshlab
from scipy.spatial import cKDTree
from scipy.stats import rankdata

import models

CREASE_DEGREES = 30
DEFAULT_THRESHOLD = 1.0
UTILITY = {"even": 1, "adaptive": 0}
CURVATURES = ("Mean Curvature", "RMS Curvature", "ABS Curvature")
NEIGHBOURS = (20, 40, 80)


def half_filleted_cube(fillet=0.2):
    """The cube [-1, 1]^3 with the four upright edges rounded by a radius of fillet, the others sharp."""
    arc = np.linspace(0, np.pi / 2, 25)
    corners = ((1, 1, 0), (-1, 1, np.pi / 2), (-1, -1, np.pi), (1, -1, 1.5 * np.pi))
    outline = np.vstack([np.column_stack([x * (1 - fillet) + fillet * np.cos(arc + start),
                                          y * (1 - fillet) + fillet * np.sin(arc + start)])
                         for x, y, start in corners])
    n = len(outline)
    k, k1 = np.arange(n), (np.arange(n) + 1) % n
    v = np.vstack([np.column_stack([outline, np.full(n, z)]) for z in (-1, 1)] + [[[0, 0, -1], [0, 0, 1]]])
    f = [(k, k1, n + k1), (k, n + k1, n + k), (np.full(n, 2 * n), k1, k),
         (np.full(n, 2 * n + 1), n + k, n + k1)]
    return v, np.vstack([np.column_stack(part) for part in f])


def load(name, data):
    return half_filleted_cube() if name == "half-filleted-cube" else models.load_model(name, data)


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
    """The creases of a true mesh; distance() from them."""

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
    """A result as features.cpp writes it, and what can be said of its vertices from it alone."""

    def __init__(self, path):
        rows = [line.split() for line in Path(path).read_text().splitlines()]
        table = np.array([row[1:] for row in rows if row[0] == "v"], dtype=float)
        self.positions, self.eq6, self.statistic = table[:, :3], table[:, 3], table[:, 4]
        self.faces = np.array([row[1:] for row in rows if row[0] == "f"], dtype=int)
        self.ends, self.sides = inner_edges(self.faces)
        self.valence = np.bincount(self.ends.ravel(), minlength=len(table))

    def of_edges(self, values):
        """Mean over the edges at each vertex."""
        total = sum(np.bincount(self.ends[:, k], values, len(self.positions)) for k in (0, 1))
        return total / np.maximum(self.valence, 1)

    def edge_length(self):
        along = self.positions[self.ends[:, 0]] - self.positions[self.ends[:, 1]]
        return self.of_edges(np.linalg.norm(along, axis=1))

    def dihedral(self):
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


def surface_variation(points, places, neighbours):
    """Least eigenvalue over the trace of the covariance of the nearest points (Pauly et al. 2002)."""
    near = points[cKDTree(points).query(places, k=neighbours)[1]]
    near = near - near.mean(axis=1, keepdims=True)
    values = np.linalg.eigvalsh(np.einsum("vki,vkj->vij", near, near))
    return values[:, 0] / values.sum(axis=1)


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


def measures_of(mesh, cloud):
    yield "eq 6 counter", mesh.eq6
    yield "dihedral", mesh.dihedral()
    yield "normal spread", mesh.spread()
    yield from mesh.curvatures()
    for k in NEIGHBOURS:
        yield f"cloud variation {k}", surface_variation(cloud, mesh.positions, k)


def judge(mesh, creases, cloud):
    """All figures of one mesh. Without creases in the truth: the share of vertices called features."""
    truth = creases.distance(mesh.positions) <= 0.5 * mesh.edge_length()
    if creases.tree is None:
        return {"false positives": float((mesh.statistic > DEFAULT_THRESHOLD).mean())}
    figures = {"features": float(truth.mean()),
               "statistic": {"default": f1_at(mesh.statistic, truth, DEFAULT_THRESHOLD),
                             "best": best_f1(mesh.statistic, truth), "roc": roc_area(mesh.statistic, truth)}}
    for name, x in measures_of(mesh, cloud):
        figures[name] = {"best": best_f1(x, truth), "roc": roc_area(x, truth)}
    return figures


def run(name, noise, utility, options):
    work = options.out / "features"
    work.mkdir(parents=True, exist_ok=True)
    vertices, faces = load(name, options.data)
    cloud = models.make_cloud(vertices, faces, options.samples, noise)
    ply = work / f"{name}-{noise:g}.ply"
    models.save_ply(ply, cloud)
    out = work / f"{name}-{noise:g}-{utility}"
    subprocess.run([options.program, ply, out, str(options.vertices), str(UTILITY[utility]),
                    str(options.settling)], check=True)
    creases = Creases(vertices, faces)
    rows = []
    for stage in ("learned", "fitted"):
        figures = judge(Mesh(f"{out}.{stage}"), creases, cloud)
        rows.append({"model": name, "noise": noise, "mesh": utility, "stage": stage, **figures})
    return rows


def best_of(row, names):
    return max(row[name]["best"] for name in names)


MESH_MEASURES = ("dihedral", "normal spread", *CURVATURES)
CLOUD_MEASURES = tuple(f"cloud variation {k}" for k in NEIGHBOURS)


def table(rows):
    lines = ["| model | mesh | stage | noise | statistic at 1 | at its best | ROC area | eq 6 | "
             "best of the final mesh | dihedral | spread | curvature | cloud |", "|---" * 13 + "|"]
    wins = count = 0
    for row in rows:
        if "false positives" in row:
            continue
        s, final = row["statistic"], best_of(row, MESH_MEASURES)
        count += 1
        wins += s["default"] >= final
        mark = "" if s["default"] >= final else " (short)"
        cells = [row["model"], row["mesh"], row["stage"], f"{row['noise']:g} %", f"{s['default']:.3f}{mark}",
                 f"{s['best']:.3f}", f"{s['roc']:.3f}", f"{row['eq 6 counter']['best']:.3f}", f"{final:.3f}",
                 f"{row['dihedral']['best']:.3f}", f"{row['normal spread']['best']:.3f}",
                 f"{best_of(row, CURVATURES):.3f}", f"{best_of(row, CLOUD_MEASURES):.3f}"]
        lines.append("| " + " | ".join(cells) + " |")
    lines.append("\nAt the default threshold the statistic is at least as good as the best final-mesh measure "
                 f"at its best threshold in {wins} of {count} cases.")
    none = [row for row in rows if "false positives" in row]
    for row in none:
        lines.append(f"{row['model']}, {row['mesh']}, {row['stage']}, noise {row['noise']:g} %: no creases, "
                     f"{100 * row['false positives']:.2f} % of the vertices above 1.")
    return "\n".join(lines)


def parse(arguments):
    def words(kind):
        return lambda text: [kind(word) for word in text.split(",") if word]

    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True, help="features.cpp, built")
    parser.add_argument("--data", default=os.environ.get("NEURAL_MESH_DATA"), help="data folder")
    parser.add_argument("--models", type=words(str), default=["fandisk", "block", "crossed-cylinders",
                                                               "half-filleted-cube", "filleted-cube"])
    parser.add_argument("--noise", type=words(float), default=[0, 0.1, 0.3, 0.6], help="%% of the diagonal")
    parser.add_argument("--samples", type=int, default=200_000)
    parser.add_argument("--vertices", type=int, default=5000)
    parser.add_argument("--settling", type=int, default=60, help="signals per vertex after growth")
    parser.add_argument("--out", type=Path, default=Path("build/experiments"))
    return parser.parse_args(arguments)


def main(arguments=None):
    options = parse(arguments)
    rows = []
    for name in options.models:
        for utility in UTILITY:
            for noise in options.noise:
                try:
                    rows += run(name, noise, utility, options)
                except models.ModelError as error:
                    print(error, file=sys.stderr)
    text = table(rows)
    (options.out / "features.md").write_text(text + "\n")
    (options.out / "features.json").write_text(json.dumps(rows, indent=1))
    print(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
