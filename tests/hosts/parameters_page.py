#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Writes filter_neuralmesh/docs/parameters.md and the scripts in filter_neuralmesh/scripts/ from the tables of parameters
in vcg_core/settings.cpp.

    tests/hosts/parameters_page.py BUILD_FOLDER

Run this after a change of a parameter; test_scripts.py compares."""

import sys
from pathlib import Path

import meshlabserver

FOLDER = Path(__file__).resolve().parents[2] / "filter_neuralmesh"
PAGE = FOLDER / "docs" / "parameters.md"
SCRIPTS = FOLDER / "scripts"

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
# Scripts, and their values that differ from the defaults.
EXAMPLES = {
    "reconstruct": {},
    "features": {"target_vertices": 5000, "select_features": True, "vertex_color": 0},
    "counters_of_a_mesh": {"filter_name": FILTERS[1][1], "select_features": True, "feature_measure": 1},
}
LARGEST_INT = 2**31 - 1


def number(text):
    """As people write it: 20,000,000 for 20000000."""
    value = float(text)
    if value == LARGEST_INT:
        return "2³¹ - 1"
    return f"{int(value):,}" if value == int(value) else f"{value:g}"


def cells(row):
    default, values = row["default"], f"{number(row['low'])} to {number(row['high'])}"
    if row["choices"]:
        values = "<br>".join(f"{i} {choice}" for i, choice in enumerate(row["choices"].split("|")))
    elif default in ("true", "false"):
        values = "true, false"
    elif row["type"] == "RichMesh":
        default, values = "current", "a layer"
    elif row["type"] == "RichAbsPerc":
        default, values = f"{default} %", "a length"
    mark = "" if row["advanced"] == "1" else "**"
    return f"| {mark}`{row['id']}`{mark}<br>{row['label']} | {default} | {values} | {row['help']} |"


def page(build):
    lines = [HEAD]
    for title, filter_name in FILTERS:
        rows = meshlabserver.parameters(build, filter_name)
        lines.append(f"## {title}\n\n`{filter_name}`\n")
        for stage, heading in STAGES.items():
            of_stage = [cells(row) for row in rows if row["stage"] == stage]
            if of_stage:
                lines.append(f"### {heading}\n\n| id, label | default | values | meaning |\n|---|---|---|---|\n"
                             + "\n".join(of_stage) + "\n")
    return "\n".join(lines)


def texts(build):
    """{path: what this script writes there}"""
    scripts = {SCRIPTS / f"{name}.mlx": meshlabserver.script(build, **values) for name, values in EXAMPLES.items()}
    return {PAGE: page(build), **scripts}


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    for path, text in texts(sys.argv[1]).items():
        path.write_text(text, encoding="utf-8")
        print(path)


if __name__ == "__main__":
    main()
