#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Seconds in a host (pymeshlab): the neural mesh and common methods, on the points of the Stanford bunny.

    in_host.py --plugin LIBRARY.so [--cgal build/tests/cgal_peers] [--turns 3] [--out FILE.json]

runs each method several times, in separate processes, one at a time, and prints the least time: 10,000 vertices by
each method, with ratios and errors (the sum of both RMS directions, in % of the diagonal); a preview of 1,000
vertices; and the share of a run with 100,000 vertices and a million points that is spent outside the core, on copying
layers and on the host's callback.
"""

import argparse
import json
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "experiments" / "accuracy"))
import evaluate  # noqa: E402
import models  # noqa: E402
import peers  # noqa: E402

import pymeshlab  # noqa: E402

CGAL = ("advancing-front", "alpha-wrap")


def bunny_clouds(folder):
    """The vertices of the bunny in Debian's glmark2-data, and a million points of its surface."""
    vertices, faces = models.load_model("bunny")
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(vertices))
    meshes.save_current_mesh(str(folder / "bunny.ply"))
    meshes.add_mesh(pymeshlab.Mesh(vertices, faces))
    meshes.generate_sampling_montecarlo(samplenum=1000000)
    meshes.save_current_mesh(str(folder / "million.ply"))
    return folder / "bunny.ply", folder / "million.ply"


def fastest(method, cloud, folder, count, options):
    plugin = options.plugin if method == "neural" else None
    command = f"{options.cgal} {method}" if method in CGAL else None
    runs = [peers.run(method, cloud, folder / method, [count], plugin=plugin, command=command)[count]
            for _ in range(options.turns)]
    return min(runs, key=lambda run: run["seconds"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--plugin", required=True)
    parser.add_argument("--cgal", help="the program cgal_peers; with it CGAL is timed as well")
    parser.add_argument("--turns", type=int, default=3)
    parser.add_argument("--out", type=Path)
    options = parser.parse_args()
    table = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        cloud, million = bunny_clouds(folder)
        truth = evaluate.Truth(*models.load_model("bunny"))
        print(f"The bunny's points, seconds, least of {options.turns}")
        for method in ["neural", *peers.PEERS, *(CGAL if options.cgal else ())]:
            run = fastest(method, cloud, folder, 10000, options)
            measures = evaluate.evaluate(*models.load_mesh(folder / method / "10000.ply"), truth)
            table[method] = {"seconds": run["seconds"], "error": measures["sum_rms"]}
            print(f"  10,000 vertices, {method:15} {run['seconds']:7.2f}   "
                  f"{run['seconds'] / table['neural']['seconds']:5.2f} x ours   error {table[method]['error']:.4f} %")
        run = fastest("neural", cloud, folder, 1000, options)
        table["preview"] = run["seconds"]
        print(f"   1,000 vertices, neural          {run['seconds']:7.2f}")
        run = fastest("neural", million, folder, 100000, options)
        outside = run["seconds"] - run["report"]["seconds"]
        table["outside_core"] = outside / run["seconds"]
        print(f" 100,000 vertices, neural          {run['seconds']:7.2f}, of which outside the core {outside:.3f} "
              f"({100 * outside / run['seconds']:.1f} %)")
    if options.out:
        options.out.write_text(json.dumps(table, indent=1) + "\n")


if __name__ == "__main__":
    main()
