#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The geometry of creases: how far the true creases are from the mesh, and whether its sharp edges follow them.

    crease_table.py --plugin LIBRARY.so [--data FOLDER]

True creases are the edges of the true mesh with more than 30 degrees between their faces, as in features.py. Lengths
are in mean edges of the result.
- bevel: the distance of the true creases from the mesh, mean
- recall: the share of the length of the true creases with a sharp edge (more than 30 degrees) within half a mean edge
- precision: the share of the length of the sharp edges within half a mean edge of a true crease
The same of the crease lines that the filter makes: recall, precision and their distance from the creases, both ways
(means). """

import numpy as np
from scipy.spatial import cKDTree

import features
from compare_accuracy import table
from evaluate import distances
from features import along

NEAR = 0.5  # of a mean edge
STEPS = 20  # points per mean edge along a line


def shares(truth, found, edge):
    """Recall and precision of segments, and the mean distances of the true ones from those found and back; the latter in
    edges. Both as (points, lengths)."""
    if len(found[0]) == 0:
        return {"recall": 0.0, "precision": 1.0, "missed": float("nan"), "strayed": float("nan")}
    there, back = cKDTree(found[0]).query(truth[0])[0], cKDTree(truth[0]).query(found[0])[0]
    return {"recall": float(np.average(there <= NEAR * edge, weights=truth[1])),
            "precision": float(np.average(back <= NEAR * edge, weights=found[1])),
            "missed": float(np.average(there, weights=truth[1]) / edge),
            "strayed": float(np.average(back, weights=found[1]) / edge)}


def row_of(name, noise, surface, cloud, vertices):
    mesh = features.learned_mesh(cloud, vertices)
    edge = float(np.linalg.norm(mesh.positions[mesh.ends[:, 0]] - mesh.positions[mesh.ends[:, 1]], axis=1).mean())
    truth = along(features.true_creases(*surface), edge / STEPS)
    bevel = distances(truth[0], mesh.positions, mesh.faces)
    lines = list(features.learned(cloud, vertices, crease_lines=True))[-1]
    found = {"edges": features.sharp_edges(mesh.positions, mesh.faces), "lines": lines.vertex_matrix()[lines.edge_matrix()]}
    return {"model": name, "noise": noise, "bevel": float(np.average(bevel, weights=truth[1]) / edge),
            **{kind: shares(truth, along(ends, edge / STEPS), edge) for kind, ends in found.items()}}


def line_of(row):
    return [row["model"], f"{row['noise']:g}", f"{row['bevel']:.4f}",
            *(f"{row[kind][key]:.3f}" for kind in ("edges", "lines")
              for key in ("recall", "precision", "missed", "strayed"))]


if __name__ == "__main__":
    print(table(["model", "noise %", "bevel", "sharp edges: recall", "precision", "missed by", "strayed by",
                 "crease lines: recall", "precision", "missed by", "strayed by"],
                map(line_of, features.rows_of(row_of, features.parse(None, __doc__, noise=(0, 0.1))))))
