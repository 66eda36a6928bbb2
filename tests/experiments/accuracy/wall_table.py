#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Meshes of things with thin walls: topology, self-intersections and errors, beside the plain chain.

    wall_table.py --learn LEARN [--shapes cup slab ...] [--walls .6 1 2] [--points 200000] [--noise 0]
                  [--views 10] [--vertices 5000] [--seeds 1] [--chain] [parameter=value ...]

LEARN is the program tests/experiments/tools/learn.cpp. Walls are given in mean edges of an even mesh of as many
vertices. "cut" is the share of faces that others cut, "turned" that of faces whose normal is more than 90 degrees from
those of the surface next to them; both in %. Errors are those of evaluate.py. "plain chain" is normals, Screened Poisson
of depth 8 and quadric edge collapse. With --views the points are what that many virtual views see, with the noise along
the view; their spacing is that of as many even points.
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
import peers
import scans
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


def cloud_of(surface, options, seed):
    if not options.views:
        return models.make_cloud(*surface, options.points, options.noise, seed)
    level = scans.Level(options.noise / 100, 0, 0, 0)
    return scans.scan(*surface, level, views=options.views, seed=seed).points


def learned(learn, cloud, parameters, folder):
    models.save_ply(folder / "in.ply", cloud)
    done = subprocess.run([learn, folder / "in.ply", folder / "out.ply", *parameters], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr)
    return models.load_mesh(folder / "out.ply"), json.loads(done.stdout), done.stderr.strip()


def of_chain(cloud, vertices, truth):
    with tempfile.TemporaryDirectory() as folder:
        models.save_ply(Path(folder, "cloud.ply"), cloud)
        figures = peers.run("poisson", Path(folder, "cloud.ply"), Path(folder), [vertices])
        return measured(models.load_mesh(Path(folder, f"{vertices}.ply")), truth), figures[vertices]["seconds"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--learn", required=True)
    parser.add_argument("--shapes", nargs="+", default=list(wall_shapes.WALLS), choices=list(wall_shapes.WALLS))
    parser.add_argument("--walls", nargs="+", type=float, default=[.6, 1, 2])
    parser.add_argument("--points", type=int, default=200_000)
    parser.add_argument("--noise", type=float, default=0, help="%% of the diagonal")
    parser.add_argument("--views", type=int, default=0, help="virtual views of 300 x 300 pixels instead of --points")
    parser.add_argument("--vertices", type=int, default=5000)
    parser.add_argument("--seeds", nargs="+", type=int, default=[1])
    parser.add_argument("--chain", action="store_true", help="the plain chain, too")
    parser.add_argument("--keep", type=Path, help="folder for the meshes")
    parser.add_argument("--warnings", action="store_true")
    options, parameters = parser.parse_known_args()
    print(f"{'':14} {'edges':>5} {'spacings':>8} {'genus':>5} {'parts':>5} {'loops':>5} {'cut':>6} {'turned':>6} "
          f"{'forward':>8} {'backward':>8} {'back max':>8} {'seconds':>7}")
    for name in options.shapes:
        make, genus, components = wall_shapes.WALLS[name]
        for edges in options.walls:
            surface, wall = walled(make, edges, options.vertices)
            truth = evaluate.Truth(*surface)
            for seed in options.seeds:
                cloud = cloud_of(surface, options, seed)
                spacings = wall / np.sqrt(open_surfaces.area_of(*surface) / len(cloud))
                with tempfile.TemporaryDirectory() as folder:
                    mesh, report, log = learned(
                        options.learn, cloud, [f"target_vertices={options.vertices}", f"random_seed={seed}", *parameters],
                        Path(folder))
                rows = [("", measured(mesh, truth), report["seconds"])]
                if options.keep:
                    models.save_ply(options.keep / f"{name}_{edges}_{seed}.ply", *mesh)
                if options.chain:
                    rows.append(("  plain chain", *of_chain(cloud, options.vertices, truth)))
                for label, m, seconds in rows:
                    right = "" if m["genus"] == genus and m["components"] == components else " wrong"
                    print(f"{label or name:14} {edges:5.2f} {spacings:8.1f} {m['genus']:5} {m['components']:5} "
                          f"{m['boundary_loops']:5} {m['cut']:6.2f} {m['turned']:6.2f} {m['forward_rms']:8.4f} "
                          f"{m['backward_rms']:8.4f} {m['backward_max']:8.3f} {seconds:7.2f}{right}", flush=True)
                if options.warnings and log:
                    print("   ", log)


if __name__ == "__main__":
    main()
