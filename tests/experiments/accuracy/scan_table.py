#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Neural meshes of raw scans: outliers, levels of noise and misregistration, uneven density, few points per vertex.

    scan_table.py --plugin LIBRARY.so [--data FOLDER] [--out FOLDER] [--groups ...] [--peers plain]

prints tables (markdown) of runs that are kept in OUT/scan_table.jsonl. Outliers are compared with the same cloud without
them, everything else with the plain chain (normals, Screened Poisson of depth 8, Quadric Edge Collapse). Lengths are % of
the diagonal of the true surface. Of scans by views, forward distances are those of the parts that a view sees.
"""

import copy
import itertools
import sys

import numpy as np

import evaluate
import models
import peers
import scans
from compare_accuracy import Kept, geometric_mean, note, numbers, parsed, parser, table, topology_right

OUTLIERS = [("moved", .006), ("moved", .01), ("moved", .05), ("moved", .1), ("box", .01), ("box", .05), ("box", .1),
            ("clumps", .01), ("rays", .01)]
PER_VERTEX, NOISE = (1.3, 2, 4, 5, 10, 40), (0, .1)
DENSITIES = (1, 10, 30)
WORST_SHARE = .01  # of the surface, whose part of the squared error is told
GROUPS = ("outliers", "levels", "density", "points")
PEERS = ("plain",)


def parse(arguments):
    options = parser(__doc__)
    options.add_argument("--groups", type=numbers(str), default=list(GROUPS))
    options.add_argument("--peers", type=numbers(str), default=[], help=f"of {', '.join(PEERS)}")
    options.add_argument("--vertices", type=int, default=5000)
    options.add_argument("--samples", type=int, default=100_000, help="points of the clouds with outliers")
    options.add_argument("--per-vertex", type=numbers(float), default=list(PER_VERTEX), help="points per vertex")
    options.add_argument("--noise", type=numbers(float), default=list(NOISE), help="%% of the diagonal, of these clouds")
    return parsed(options, arguments)


def drawn(samples, noise=0):
    """make(truth) of a plain cloud; see cases()."""
    return lambda truth: (models.make_cloud(truth.vertices, truth.faces, samples, noise), 0, truth)


def spoilt(samples, kind, share):
    def make(truth):
        points, flags = scans.with_outliers(drawn(samples)(truth)[0], kind, share)
        return points, int(flags.sum()), truth
    return make


def seen(level, **views):
    def make(truth):
        result = scans.scan(truth.vertices, truth.faces, level, **views)
        return result.points, int(result.outlier.sum()), seen_part(truth, result)
    return make


def thinned(ratio):
    return lambda truth: (scans.thinned(truth.vertices, truth.faces, ratio), 0, truth)


def cases(group, samples, vertices, per_vertex=PER_VERTEX, noise=NOISE, **views):
    """[(name, make)] of a group, with make(truth) -> the points, how many outliers they have, the truth to measure against."""
    return {"outliers": [("clean", drawn(samples)), *((f"{kind} {100 * share:g} %", spoilt(samples, kind, share))
                                                      for kind, share in OUTLIERS)],
            "levels": [(f"level {name}", seen(level, **views)) for name, level in scans.LEVELS.items()],
            "density": [(f"density {ratio}:1", thinned(ratio)) for ratio in DENSITIES],
            "points": [(f"{ratio:g} points per vertex" + (f", noise {level:g} %" if level else ""),
                        drawn(int(ratio * vertices), level)) for level, ratio in itertools.product(noise, per_vertex)],
            }[group]


def seen_part(truth, scan):
    """The truth with samples where a view sees it: elsewhere no method can know the surface."""
    part = copy.copy(truth)
    chosen = np.random.default_rng(20030101).choice(len(scan.seen), truth.samples, replace=False)
    part.points, part.normals = scan.seen[chosen], scan.seen_normals[chosen]
    return part


def where(mesh, truth):
    """Where the error is: forward plus backward RMS in the sparse third, the last along the longest axis, and the part
    of the squared error that WORST_SHARE of the surface carries, the larger of both ways."""
    ways, _ = evaluate.both_ways(*mesh, truth)
    axis = np.argmax(np.ptp(truth.points, axis=0))
    low, length = truth.points[:, axis].min(), np.ptp(truth.points[:, axis])
    sparse, worst = 0, 0
    for points, distance in ways:
        sparse += evaluate.rms(distance[points[:, axis] > low + 2 / 3 * length])
        squares = np.sort(distance ** 2)
        worst = max(worst, float(squares[-round(WORST_SHARE * len(squares)):].sum() / squares.sum()))
    return {"sparse_third": sparse, "worst_share": worst}


def measured(method, cloud, options, folder):
    points, outliers, truth = cloud
    folder.mkdir(parents=True, exist_ok=True)
    models.save_ply(folder / "cloud.ply", points)
    ours = {"plugin": options.plugin, "settings": options.settings} if method == "neural" else {}
    try:
        figures = peers.run("neural" if ours else "poisson", folder / "cloud.ply", folder, [options.vertices],
                            timeout=options.timeout, **ours)
        mesh = models.load_mesh(folder / f"{options.vertices}.ply")
        return {**evaluate.evaluate(*mesh, truth), **where(mesh, truth), **figures[options.vertices], "outliers": outliers}
    except (peers.PeerError, models.ModelError, ValueError) as error:
        return {"error": str(error)}


def all_rows(options):
    rows, kept = [], Kept("scan_table", options)
    for name, group in itertools.product(options.models, options.groups):
        whole = evaluate.Truth(*models.load_model(name, options.data))
        for case, make in cases(group, options.samples, options.vertices, options.per_vertex, options.noise):
            for method in ("neural", *options.peers):
                row = kept.row(lambda: measured(method, make(whole), options, options.out / "work" / f"scan-{name}"),
                               method, model=name, case=case, vertices=options.vertices, samples=options.samples,
                               **(options.settings if method == "neural" else {}))
                if row is not None:
                    rows.append({"model": name, "case": case, "method": method, **row})
                    note(f"{name}, {case}, {method}: " + (row.get("error") or f"{row['forward_rms']:.4f} forward, "
                                                                              f"{row['backward_rms']:.4f} backward"))
    return rows


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
        topology = f"{sum(map(topology_right, good))}/{len(own)}"
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


if __name__ == "__main__":
    try:
        print(tables(all_rows(parse(None))))
    except models.ModelError as error:
        sys.exit(str(error))
