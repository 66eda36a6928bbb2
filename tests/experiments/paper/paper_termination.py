#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Eq 8 of the paper as a stop criterion: the mean counter falls below alpha_t.

    paper_termination.py --learn build/tests/learn --trace build/tests/counter_trace [--data FOLDER] [--out FOLDER]

The first table shows three criteria while meshes grow. The mean of the eq 4 counters depends on the number of
vertices only: a signal adds 1 on average and the decay takes 5 % of the sum, which therefore stays at 19 for any mesh.
The mean of the eq 6 counters stays at about 1, because they are normalised. The turn of the normals, in degrees, does
fall as the mesh improves; stop_below_mean_counter is a bound on it. The second table has the results of one such
bound on different models. The third compares their spread with that of runs to one number of vertices. Writes
OUT/termination.md and OUT/termination.json.
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

# From few to many details; the first four that are available.
MODELS = ("filleted-cube", "kitten", "bunny", "armadillo", "dino")
COUNT = 4
CONVERGED = 1  # the stop_reason of eq 8
FITS = {"fit off": 0, "fit on": 1}


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--learn", required=True, help="the core as a program (target learn)")
    parser.add_argument("--trace", required=True, help="the program of counter_trace.cpp")
    parser.add_argument("--data", default=os.environ.get("NEURAL_MESH_DATA"), help="data folder")
    parser.add_argument("--models", type=numbers(str), default=MODELS)
    parser.add_argument("--thresholds", type=numbers(float), default=(.24, .2, .17), help="in degrees")
    parser.add_argument("--samples", type=int, default=200_000)
    parser.add_argument("--most", type=int, default=20_000, help="bound on the vertices")
    parser.add_argument("--out", type=Path, default=Path("out/figures"))
    return parser.parse_args(arguments)


class Subject:
    """A model, the file of its cloud, and its true normals."""

    def __init__(self, name, options):
        self.name, self.options = name, options
        self.surface = paper_runs.surface(name, options.data)
        self.judge = paper_runs.SmoothNormals(*self.surface)
        self.cloud = options.out / f"termination_{name}.ply"
        models.save_ply(self.cloud, models.make_cloud(*self.surface, options.samples))
        self.key = {"name": name, "cloud": paper_runs.digest(self.cloud.read_bytes())}

    def trace(self):
        run = paper_runs.output_of([self.options.trace, self.cloud, f"target_vertices={self.options.most}"])
        return [json.loads(line) for line in run.stdout.splitlines()]

    def mesh(self, **settings):
        """One run: its vertices, stop reason and error of the normals."""
        path = self.options.out / "termination_mesh.ply"
        report = paper_runs.learn(self.options.learn, self.cloud, path, **settings)
        angles = self.judge.angles(*models.load_mesh(path))
        return {"vertices": report["vertices"], "stop_reason": report["stop_reason"], "rms": report["rms_error"],
                "normal_error": float(angles.mean()), "normal_rms": float(np.sqrt((angles**2).mean()))}


def measured(options):
    """Traces, stopped runs, and runs that all have the geometric mean of the stopped runs' vertices."""
    options.out.mkdir(parents=True, exist_ok=True)
    kept = paper_runs.Kept(options.out / "termination.rows.jsonl", options.learn)
    names = [name for name in options.models if paper_runs.is_available(name, options.data)][:COUNT]
    subjects = [Subject(name, options) for name in names]
    traces = {s.name: kept.row(s.trace, **s.key, most=options.most) for s in subjects}
    rows = []
    for degrees in options.thresholds:
        for fit, value in FITS.items():
            stopped = {}
            for s in subjects:
                settings = {"target_vertices": options.most, "stop_below_mean_counter": degrees, "fit_to_points": value}
                stopped[s.name] = kept.row(partial(s.mesh, **settings), **s.key, **settings)
            count = int(np.exp(np.mean([np.log(run["vertices"]) for run in stopped.values()])))
            for s in subjects:
                settings = {"target_vertices": count, "fit_to_points": value}
                even = kept.row(partial(s.mesh, **settings), **s.key, **settings)
                rows.append({"model": s.name, "degrees": degrees, "fit": fit, "stopped": stopped[s.name], "even": even})
        print(f"{degrees:g} degrees: done", file=sys.stderr, flush=True)
    return traces, rows


def trace_table(traces):
    lines = [[name, line["vertices"], f"{line['mean_eq4']:.2g}", f"{line['sum_eq4']:.1f}",
              f"{line['mean_eq6']:.2f}", f"{line['mean_turn']:.2f}"] for name, trace in traces.items() for line in trace]
    return table(["model", "vertices", "Mean(n_c), eq 4", "sum of n_c, eq 4", "Mean(n_c), eq 6", "mean turn (degrees)"], lines)


def quality(run):
    return [f"{run['normal_error']:.2f}", f"{run['normal_rms']:.2f}", f"{run['rms']:.4f}"]


def stop_table(rows):
    lines = [[f"{row['degrees']:g}", row["fit"], row["model"],
              f"{row['stopped']['vertices']}{'' if row['stopped']['stop_reason'] == CONVERGED else ' (not reached)'}",
              *quality(row["stopped"]), row["even"]["vertices"], *quality(row["even"])] for row in rows]
    errors = ["error of the normals, mean", "RMS (degrees)", "RMS distance %"]
    return table(["stop below (degrees)", "", "model", "vertices", *errors, "vertices, the same for all", *errors], lines)


def spread(values):
    return max(values) / min(values)


def spread_table(rows):
    lines = []
    for degrees, fit in dict.fromkeys((row["degrees"], row["fit"]) for row in rows):
        group = [row for row in rows if (row["degrees"], row["fit"]) == (degrees, fit)]
        lines.append([f"{degrees:g}", fit, *(f"{spread([row[kind][error] for row in group]):.1f}"
                                             for error in ("normal_error", "normal_rms") for kind in ("stopped", "even")),
                      f"{spread([row['stopped']['vertices'] for row in group]):.0f}"])
    return table(["stop below (degrees)", "", "mean error of the normals, largest over least: one threshold",
                  "one number of vertices", "RMS error: one threshold", "one number of vertices",
                  "vertices, most over least"], lines)


def main(arguments=None):
    options = parse(arguments)
    try:
        traces, rows = measured(options)
    except (models.ModelError, paper_runs.RunError) as error:
        sys.exit(str(error))
    text = "\n".join(["# Eq 8 as a stop criterion", "", "## What could be compared with alpha_t, during growth",
                      trace_table(traces), "", "## Where stop_below_mean_counter stops, and how good the normals are there",
                      stop_table(rows), "", "## How alike the models come out", spread_table(rows)])
    (options.out / "termination.md").write_text(text + "\n")
    (options.out / "termination.json").write_text(json.dumps({"traces": traces, "rows": rows}, indent=1))
    print(text)


if __name__ == "__main__":
    main()
