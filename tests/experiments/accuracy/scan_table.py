#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Neural meshes of raw scans: outliers, levels of noise and misregistration, uneven density, few points per vertex.

    scan_table.py --plugin LIBRARY.so [--data FOLDER] [--out FOLDER] [--groups ...] [--peers plain]

prints tables (markdown) and writes OUT/scan_table.json, to which a later call adds. Outliers are compared with the same
cloud without them, everything else with the plain chain (normals, Screened Poisson of depth 8, Quadric Edge Collapse). Lengths are % of the diagonal of the true surface. Of scans
by views, forward distances are those of the parts that a view sees.
"""

import argparse
import copy
import json
import os
import sys
from pathlib import Path

import numpy as np
import pymeshlab
from scipy.spatial import cKDTree

import evaluate
import models
import peers
import scans
from accuracy_table import TABLE_MODELS
from compare_accuracy import geometric_mean, numbers, table

OUTLIERS = [("moved", .006), ("moved", .01), ("moved", .05), ("moved", .1), ("box", .01), ("box", .05), ("box", .1),
            ("clumps", .01), ("rays", .01)]
PER_VERTEX, NOISE = (1.3, 2, 4, 5, 10, 40), (0, .1)
DENSITIES = (1, 10, 30)
WORST_SHARE = .01  # of the surface, whose part of the squared error is told
GROUPS = ("outliers", "levels", "density", "points")
DEPTHS, SAMPLES_PER_NODE = (7, 8, 9), (1.5, 5, 15)  # of Screened Poisson, tuned
PEERS = ("plain",)


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--plugin", required=True, help="pymeshlab's libfilter_neuralmesh.so")
    parser.add_argument("--data", default=os.environ.get("NEURAL_MESH_DATA"), help="data folder")
    parser.add_argument("--out", type=Path, default=Path("build/experiments"))
    parser.add_argument("--models", type=numbers(str))
    parser.add_argument("--groups", type=numbers(str), default=list(GROUPS))
    parser.add_argument("--peers", type=numbers(str), default=[], help=f"of {', '.join(PEERS)}")
    parser.add_argument("--vertices", type=int, default=5000)
    parser.add_argument("--samples", type=int, default=100_000, help="points of the clouds with outliers")
    parser.add_argument("--per-vertex", type=numbers(float), default=list(PER_VERTEX), help="points per vertex")
    parser.add_argument("--noise", type=numbers(float), default=list(NOISE), help="%% of the diagonal, of these clouds")
    parser.add_argument("--timeout", type=float, default=300, help="seconds for one mesh")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="a parameter of ours")
    options = parser.parse_args(arguments)
    options.models = options.models or list(TABLE_MODELS if options.data else models.PUBLIC_MODELS)
    options.settings = dict(word.split("=", 1) for word in options.set)
    return options


def clouds(name, truth, options):
    """Yields (case, points, true outliers or none, the truth to measure against)."""
    vertices, faces = truth.vertices, truth.faces
    if "outliers" in options.groups:
        points = models.make_cloud(vertices, faces, options.samples)
        yield "clean", points, 0, truth
        for kind, share in OUTLIERS:
            with_them, flags = scans.with_outliers(points, kind, share)
            yield f"{kind} {100 * share:g} %", with_them, int(flags.sum()), truth
    if "levels" in options.groups:
        for level, defects in scans.LEVELS.items():
            result = scans.scan(vertices, faces, defects)
            yield f"level {level}", result.points, int(result.outlier.sum()), seen_part(truth, result)
    if "density" in options.groups:
        for ratio in DENSITIES:
            yield f"density {ratio}:1", scans.thinned(vertices, faces, ratio), 0, truth
    if "points" in options.groups:
        for noise in options.noise:
            for ratio in options.per_vertex:
                cloud = models.make_cloud(vertices, faces, int(ratio * options.vertices), noise)
                yield f"{ratio:g} points per vertex" + (f", noise {noise:g} %" if noise else ""), cloud, 0, truth


def seen_part(truth, scan):
    """The truth with samples where a view sees it: elsewhere no method can know the surface."""
    part = copy.copy(truth)
    chosen = np.random.default_rng(20030101).choice(len(scan.seen), truth.samples, replace=False)
    part.points, part.normals = scan.seen[chosen], scan.seen_normals[chosen]
    return part


def turned_normals(points, truth):
    """Normals of the points from 30 neighbours, pointing to the side that those of the truth point to."""
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(points))
    meshes.compute_normal_for_point_clouds(k=30)
    normals = meshes.current_mesh().vertex_normal_matrix()
    _, nearest = cKDTree(truth.points).query(points)
    wrong = np.einsum("ij,ij->i", normals, truth.normals[nearest]) < 0
    return np.where(wrong[:, None], -normals, normals)


def where(mesh, truth):
    """Where the error is: forward plus backward RMS in the sparse third, the last along the longest axis, and the part
    of the squared error that WORST_SHARE of the surface carries, the larger of both ways."""
    ways = evaluate.distances(*mesh, truth)
    axis = np.argmax(np.ptp(truth.points, axis=0))
    low, length = truth.points[:, axis].min(), np.ptp(truth.points[:, axis])
    sparse, worst = 0, 0
    for points, distance in ways:
        last = points[:, axis] > low + 2 / 3 * length
        sparse += float(np.sqrt(np.mean(distance[last] ** 2)))
        squares = np.sort(distance ** 2)
        worst = max(worst, float(squares[-round(WORST_SHARE * len(squares)):].sum() / squares.sum()))
    return {"sparse_third": sparse, "worst_share": worst}


def measured(method, points, truth, options, folder):
    folder.mkdir(parents=True, exist_ok=True)
    models.save_ply(folder / "cloud.ply", points)
    ours = {"plugin": options.plugin, "settings": options.settings} if method == "neural" else {}
    figures = peers.run("neural" if ours else "poisson", folder / "cloud.ply", folder, [options.vertices],
                        timeout=options.timeout, **ours)
    mesh = models.load_mesh(folder / f"{options.vertices}.ply")
    return {**evaluate.evaluate(*mesh, truth), **where(mesh, truth), **figures[options.vertices]}


def all_rows(options, rows, keep):
    known = {(row["model"], row["case"], row["method"]) for row in rows}
    for name in options.models:
        whole = evaluate.Truth(*models.load_model(name, options.data))
        for case, points, outliers, truth in clouds(name, whole, options):
            for method in ("neural", *options.peers):
                if (name, case, method) in known:
                    continue
                row = {"model": name, "case": case, "method": method, "points": len(points), "outliers": outliers}
                try:
                    row.update(measured(method, points, truth, options, options.out / "work" / f"scan-{name}"))
                except (peers.PeerError, ValueError) as error:
                    row["error"] = str(error)
                rows.append(row)
                keep(rows)
                print(f"{name}, {case}, {method}: "
                      + (f"{row['forward_rms']:.4f} forward, {row['backward_rms']:.4f} backward"
                         if "error" not in row else row["error"]), file=sys.stderr, flush=True)


def right(row):
    model = models.MODELS[row["model"]]
    return (row["components"], row["genus"]) == (model.components, model.genus)


def ratio(rows, others, key):
    """The geometric mean over the models of both, and the largest."""
    theirs = {row["model"]: row[key] for row in others if "error" not in row}
    ratios = [row[key] / theirs[row["model"]] for row in rows if row["model"] in theirs and "error" not in row]
    return f"{geometric_mean(ratios):.2f} ({max(ratios):.2f})" if ratios else "-"


def tables(rows):
    def of(case, method):
        return [row for row in rows if (row["case"], row["method"]) == (case, method)]

    cases = list(dict.fromkeys(row["case"] for row in rows))
    methods = [m for m in PEERS if any(row["method"] == m for row in rows)]
    kinds = {kind for kind, _ in OUTLIERS}
    lines, others = [], []
    density, even = [], of("density 1:1", "neural")
    for case in cases:
        own = of(case, "neural")
        good = [row for row in own if "error" not in row]
        topology = f"{sum(map(right, good))}/{len(own)}"
        if case.split()[0] in kinds:
            clean = of("clean", "neural")
            left_out = sum(row["report"]["outliers"] for row in good) / max(1, sum(row["outliers"] for row in good))
            lines.append([case, len(own), *(ratio(own, clean, key) for key in ("forward_rms", "backward_rms",
                                                                                "backward_max")),
                          f"{100 * left_out:.0f} %", topology])
        if case.split()[0] == "density":
            density.append([case, len(own), ratio(own, even, "sparse_third"),
                            *(ratio(own, of(case, m), "sparse_third") for m in methods if m == "plain")])
        line = [case, len(own), *(f"{geometric_mean([row[key] for row in good]):.4f}" if good else "-"
                                  for key in ("forward_rms", "backward_rms")), topology,
                f"{np.mean([row['worst_share'] for row in good]):.2f}" if good else "-"]
        for method in methods:
            line += [ratio(own, of(case, method), key) for key in ("forward_rms", "backward_rms", "sum_rms")]
        others.append(line)
    text = []
    if lines:
        text += ["## Outliers, over the same cloud without them: geometric mean (worst model)", "",
                 table(["outliers", "models", "forward", "backward", "backward maximum", "left out, of those added",
                        "topology right"], lines), ""]
    if density:
        text += ["## Error in the sparse third, over an even cloud of as many points: geometric mean (worst model)", "",
                 table(["case", "models", "over even", *(["over plain"] if "plain" in methods else [])], density), ""]
    header = ["case", "models", "forward", "backward", "topology right", "squared error in worst 1 %"]
    return "\n".join([*text, "## Error, and over the peers", "",
                      table(header + [f"{m}: {way}" for m in methods for way in ("forward", "backward", "sum")],
                            others)])


def main(arguments=None):
    options = parse(arguments)
    path = options.out / "scan_table.json"
    rows = json.loads(path.read_text()) if path.exists() else []

    def keep(so_far):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(so_far))

    try:
        all_rows(options, rows, keep)
    except models.ModelError as error:
        sys.exit(str(error))
    print(tables(rows))


if __name__ == "__main__":
    main()
