#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The table of surfaces with boundary: boundaries, topology and distances, ours and the peers'.

    open_table.py LEARN [--data FOLDER] [--models NAME ...] [--counts N ...] [--seeds N] [--noise PERCENT] [--peers]

LEARN is the program build/tests/learn. Each closed model is cut by a plane, by three planes and by a sphere at fixed
places, so that its boundary is known exactly. 200,000 points are drawn from what is left; the filter gets only them.
Boundary distances are means between points on the boundary edges, in mean edges (those of an even mesh of the same
area and number of faces); "to" is from the true boundary, "from" to it. Spurious and missing area is farther than a
mean edge from the other surface. RMS distances are percentages of the diagonal of the true surface.
"""

import argparse
import json
import subprocess
import tempfile
from pathlib import Path

import numpy as np
import pymeshlab
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

import models
import peers
from accuracy_table import TABLE_MODELS

SAMPLES = 40_000
BOUNDARY_SAMPLES = 4_000
HEADER = ("| model | cut | method | vertices | boundary to / from | length | loops | chi | spurious / missing % | "
          "RMS forward / backward % |\n|---|---|---|---|---|---|---|---|---|---|")


def clipped(vertices, faces, height):
    """The part of the mesh where \\p height, given by vertex, is positive; the cut goes through the faces."""
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


def distances(points, vertices, faces):
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(vertices, faces))
    meshes.add_mesh(pymeshlab.Mesh(points))
    meshes.compute_scalar_by_distance_from_another_mesh_per_vertex(measuremesh=1, refmesh=0, signeddist=False)
    return np.abs(meshes.mesh(1).vertex_scalar_array())


def measure(vertices, faces, true_vertices, true_faces):
    """The figures of a row, by name."""
    rng = np.random.default_rng(1)
    diagonal = models.diagonal(true_vertices)
    true_points, _ = models.sample_surface(true_vertices, true_faces, SAMPLES, rng)
    points, _ = models.sample_surface(vertices, faces, SAMPLES, rng)
    corners = true_vertices[true_faces]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum() / 2
    mean_edge = np.sqrt(4 / np.sqrt(3) * area / len(faces))
    forward = distances(true_points, vertices, faces)
    backward = distances(points, true_vertices, true_faces)
    edges, edge_count = boundary_edges(faces)
    true_edges, true_edge_count = boundary_edges(true_faces)
    row = {"loops": loop_count(edges), "true_loops": loop_count(true_edges),
           "chi": len(np.unique(faces)) - edge_count + len(faces),
           "true_chi": len(true_vertices) - true_edge_count + len(true_faces),
           "spurious": 100 * (backward > mean_edge).mean(), "missing": 100 * (forward > mean_edge).mean(),
           "forward": 100 * np.sqrt((forward**2).mean()) / diagonal,
           "backward": 100 * np.sqrt((backward**2).mean()) / diagonal, "to": np.nan, "from": np.nan, "length": 0}
    if len(edges) and len(true_edges):
        ours, length = points_on(vertices, edges, rng)
        true, true_length = points_on(true_vertices, true_edges, rng)
        row["to"] = cKDTree(ours).query(true)[0].mean() / mean_edge
        row["from"] = cKDTree(true).query(ours)[0].mean() / mean_edge
        row["length"] = length / true_length
    return row


def learn(program, cloud, count, seed, out):
    done = subprocess.run([program, cloud, out, f"target_vertices={count}", f"random_seed={seed}"], check=True,
                          capture_output=True, text=True)
    report = json.loads(done.stdout)
    assert report["vertices"] == count, f"{report['vertices']} vertices instead of {count}"
    return models.load_mesh(out)


def peer(name, cloud, count):
    """Ball pivoting, or Screened Poisson without the faces far from the points; each decimated."""
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.load_new_mesh(str(cloud))
    if name == "ball pivoting":
        peers.reconstruct_ball_pivoting(meshes, count)
    else:
        points = cKDTree(meshes.current_mesh().vertex_matrix())
        peers.reconstruct_poisson(meshes, count)
        vertices, faces = meshes.current_mesh().vertex_matrix(), meshes.current_mesh().face_matrix()
        spacing = np.median(points.query(points.data[::50], k=2)[0][:, 1])
        near = points.query(vertices[faces].mean(1))[0] < 4 * spacing
        meshes.add_mesh(pymeshlab.Mesh(vertices, faces[near]))
    meshes.meshing_decimation_quadric_edge_collapse(targetfacenum=2 * count, preserveboundary=True)
    meshes.meshing_remove_unreferenced_vertices()
    return meshes.current_mesh().vertex_matrix(), meshes.current_mesh().face_matrix()


def line(model, kind, method, vertices, row):
    return (f"| {model} | {kind} | {method} | {vertices} | {row['to']:.2f} / {row['from']:.2f} | {row['length']:.2f} | "
            f"{row['loops']} of {row['true_loops']} | {row['chi']} of {row['true_chi']} | "
            f"{row['spurious']:.2f} / {row['missing']:.2f} | {row['forward']:.4f} / {row['backward']:.4f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("program")
    parser.add_argument("--data")
    parser.add_argument("--models", nargs="+", default=TABLE_MODELS)
    parser.add_argument("--counts", nargs="+", type=int, default=[500, 2000, 10000])
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--noise", type=float, default=0)
    parser.add_argument("--peers", action="store_true")
    options = parser.parse_args()
    print(HEADER, flush=True)
    right = total = 0
    with tempfile.TemporaryDirectory() as folder:
        cloud, out = Path(folder) / "cloud.ply", Path(folder) / "out.ply"
        for name in options.models:
            whole = models.load_model(name, options.data)
            for kind in ("plane", "three", "sphere"):
                truth = cut(*whole, kind)
                models.save_ply(cloud, models.make_cloud(*truth, noise=options.noise))
                for count in options.counts:
                    for seed in range(1, options.seeds + 1):
                        row = measure(*learn(options.program, cloud, count, seed, out), *truth)
                        total += 1
                        right += row["loops"] == row["true_loops"] and row["chi"] == row["true_chi"]
                        print(line(name, kind, "ours", count, row), flush=True)
                    for method in ("ball pivoting", "trimmed Poisson") if options.peers else ():
                        mesh = peer(method, cloud, count)
                        print(line(name, kind, method, len(mesh[0]), measure(*mesh, *truth)), flush=True)
    print(f"\nLoops and Euler characteristic right in {right} of {total} runs.")


if __name__ == "__main__":
    main()
