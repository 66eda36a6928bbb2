#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The per-vertex counter compared with MeshLab's curvature filters: which ranks the vertices best by curvature?

    compare_curvature.py --plugin LIBRARY.so | --ours-command 'PROGRAM'   [--data FOLDER] [--out FOLDER]

The reference is the spread of the true surface's normals within a ball around each vertex, of a radius of two mean
edge lengths. It is defined at creases, and needs no second derivatives. The table has Spearman's rank correlation of
that spread with
- the counter that the filter writes to the quality,
- MeshLab's curvature filters on the same final mesh,
- the best of those filters on the mesh that Screened Poisson + Quadric Edge Collapse make of the same cloud,
and the correlation of the counter with the filters. Writes OUT/curvature.md and OUT/curvature.json.
"""

import json
import sys

import numpy as np
import pymeshlab
from scipy.spatial import cKDTree
from scipy.stats import spearmanr

import compare_accuracy
import models
import peers

MODELS = ("bunny", "fandisk", "rocker-arm", "block", "feline")
PUBLIC = ("bunny", "fandisk", "armadillo", "anchor")

# name: (filter, its arguments). Their curvatures are signed; their absolute values are compared.
CURVATURES = {
    "curvedness": ("compute_curvature_principal_directions_per_vertex",
                   {"method": "Quadric Fitting", "curvcolormethod": "CurvedNess", "autoclean": False}),
    "Taubin mean": ("compute_curvature_principal_directions_per_vertex",
                    {"method": "Taubin approximation", "curvcolormethod": "Mean Curvature", "autoclean": False}),
    "discrete abs": ("compute_scalar_by_discrete_curvature_per_vertex", {"curvaturetype": "ABS Curvature"}),
    "discrete mean": ("compute_scalar_by_discrete_curvature_per_vertex", {"curvaturetype": "Mean Curvature"}),
}


def read_with_quality(path):
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.load_new_mesh(str(path))
    return meshes, meshes.current_mesh().vertex_scalar_array().copy()


def filter_values(meshes, name):
    """The absolute value of one of MeshLab's curvatures at each vertex, or None if the filter refuses the mesh."""
    function, arguments = CURVATURES[name]
    try:
        meshes.apply_filter(function, **arguments)
    except pymeshlab.PyMeshLabException:  # the mesh is not a manifold
        return None
    return np.abs(np.nan_to_num(meshes.current_mesh().vertex_scalar_array(), posinf=0, neginf=0))


def normal_spread(points, truth, radius):
    """1 - |mean of the true normals within radius|, from 0 (flat) upwards, at the true surface next to each point.

    Normals at more than a right angle from the nearest one belong to the other side of a thin wall and are left out.
    """
    tree = cKDTree(truth.points)
    _, nearest = tree.query(points)
    own = truth.normals[nearest]
    spread = np.empty(len(points))
    for i, near in enumerate(tree.query_ball_point(truth.points[nearest], radius)):
        normals = truth.normals[near]
        normals = normals[normals @ own[i] > 0]
        spread[i] = 1 - np.linalg.norm(normals.mean(axis=0))
    return spread


def mean_edge(vertices, faces):
    return float(np.linalg.norm(vertices[faces] - vertices[np.roll(faces, 1, axis=1)], axis=2).mean())


def correlation(a, b):
    """Spearman's rank correlation; None if one of the two is constant."""
    if a is None or b is None or np.ptp(a) == 0 or np.ptp(b) == 0:
        return None
    return float(spearmanr(a, b).statistic)


def compared(case, count, seed, options, utility):
    settings = {**dict(word.split("=", 1) for word in options.set), "utility_counter": utility, "random_seed": seed}
    folder = case.folder / f"counter-{utility}-{seed}"
    peers.run("neural", case.cloud(), folder, [count], plugin=options.plugin, command=options.ours_command,
              settings=settings)
    meshes, counter = read_with_quality(folder / f"{count}.ply")
    mesh = meshes.current_mesh()
    vertices = mesh.vertex_matrix()
    radius = 2 * mean_edge(vertices, mesh.face_matrix())
    truth = case.truth()
    judge = normal_spread(vertices, truth, radius)
    row = {**case.key(), "vertices": count, "utility": utility, "seed": seed, "counter": correlation(counter, judge)}
    for name in CURVATURES:
        values = filter_values(meshes, name)
        row[name] = correlation(values, judge)
        row[f"counter with {name}"] = correlation(counter, values)
    row["peer's best"] = peers_best(case, count, truth, radius)
    return row


def peers_best(case, count, truth, radius):
    """The highest correlation of any of the filters on the first peer's mesh."""
    folder = case.folder / "poisson-smooth"
    if not (folder / f"{count}.ply").exists():
        peers.run("poisson-smooth", case.cloud(), folder, [count])
    meshes, _ = read_with_quality(folder / f"{count}.ply")
    judge = normal_spread(meshes.current_mesh().vertex_matrix(), truth, radius)
    found = [correlation(filter_values(meshes, name), judge) for name in CURVATURES]
    return max((value for value in found if value is not None), default=None)


def main(arguments=None):
    options = compare_accuracy.parse(["--name", "curvature", "--vertices", "5000", "--noise", "0,.3,.6",
                                      *(sys.argv[1:] if arguments is None else arguments)])
    if not (options.plugin or options.ours_command):
        sys.exit("Give --plugin or --ours-command: without counters there is nothing to compare.")
    given = any(word.startswith("--models") for word in (sys.argv[1:] if arguments is None else arguments))
    names = options.models if given else MODELS if options.data else PUBLIC
    rows = []
    for name in names:
        for noise in options.noise:
            case = compare_accuracy.Case(name, noise, options)
            for count in options.vertices:
                for seed in options.seeds:
                    for utility in (0, 1):
                        try:
                            rows.append(compared(case, count, seed, options, utility))
                        except (peers.PeerError, models.ModelError) as error:
                            sys.exit(str(error))
            print(f"{name}, noise {noise:g} %: done", file=sys.stderr, flush=True)
    columns = ["counter", *CURVATURES, "peer's best", *(f"counter with {name}" for name in CURVATURES)]
    lines = [[r["model"], f"{r['noise']:g}", r["vertices"], ("normal", "signal")[r["utility"]], r["seed"],
              *("-" if r[c] is None else f"{r[c]:.2f}" for c in columns)] for r in rows]
    text = compare_accuracy.table(["model", "noise %", "vertices", "utility", "seed", *columns], lines)
    (options.out / "curvature.json").write_text(json.dumps(rows, indent=1))
    (options.out / "curvature.md").write_text(text + "\n")
    print(text)


if __name__ == "__main__":
    main()
