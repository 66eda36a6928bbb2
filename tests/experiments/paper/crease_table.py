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
import pymeshlab
from scipy.spatial import cKDTree

import features
from compare_accuracy import table

NEAR = 0.5  # of a mean edge
STEPS = 20  # points per mean edge along a line


def along(ends, step):
    """Points on the segments ends[:, 0] to ends[:, 1], at most step apart; each stands for the same length on its segment.
    Returns the points and those lengths."""
    points, lengths = [], []
    for a, b in ends:
        length = np.linalg.norm(b - a)
        count = max(1, int(np.ceil(length / step)))
        points.append(a + (b - a) * ((np.arange(count) + .5) / count)[:, None])
        lengths.append(np.full(count, length / count))
    return (np.vstack(points), np.concatenate(lengths)) if points else (np.empty((0, 3)), np.empty(0))


def sharp_edges(vertices, faces):
    """The edges with more than features.CREASE_DEGREES between their faces, as (n, 2, 3) places of ends."""
    ends, sides = features.inner_edges(faces)
    normals = features.unit_normals(vertices, faces)
    cosine = (normals[sides[:, 0]] * normals[sides[:, 1]]).sum(axis=1)
    return vertices[ends[cosine < np.cos(np.radians(features.CREASE_DEGREES))]]


def distances(points, mesh):
    """The distances of points from a mesh."""
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(*mesh))
    meshes.add_mesh(pymeshlab.Mesh(points))
    meshes.compute_scalar_by_distance_from_another_mesh_per_vertex(measuremesh=1, refmesh=0, signeddist=False)
    return np.abs(meshes.current_mesh().vertex_scalar_array())


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


def true_creases(vertices, faces, step):
    v, index = np.unique(np.round(vertices, 9), axis=0, return_inverse=True)
    f = index.ravel()[faces]
    n = np.cross(v[f[:, 1]] - v[f[:, 0]], v[f[:, 2]] - v[f[:, 0]])
    return along(sharp_edges(v, f[np.linalg.norm(n, axis=1) > 1e-14]), step)


def row_of(name, noise, surface, cloud, vertices):
    mesh = features.learned_mesh(cloud, vertices)
    edge = float(np.linalg.norm(mesh.positions[mesh.ends[:, 0]] - mesh.positions[mesh.ends[:, 1]], axis=1).mean())
    truth = true_creases(*surface, edge / STEPS)
    bevel = distances(truth[0], (mesh.positions, mesh.faces))
    lines = list(features.learned(cloud, vertices, crease_lines=True))[-1]
    found = {"edges": sharp_edges(mesh.positions, mesh.faces), "lines": lines.vertex_matrix()[lines.edge_matrix()]}
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
