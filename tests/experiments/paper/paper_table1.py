#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Table 1 of the paper reproduced: the error of adaptive and non-adaptive neural meshes.

    paper_table1.py --learn build/tests/learn --check build/tests/check_mesh [--data FOLDER] [--out FOLDER]

The cloud consists of the vertices of a mesh, as in the paper. The error is the RMS distance from that mesh to the
result, in % of the bounding-box diagonal, measured by vcglib's Hausdorff sampler (derived from Metro, which the paper
used). Three variants: the paper's rules unchanged; with maturity, the rule that keeps growth from stalling; and the
defaults of the filter. The error of the normals is measured as well. Writes OUT/table1.md and OUT/table1.json, and
prints the first. An interrupted run continues where it stopped (OUT/table1.rows.jsonl).
"""

import argparse
import json
import os
import sys
from functools import partial
from pathlib import Path

import numpy as np

import import_paths  # noqa: F401
import models
import paper_runs
from compare_accuracy import numbers, table

VARIANTS = {
    "to the letter": {"start_mesh": 1, "learn_topology": 0, "min_wins_per_split": 0, "fit_to_points": 0},
    "with maturity": {"start_mesh": 1, "learn_topology": 0, "fit_to_points": 0},
    "default": {},
}
KINDS = {"ad": 0, "nad": 1}  # the parameter utility_counter
MODELS = ("brain", "maxplanck", "dino", "bunny")
# It has too few vertices for a mesh of 10,000, so its cloud is drawn from the faces.
DRAWN_FROM_FACES = ("brain",)
# The paper's Table 1, for its Brain, which is not public.
PAPER = {
    (500, "ad"): (.732, .724, .732, .729, 3.75), (500, "nad"): (.756, .753, .745, .744, .751),
    (2000, "ad"): (.427, .424, 1.96, .431, .428), (2000, "nad"): (.433, .440, .441, .437, .439),
    (10000, "ad"): (.172, .173, .170, .172, .171), (10000, "nad"): (.197, .199, .197, .197, .199),
}
PAPER_AVERAGES = {(500, "ad"): 1.33, (500, "nad"): .749, (2000, "ad"): .734, (2000, "nad"): .438,
                  (10000, "ad"): .171, (10000, "nad"): .197}  # as printed
# A run counts as stuck in a local minimum if its error is this many times the median over the seeds.
STUCK = 2


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--learn", required=True, help="the core as a program (target learn)")
    parser.add_argument("--check", required=True, help="the program that measures (target check_mesh)")
    parser.add_argument("--data", default=os.environ.get("NEURAL_MESH_DATA"), help="data folder")
    parser.add_argument("--out", type=Path, default=Path("out/figures"))
    parser.add_argument("--models", type=numbers(str), default=MODELS)
    parser.add_argument("--vertices", type=numbers(int), default=(500, 2000, 10000))
    parser.add_argument("--seeds", type=numbers(int), default=(1, 2, 3, 4, 5))
    parser.add_argument("--variants", type=numbers(str), default=tuple(VARIANTS), help=f"of {', '.join(VARIANTS)}")
    options = parser.parse_args(arguments)
    unknown = [name for name in options.variants if name not in VARIANTS]
    if unknown:
        parser.error(f"there is no variant '{unknown[0]}': it is one of {', '.join(VARIANTS)}")
    return options


def measured(options, name, judge, files, variant, kind, vertices, seed):
    """One run of one variant, as a dictionary."""
    cloud, mesh = files
    report = paper_runs.learn(options.learn, cloud, mesh, target_vertices=vertices, random_seed=seed, threads=1,
                              draw_from_faces=int(name in DRAWN_FROM_FACES), utility_counter=KINDS[kind],
                              **VARIANTS[variant])
    found = paper_runs.check(options.check, mesh, cloud)
    return {"model": name, "variant": variant, "kind": kind, "target": vertices, "seed": seed,
            "rms": found["rms_to_mesh"], "backward_rms": found["rms_to_reference"],
            "normal_error": judge.error(*models.load_mesh(mesh)), "vertices": found["vertices"],
            "regular_valences": found["regular_valences"], "genus": found["genus"],
            **{key: report[key] for key in ("signals", "splits", "collapses", "seconds", "warnings")}}


def all_rows(options):
    rows = []
    kept = paper_runs.Kept(options.out / "table1.rows.jsonl", options.learn)
    for name in options.models:
        if not paper_runs.is_available(name, options.data):
            print(f"{name} needs a data folder and is left out.", file=sys.stderr)
            continue
        surface = paper_runs.surface(name, options.data)
        files = options.out / f"table1_{name}.ply", options.out / "table1_mesh.ply"
        models.save_ply(files[0], *surface)
        judge = paper_runs.SmoothNormals(*surface)
        cloud = paper_runs.digest(files[0].read_bytes())
        for variant in options.variants:
            for vertices in options.vertices:
                for kind in KINDS:
                    for seed in options.seeds:
                        run = partial(measured, options, name, judge, files, variant, kind, vertices, seed)
                        rows.append(kept.row(run, name=name, cloud=cloud, variant=variant, kind=kind, vertices=vertices,
                                             seed=seed))
        print(f"{name}: done", file=sys.stderr, flush=True)
    return rows


def runs_of(rows, **wanted):
    return [row for row in rows if all(row[key] == value for key, value in wanted.items())]


def digits(value):
    """Three significant digits, as the paper prints them."""
    return f"{value:#.3g}"


def model_table(rows, name, options):
    lines = []
    for variant in ("the paper (its Brain)", *options.variants):
        for vertices in options.vertices:
            for kind in KINDS:
                if variant not in VARIANTS:
                    errors, signals = PAPER.get((vertices, kind), ()), "-"
                else:
                    found = runs_of(rows, model=name, variant=variant, kind=kind, target=vertices)
                    errors = [row["rms"] for row in found]
                    signals = f"{np.mean([row['signals'] for row in found]) / 1000:.0f}k"
                stuck = sum(error > STUCK * np.median(errors) for error in errors)
                cells = [digits(error) for error in errors[:len(options.seeds)]]
                mean = digits(np.mean(errors)) if len(errors) else "-"
                if variant not in VARIANTS and errors:
                    mean = digits(PAPER_AVERAGES[vertices, kind])
                lines.append([variant, vertices, kind, *cells, *["-"] * (len(options.seeds) - len(cells)), mean,
                              *(digits(of(errors)) if len(errors) else "-" for of in (np.median, np.max)), stuck,
                              signals])
    examples = [f"Ex.{index + 1}" for index in range(len(options.seeds))]
    return table(["variant", "#v", "", *examples, "Aver.", "median", "worst", "stuck", "signals"], lines)


def ratio_table(rows, options):
    """Adaptive over non-adaptive, medians over the seeds, for the paper and for every model and variant."""
    lines = []
    paper = [np.median(PAPER[n, "ad"]) / np.median(PAPER[n, "nad"]) if (n, "ad") in PAPER else np.nan
             for n in options.vertices]
    lines.append(["its Brain", "the paper", *(f"{value:.2f}" for value in paper), *["-"] * len(options.vertices)])
    for name in dict.fromkeys(row["model"] for row in rows):
        for variant in options.variants:
            cells = []
            for measure in ("rms", "normal_error"):
                for n in options.vertices:
                    medians = [np.median([row[measure] for row in
                                          runs_of(rows, model=name, variant=variant, kind=kind, target=n)])
                               for kind in KINDS]
                    cells.append(f"{medians[0] / medians[1]:.2f}")
            lines.append([name, variant, *cells])
    return table(["model", "variant", *(f"RMS {n}" for n in options.vertices),
                  *(f"normals {n}" for n in options.vertices)], lines)


def normals_table(rows, options):
    lines = []
    for name in dict.fromkeys(row["model"] for row in rows):
        for variant in options.variants:
            lines.append([name, variant, *(
                f"{np.mean([row['normal_error'] for row in runs_of(rows, **key, kind=kind)]):.2f}"
                for n in options.vertices for key in [{"model": name, "variant": variant, "target": n}]
                for kind in KINDS)])
    return table(["model", "variant", *(f"{n} {kind}" for n in options.vertices for kind in KINDS)], lines)


def letter_text(rows, options):
    """A sentence with numbers on how runs by the paper's unchanged rules ended."""
    sentences = []
    for variant in options.variants:
        runs = runs_of(rows, variant=variant)
        stalled = [row for row in runs if any("stalled" in warning for warning in row["warnings"])]
        kinds = ", ".join(f"{sum(row['kind'] == kind for row in stalled)} of "
                          f"{len(runs_of(runs, kind=kind))} {kind}" for kind in KINDS)
        share = [np.mean([row["collapses"] / max(1, row["splits"]) for row in runs_of(runs, kind=kind)])
                 for kind in KINDS]
        worst = max(max(errors) / np.median(errors) for name in options.models for n in options.vertices for kind in KINDS
                    for errors in [[row["rms"] for row in runs_of(runs, model=name, kind=kind, target=n)]] if errors)
        sentences.append(f"- *{variant}*: growth stalled and had to be forced in {kinds} runs; of the vertices that "
                         f"splits made, {100 * share[0]:.0f} % (ad) and {100 * share[1]:.0f} % (nad) were collapsed "
                         f"again. The worst seed has {worst:.2f} times the median error of its seeds.")
    return "\n".join(sentences)


def report(rows, options):
    text = ["# Table 1", "RMS from the true mesh to the result, % of the bounding-box diagonal. ad: normal counter, "
            "nad: signal counter. Signals: mean over the seeds. Stuck: runs with more than twice the median error.",
            ""]
    for name in dict.fromkeys(row["model"] for row in rows):
        cloud = "drawn from its faces" if name in DRAWN_FROM_FACES else "its vertices"
        text += [f"## {name} (cloud: {cloud})", model_table(rows, name, options), ""]
    text += ["## Does growth stall?", letter_text(rows, options), "",
             "## Adaptive over non-adaptive (below 1: adaptive is better), medians over the seeds",
             ratio_table(rows, options), "",
             "## Error of the interpolated vertex normals, degrees, means over surface and seeds",
             normals_table(rows, options)]
    return "\n".join(text)


def main(arguments=None):
    options = parse(arguments)
    try:
        rows = all_rows(options)
    except (models.ModelError, paper_runs.RunError) as error:
        sys.exit(str(error))
    if not rows:
        sys.exit("None of the models is available: set NEURAL_MESH_DATA or install glmark2-data.")
    text = report(rows, options)
    (options.out / "table1.json").write_text(json.dumps(rows, indent=1))
    (options.out / "table1.md").write_text(text + "\n")
    print(text)


if __name__ == "__main__":
    main()
