#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Writes filter_neuralmesh/docs/parameters.md from the tables of parameters in vcg_core/settings.cpp.

    tests/hosts/parameters_page.py BUILD_FOLDER

Run this after a change of a parameter; test_scripts.py compares."""

import subprocess
import sys
from pathlib import Path

PAGE = Path(__file__).resolve().parents[2] / "filter_neuralmesh" / "docs" / "parameters.md"

HEAD = """# All parameters

`tests/hosts/parameters_page.py` writes this page from `vcg_core/settings.cpp`. Ids are for scripts, labels for the dialogs.
Ids, meanings and defaults stay.

The dialogs of MeshLab 2022.02 and later show the parameters in **bold**, and the others after a click on the arrow below
them. Scripts for meshlabserver 2020.09 list all; its dialog shows all, those in bold first.

The value of a choice is its number, or in pymeshlab its name. A layer is a number: its position in meshlabserver, its id in
pymeshlab. The default of a layer is the current one. A length is in world units, or in % of the diagonal of the layer: in
pymeshlab `pymeshlab.PercentageValue(2)`.
"""
FILTERS = (
    ("Surface Reconstruction: Neural Mesh", "generate_surface_reconstruction_neural_mesh"),
    ("Compute Scalar by Neural Normal Counter", "compute_scalar_by_neural_normal_counter_per_vertex"),
)
STAGES = {
    "mesh": "What the mesh is like",
    "cloud": "The points",
    "start": "The start mesh",
    "learning": "Learning",
    "fit": "The fit",
    "features": "Features",
    "output": "Output",
    "run": "The run",
}
LARGEST_INT = 2**31 - 1
ANY_LENGTH = 1e30


def number(text):
    """As people write it: 20,000,000 for 20000000."""
    value = float(text)
    if value == LARGEST_INT:
        return "2³¹ - 1"
    return f"{int(value):,}" if value == int(value) else text


def row(line):
    stage, advanced, name, default, low, high, choices, label, explanation = line.split("\t")
    values = f"{number(low)} to {number(high)}"
    if choices:
        values = "<br>".join(f"{i} {choice}" for i, choice in enumerate(choices.split("|")))
    elif default in ("true", "false"):
        values = "true, false"
    elif name.endswith("_layer"):
        default, values = "current", "a layer"
    elif float(high) == ANY_LENGTH:
        default, values = f"{default} %", "a length"
    mark = "" if advanced == "1" else "**"
    return stage, f"| {mark}`{name}`{mark}<br>{label} | {default} | {values} | {explanation} |"


def text(build):
    lines = [HEAD]
    for title, filter_name in FILTERS:
        done = subprocess.run([str(Path(build) / "tests" / "write_mlx"), f"--filter={filter_name}", "--explain"],
                              check=True, stdout=subprocess.PIPE, text=True, encoding="utf-8")
        rows = [row(line) for line in done.stdout.splitlines()]
        lines.append(f"## {title}\n\n`{filter_name}`\n")
        for stage, heading in STAGES.items():
            of_stage = [cells for found, cells in rows if found == stage]
            if of_stage:
                lines.append(f"### {heading}\n\n| id, label | default | values | meaning |\n|---|---|---|---|\n"
                             + "\n".join(of_stage) + "\n")
    return "\n".join(lines)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    PAGE.write_text(text(sys.argv[1]), encoding="utf-8")
    print(PAGE)


if __name__ == "__main__":
    main()
