#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""How often learned topology is right: genus, components and boundary loops over several seeds.

    topology_table.py --learn LEARN [--models kitten ...] [--points 200000] [--noise 0] [--vertices 5000]
                      [--seeds 1,2,3,4,5] [--data FOLDER] [parameter=value ...]

LEARN is the program tests/experiments/tools/learn.cpp; it gets learn_topology=1 and the parameters given, for example
start_mesh=1 for the tetrahedron. "cut-bunny" is the bunny without its lowest quarter, as a cloud of as many points. One
row per model: how many seeds are right, what they gave (genus/components/loops), and the largest backward error of
evaluate.py over the seeds, root mean square and maximum, in % of the diagonal: a web or an unmended tangle shows there.
"""

import argparse
import json
import subprocess
import tempfile
from pathlib import Path

import evaluate
import models
import open_surfaces

CUT_BUNNY = "cut-bunny"
MODELS = ("kitten", "rocker-arm", "eight", "genus3", "block", "two-spheres", "linked-tori", CUT_BUNNY, "foot", "maxplanck")
SAMPLES = 50_000


def load(name, data):
    """Vertices, faces and (genus, components, loops) of the true surface."""
    if name != CUT_BUNNY:
        model = models.MODELS[name]
        return *models.load_model(name, data), (model.genus, model.components, model.boundary_loops)
    vertices, faces = models.load_model("bunny", data)
    low, high = vertices[:, 1].min(), vertices[:, 1].max()
    return *open_surfaces.clipped(vertices, faces, vertices[:, 1] - low - .25 * (high - low)), (0, 1, 1)


def learned(surface, seed, options, folder):
    """The report of one run, and its mesh."""
    cloud, mesh = Path(folder, "cloud.ply"), Path(folder, "mesh.ply")
    models.save_ply(cloud, models.make_cloud(*surface, options.points, options.noise, seed))
    run = subprocess.run(
        [options.learn, cloud, mesh, "learn_topology=1", f"target_vertices={options.vertices}", f"random_seed={seed}",
         *options.parameters], check=True, capture_output=True, text=True)
    return json.loads(run.stdout), models.load_mesh(mesh)


def row_of(name, options, folder):
    vertices, faces, true = load(name, options.data)
    truth = evaluate.Truth(vertices, faces, SAMPLES)
    found, errors = [], []
    for seed in options.seeds:
        report, mesh = learned((vertices, faces), seed, options, folder)
        found.append((report["genus"], report["components"], report["boundary_loops"]))
        errors.append(evaluate.evaluate(*mesh, truth))
    text = " ".join("/".join(map(str, each)) for each in found)
    return (f"| {name} | {'/'.join(map(str, true))} | {found.count(true)} of {len(found)} | {text} | "
            f"{max(e['backward_rms'] for e in errors):.3f} | {max(e['backward_max'] for e in errors):.2f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--learn", required=True)
    parser.add_argument("--models", nargs="+", default=MODELS)
    parser.add_argument("--points", type=int, default=200_000)
    parser.add_argument("--noise", type=float, default=0, help="in %% of the diagonal")
    parser.add_argument("--vertices", type=int, default=5000)
    parser.add_argument("--seeds", type=lambda text: [int(s) for s in text.split(",")], default=[1, 2, 3, 4, 5])
    parser.add_argument("--data", help="the data folder; default: NEURAL_MESH_DATA")
    options, options.parameters = parser.parse_known_args()
    print("| model | true | right | found | backward RMS | backward maximum |\n|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for name in options.models:
            print(row_of(name, options, folder), flush=True)


if __name__ == "__main__":
    main()
