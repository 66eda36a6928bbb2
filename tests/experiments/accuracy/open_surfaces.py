# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Open surfaces with their clouds, and how far a mesh is from them: distances, boundary, topology, soundness.

Kinds of case: a closed model cut at a fixed place ("plane", "three", "sphere"), whose boundary is then known exactly; a
model with boundary as it is ("whole"); a closed model seen from one to three sides ("views 1" to "views 3"); a real
scan ("half"), of which a random half of the points is the cloud and the other half is the truth.
"""

from dataclasses import dataclass

import numpy as np
import pymeshlab
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

import evaluate
import models
import scans
from evaluate import rms
from shapes import area_of

SAMPLES = 40_000
BOUNDARY_SAMPLES = 4_000
CUTS = ("plane", "three", "sphere")


@dataclass
class Case:
    """A cloud and its truth: points to measure forward from, and a surface or a cloud to measure backward to."""

    cloud: np.ndarray
    points: np.ndarray
    surface: tuple  # vertices and faces; or all points of a real scan, and no faces
    area: float  # of the open surface, estimated for scans
    boundary: tuple = None  # vertices and faces of the open surface, where it is known


def clipped(vertices, faces, height):
    """The part of the mesh where height, given by vertex, is positive; the cut goes through the faces."""
    height = np.where(np.abs(height) < 1e-12, 1e-12, height)
    vertices, inside, new = list(vertices), height > 0, {}

    def crossing(a, b):
        edge = (min(a, b), max(a, b))
        if edge not in new:
            share = height[edge[0]] / (height[edge[0]] - height[edge[1]])
            new[edge] = len(vertices)
            vertices.append(vertices[edge[0]] + (vertices[edge[1]] - vertices[edge[0]]) * share)
        return new[edge]

    kept = []
    for face in faces:
        side = inside[face]
        if side.all():
            kept.append(tuple(face))
        elif side.any():
            alone = int(np.argmax(side) if side.sum() == 1 else np.argmin(side))
            a, b, c = face[alone], face[(alone + 1) % 3], face[(alone + 2) % 3]
            p, q = crossing(a, b), crossing(a, c)
            kept += [(a, p, q)] if side.sum() == 1 else [(b, c, p), (c, q, p)]
    used, faces = np.unique(np.array(kept), return_inverse=True)
    return np.array(vertices)[used], faces.reshape(-1, 3)


def cut(vertices, faces, kind):
    """The model without a quarter of its length (plane), its ends and a side (three), or a ball (sphere)."""
    low, high = vertices.min(0), vertices.max(0)
    axis = int(np.argmax(high - low))
    if kind == "sphere":
        centre = vertices[np.argmax(vertices @ np.array([.3, .5, .8]))]
        return clipped(vertices, faces, np.linalg.norm(vertices - centre, axis=1) - .14 * np.linalg.norm(high - low))
    unit = np.eye(3)
    planes = {"plane": [(unit[axis], .25)],
              "three": [(unit[axis], .2), (-unit[axis], .2), (unit[(axis + 1) % 3], .12)]}[kind]
    whole = vertices
    for normal, share in planes:
        heights = whole @ normal
        level = heights.min() + share * np.ptp(heights)
        vertices, faces = clipped(vertices, faces, vertices @ normal - level)
    return vertices, faces


def case_of(name, kind, noise, data, samples=200_000):
    """The case \\p kind of the model (or, for "half", the file of a real scan) called name; noise in % of the diagonal."""
    if kind == "half":
        return half_of_scan(name, noise)
    vertices, faces = models.load_model(name, data)
    if kind.startswith("views"):
        seen = scans.scan(vertices, faces, scans.Level(noise / 100, 0, 0, 0), views=int(kind.split()[1]))
        share = min(1, len(seen.seen) / scans.DENSE)
        chosen = np.random.default_rng(2).choice(len(seen.seen), SAMPLES)
        return Case(seen.points, seen.seen[chosen], (vertices, faces), share * area_of(vertices, faces))
    truth = (vertices, faces) if kind == "whole" else cut(vertices, faces, kind)
    points, _ = models.sample_surface(*truth, SAMPLES, np.random.default_rng(1))
    return Case(models.make_cloud(*truth, samples, noise=noise), points, truth, area_of(*truth), truth)


def points_of(path):
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.load_new_mesh(str(path))
    return meshes.current_mesh().vertex_matrix()


def spacing_of(cloud, points):
    """The median distance of the points from the nearest one at another place of the cloud, a cKDTree."""
    apart = cloud.query(points, k=8)[0]
    apart = np.where(apart > 0, apart, np.inf).min(1)
    return float(np.median(apart[np.isfinite(apart)]))


def half_of_scan(path, noise):
    points = points_of(path)
    rng = np.random.default_rng(3)
    points = points + rng.normal(size=points.shape) * noise / 100 * models.diagonal(points)
    learned = np.zeros(len(points), bool)
    learned[rng.choice(len(points), len(points) // 2, replace=False)] = True
    rest = points[~learned]
    spacing = spacing_of(cKDTree(points), points[::20])
    return Case(points[learned], rest[rng.choice(len(rest), min(SAMPLES, len(rest)), replace=False)],
                (points, np.empty((0, 3), int)), len(points) * 4 * spacing**2)


def boundary_edges(faces):
    """The edges with one face, and the number of all edges."""
    edges, uses = np.unique(np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), 1), axis=0,
                            return_counts=True)
    return edges[uses == 1], len(edges)


def loop_count(edges):
    if len(edges) == 0:
        return 0
    used, ends = np.unique(edges, return_inverse=True)
    ends = ends.reshape(-1, 2)
    joined = coo_matrix((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(len(used), len(used)))
    return connected_components(joined, directed=False)[0]


def points_on(vertices, edges, rng):
    """Points spread over the edges, and the length of all."""
    lengths = np.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1)
    chosen = edges[rng.choice(len(edges), BOUNDARY_SAMPLES, p=lengths / lengths.sum())]
    share = rng.random((BOUNDARY_SAMPLES, 1))
    return vertices[chosen[:, 0]] * (1 - share) + vertices[chosen[:, 1]] * share, lengths.sum()


def measure(vertices, faces, case):
    """The figures of a mesh, by name. Distances: RMS in % of the diagonal; boundary: in mean edges."""
    rng = np.random.default_rng(1)
    truth = case.surface[0] if case.boundary is None else case.boundary[0]
    percent, mean_edge = 100 / models.diagonal(truth), np.sqrt(4 / np.sqrt(3) * case.area / len(faces))
    points, _ = models.sample_surface(vertices, faces, SAMPLES, rng)
    forward = evaluate.distances(case.points, vertices, faces)
    backward = evaluate.distances(points, *case.surface)
    edges, edge_count = boundary_edges(faces)
    row = {"forward": percent * rms(forward), "backward": percent * rms(backward),
           "spurious": 100 * float((backward > mean_edge).mean()), "missing": 100 * float((forward > mean_edge).mean()),
           "loops": int(loop_count(edges)), "chi": int(len(np.unique(faces)) - edge_count + len(faces)),
           **evaluate.topology(vertices, faces)}
    if case.boundary is None:
        return row
    true_edges, true_edge_count = boundary_edges(case.boundary[1])
    row["true_loops"] = int(loop_count(true_edges))
    row["true_chi"] = int(len(truth) - true_edge_count + len(case.boundary[1]))
    if len(edges) and len(true_edges):
        ours, length = points_on(vertices, edges, rng)
        true, true_length = points_on(truth, true_edges, rng)
        row["to"] = float(cKDTree(ours).query(true)[0].mean() / mean_edge)
        row["from"] = float(cKDTree(true).query(ours)[0].mean() / mean_edge)
        row["length"] = float(length / true_length)
    return row
