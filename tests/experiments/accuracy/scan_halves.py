#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Real scans learned from random halves of their points: is the topology the same, and are there spikes?

    scan_halves.py LEARN --data FOLDER [--clouds FILE,...] [--vertices 2000] [--halves 3] [--set KEY=VALUE]

LEARN is the program build/tests/learn. Prints a table (markdown): per half the components, the genus, the boundary
loops wider than 5 % of the diagonal, and the vertices farther than 3 local spacings from the cloud. The local spacing
is the distance of the nearest point of the cloud to its tenth neighbour, over 1.78: the edge of the square that each of
even points has. Far vertices are measured against all points. Those that are the nearest vertex of no point are told
apart: they span a closed hole or a bay of the boundary. So are those that stick out: farther from the cloud than the
mean length of their own edges. Where an edge has many spacings, a vertex half an edge off a bay counts as far.
"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pymeshlab
from scipy.spatial import cKDTree

import models
from compare_accuracy import numbers, table

SPACING_NEIGHBOUR, SPACING_FACTOR = 10, 1.78
WIDE = .05  # of the diagonal: narrower loops are not compared
SPIKE = 3  # local spacings
CLOUDS = ("cloud/pts_kitten_cgal.ply", "cloud/scan_bunny_bun000.ply", "cloud/scan_iron.ply",
          "cloud/pts_poste_france.ply", "cloud/pts_room_scan1.ply", "cloud/pts_building.ply")


def points_of(path):
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.load_new_mesh(str(path))
    return meshes.current_mesh().vertex_matrix()


def loop_widths(vertices, faces):
    """The bounding-box diagonals of the boundary loops."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    directed = {tuple(edge) for edge in edges.tolist()}
    follows = {a: b for a, b in directed if (b, a) not in directed}
    widths = []
    while follows:
        first, at = follows.popitem()
        loop = [first]
        while at in follows:
            loop.append(at)
            at = follows.pop(at)
        widths.append(models.diagonal(vertices[loop]))
    return np.array(widths)


def mean_edges(vertices, faces):
    """The mean length of each vertex's edges, those inside the surface counted twice."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    lengths, ends = np.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1), edges.ravel()
    sums = np.bincount(ends, weights=np.repeat(lengths, 2), minlength=len(vertices))
    return sums / np.maximum(np.bincount(ends, minlength=len(vertices)), 1)


class Cloud:
    def __init__(self, points):
        self.points, self.tree, self.diagonal = points, cKDTree(points), models.diagonal(points)

    def far(self, vertices, faces):
        """How many vertices are far; of these, are the nearest one of no point, and stick out; and the distance of the
        farthest in local spacings."""
        distance, nearest = self.tree.query(vertices)
        neighbours, _ = self.tree.query(self.points[nearest], k=[SPACING_NEIGHBOUR + 1])
        spacings = distance / np.maximum(neighbours[:, 0] / SPACING_FACTOR, 1e-9 * self.diagonal)
        _, winners = cKDTree(vertices).query(self.points)
        without_points = np.bincount(winners, minlength=len(vertices)) == 0
        far = spacings > SPIKE
        return (int(far.sum()), int((far & without_points).sum()),
                int((far & (distance > mean_edges(vertices, faces))).sum()), f"{spacings.max():.1f}")


def learned(options, points, name):
    folder = options.out / "halves"
    folder.mkdir(parents=True, exist_ok=True)
    cloud, mesh = folder / f"{name}-cloud.ply", folder / f"{name}.ply"
    models.save_ply(cloud, points)
    run = subprocess.run([options.learn, cloud, mesh, f"target_vertices={options.vertices}", *options.set],
                         capture_output=True, text=True, check=False)
    if run.returncode != 0:
        return None, run.stderr.strip()
    return json.loads(run.stdout), mesh


def row(options, name, cloud, half):
    points = cloud.points[np.random.default_rng(half).permutation(len(cloud.points))[:len(cloud.points) // 2]]
    report, mesh = learned(options, points, f"{Path(name).stem}-{half}")
    if report is None:
        return None, [name, half, mesh, *[""] * 6]
    vertices, faces = models.load_mesh(mesh)
    wide = int((loop_widths(vertices, faces) > WIDE * cloud.diagonal).sum())
    same = report["components"], report["genus"], wide
    return same, [name, half, *same, *cloud.far(vertices, faces)]


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("learn")
    parser.add_argument("--data", required=True, type=Path)
    parser.add_argument("--clouds", type=numbers(str), default=list(CLOUDS))
    parser.add_argument("--vertices", type=int, default=2000)
    parser.add_argument("--halves", type=int, default=3)
    parser.add_argument("--out", type=Path, default=Path("build/experiments"))
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="a parameter of ours")
    options = parser.parse_args(arguments)
    lines, stable = [], 0
    for name in options.clouds:
        cloud, found = Cloud(points_of(options.data / name)), set()
        for half in range(1, options.halves + 1):
            same, line = row(options, name, cloud, half)
            found.add(same)
            lines.append(line)
            print(*line, file=sys.stderr, flush=True)
        stable += len(found) == 1 and None not in found
    header = ["cloud", "half", "components", "genus", f"loops over {100 * WIDE:g} %", f"over {SPIKE} spacings away", "of no point",
              "stick out", "farthest, spacings"]
    print(table(header, lines))
    print(f"\n{stable} of {len(options.clouds)} clouds have the same topology from all halves.")


if __name__ == "__main__":
    main()
