#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Writes the scripts in filter_neuralmesh/scripts/ from the table of parameters.

    tests/hosts/example_scripts.py BUILD_FOLDER

Each lists every parameter, because meshlabserver 2020.09 aborts otherwise. Run this after a change of a parameter or
a default; test_scripts.py compares."""

import sys
from pathlib import Path

import meshlabserver

FOLDER = Path(__file__).resolve().parents[2] / "filter_neuralmesh" / "scripts"

# File name -> values that differ from the defaults.
EXAMPLES = {
    "reconstruct": {},
    "features": {"target_vertices": 5000, "select_features": True, "vertex_color": 0},
    "counters_of_a_mesh": {"select_features": True, "feature_measure": 1},
}
COUNTERS = "compute_scalar_by_neural_normal_counter_per_vertex"
FILTERS = {"counters_of_a_mesh": COUNTERS}  # those of the others is the reconstruction


def write(build, name, path):
    return meshlabserver.write_script(build, path, FILTERS.get(name, ""), **EXAMPLES[name])


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    FOLDER.mkdir(exist_ok=True)
    for name in EXAMPLES:
        print(write(sys.argv[1], name, FOLDER / f"{name}.mlx"))


if __name__ == "__main__":
    main()
