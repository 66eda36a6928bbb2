#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Meshes of things with thin walls: topology, self-intersections and errors.

    wall_table.py --learn LEARN [--shapes cup slab ...] [--walls .6 1 2] [--points 200000] [--noise 0]
                  [--vertices 5000] [--seeds 1] [parameter=value ...]

LEARN is the program tests/experiments/tools/learn.cpp. Walls are given in mean edges of an even mesh of as many
vertices. "cut" is the share of faces that others cut, "turned" that of faces whose normal is more than 90 degrees from
those of the surface next to them; both in %. Errors are those of evaluate.py.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

import evaluate
import models
import open_surfaces
import wall_shapes


def mean_edge(surface, count):
    """Edge of an even mesh of that surface with 2 count faces."""
    return np.sqrt(4 / np.sqrt(3) * open_surfaces.area_of(*surface) / (2 * count))


def walled(make, edges, count):
    """The shape whose wall is that many mean edges thick, which depends on its area, which depends on the wall."""
    wall = .03
    for _ in range(4):
        wall = edges * mean_edge(make(wall), count)
    return make(wall), wall


def turned(vertices, faces, truth):
    """Share of the faces, in %, whose normal is more than 90 degrees from those of all samples of the surface next to
    them. Several samples are asked, since at a crease the nearest one may be on the other side of it."""
    centres, normals = vertices[faces].mean(axis=1), evaluate.face_normals(vertices, faces)
    _, near = cKDTree(truth.points).query(centres, k=8)
    cosines = np.einsum("ikj,ij->ik", truth.normals[near], normals)
    return 100 * float(np.mean(cosines.max(axis=1) < 0))


def measured(mesh, truth):
    result = evaluate.evaluate(*mesh, truth)
    result["cut"] = 100 * result["self_intersecting_faces"] / result["faces"]
    result["turned"] = turned(*mesh, truth)
    return result


def learned(learn, cloud, parameters, folder):
    models.save_ply(folder / "in.ply", cloud)
    done = subprocess.run([learn, folder / "in.ply", folder / "out.ply", *parameters], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr)
    return models.load_mesh(folder / "out.ply"), json.loads(done.stdout)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--learn", required=True)
    parser.add_argument("--shapes", nargs="+", default=list(wall_shapes.WALLS), choices=list(wall_shapes.WALLS))
    parser.add_argument("--walls", nargs="+", type=float, default=[.6, 1, 2])
    parser.add_argument("--points", type=int, default=200_000)
    parser.add_argument("--noise", type=float, default=0, help="%% of the diagonal")
    parser.add_argument("--vertices", type=int, default=5000)
    parser.add_argument("--seeds", nargs="+", type=int, default=[1])
    options, parameters = parser.parse_known_args()
    print(f"{'':14} {'edges':>5} {'spacings':>8} {'genus':>5} {'parts':>5} {'loops':>5} {'cut':>6} {'turned':>6} "
          f"{'forward':>8} {'backward':>8} {'back max':>8} {'seconds':>7}")
    for name in options.shapes:
        make, genus, components = wall_shapes.WALLS[name]
        for edges in options.walls:
            surface, wall = walled(make, edges, options.vertices)
            truth = evaluate.Truth(*surface)
            for seed in options.seeds:
                cloud = models.make_cloud(*surface, options.points, options.noise, seed)
                spacings = wall / np.sqrt(open_surfaces.area_of(*surface) / len(cloud))
                with tempfile.TemporaryDirectory() as folder:
                    mesh, report = learned(
                        options.learn, cloud, [f"target_vertices={options.vertices}", f"random_seed={seed}", *parameters],
                        Path(folder))
                m = measured(mesh, truth)
                right = "" if m["genus"] == genus and m["components"] == components else " wrong"
                print(f"{name:14} {edges:5.2f} {spacings:8.1f} {m['genus']:5} {m['components']:5} "
                      f"{m['boundary_loops']:5} {m['cut']:6.2f} {m['turned']:6.2f} {m['forward_rms']:8.4f} "
                      f"{m['backward_rms']:8.4f} {m['backward_max']:8.3f} {report['seconds']:7.2f}{right}", flush=True)


if __name__ == "__main__":
    main()
