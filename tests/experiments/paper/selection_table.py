#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""What selects features best: the two learned measures at the default threshold, and measures of the final mesh.

    selection_table.py --learn build/tests/learn [--data FOLDER] [--out FOLDER]

The models are CAD parts, the meshes those of the filter's defaults. True features are those of features.py. Each
measure of the final mesh has one threshold for all models, the best for the noise level of the row or the best for
the whole table; it is found with the truth. Curvatures are multiplied by the mean edge of the mesh, so that the size of a
model does not matter; the counter is divided by its mean (eq 7). Prints the F1, mean over the models, and writes
OUT/selection.md and OUT/selection.json.
"""

import json
import sys

import numpy as np

import features
import import_paths  # noqa: F401
import paper_runs
from compare_accuracy import table

MODELS = ("fandisk", "block", "l-block", "crossed-cylinders", "half-filleted-cube", "stepped-shaft", "plate-with-bores",
          "chamfered-wedge")
THRESHOLDS = np.geomspace(1e-3, 1e2, 401)
DEFAULT = int(np.argmin(np.abs(np.log(THRESHOLDS / features.DEFAULT_THRESHOLD))))
LEARNED = ("crease measure", "normal counter")


def f1_curve(values, truth):
    """F1 at each of THRESHOLDS."""
    found = np.sort(values)
    right = np.sort(values[truth])
    count = len(found) - np.searchsorted(found, THRESHOLDS, side="right")
    hits = len(right) - np.searchsorted(right, THRESHOLDS, side="right")
    return (2 * hits / np.maximum(1, count + truth.sum())).tolist()


def measures_of(mesh):
    yield "crease measure", mesh.measure
    yield "normal counter", mesh.eq6 / mesh.eq6.mean()
    yield "dihedral", mesh.dihedral()
    yield "normal spread", mesh.spread()
    edge = mesh.edge_length().mean()
    for kind, values in mesh.curvatures():
        yield kind, edge * values


def row_of(case):
    """The curves of one model at one noise level."""
    creases = features.Creases(*case.surface)
    mesh = case.learned("adaptive", True)
    truth = creases.distance(mesh.positions) <= 0.5 * mesh.edge_length()
    return {"model": case.name, "noise": case.noise, "curves": {k: f1_curve(x, truth) for k, x in measures_of(mesh)}}


def report(rows):
    names = list(rows[0]["curves"])
    mean = {noise: {name: np.mean([r["curves"][name] for r in rows if r["noise"] == noise], axis=0) for name in names}
            for noise in sorted({r["noise"] for r in rows})}
    of_table = {name: int(np.argmax(np.mean([m[name] for m in mean.values()], axis=0))) for name in names}
    lines = []
    for noise, curves in mean.items():
        at_default = [f"{curves[name][DEFAULT]:.3f}" for name in LEARNED]
        best = [f"{curves[name].max():.3f} / {curves[name][of_table[name]]:.3f}" for name in names]
        lines.append([f"{noise:g}", *at_default, *best])
    thresholds = ", ".join(f"{name} {THRESHOLDS[at]:.3g}" for name, at in of_table.items())
    header = ["noise %", *(f"{name} at 1" for name in LEARNED), *names]
    return (table(header, lines) + "\n\nWithout \"at 1\": at the best threshold for the noise level / for the table, which "
            f"is {thresholds}.")


def main(arguments=None):
    options = features.parse(["--models", ",".join(MODELS), *(sys.argv[1:] if arguments is None else arguments)])
    try:
        rows = features.kept_rows(row_of, options, "selection.jsonl")
    except paper_runs.RunError as error:
        sys.exit(str(error))
    text = report(rows)
    (options.out / "selection.md").write_text(text + "\n")
    (options.out / "selection.json").write_text(json.dumps(rows))
    print(text)


if __name__ == "__main__":
    main()
