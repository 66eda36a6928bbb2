#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The picture of filter_neuralmesh/docs/python.md, of what its blocks of code make.

    python_page.py OUT.png --plugin build/plugins/pymeshlab-2025.7/libfilter_neuralmesh.so
"""

import argparse
import os
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tests" / folder) for folder in ("hosts", "experiments/accuracy", "experiments/paper")]

import numpy as np  # noqa: E402
from PIL import Image, ImageDraw  # noqa: E402

import crease_lines  # noqa: E402
import features  # noqa: E402
import library_page  # noqa: E402
import python_site  # noqa: E402


def draw_painted(draw, view, mesh):
    """The faces towards the viewer, each in the colour of its first corner."""
    normals, pixels = features.unit_normals(mesh.vertices, mesh.faces), view.pixels(mesh.vertices)
    lit = normals @ crease_lines.SEEN_FROM
    for f in np.argsort(mesh.vertices[mesh.faces].mean(axis=1) @ crease_lines.SEEN_FROM):
        if lit[f] > 0:
            color = mesh.colors[mesh.faces[f, 0]] * (.5 + .5 * lit[f])
            draw.polygon([pixels[v] for v in mesh.faces[f]], fill=tuple(color.astype(int)))


def panels(made):
    """Four pictures of what the page's code has made, by name."""
    for what in ("points", "mesh", "painted", "boxed"):
        picture = Image.new("RGB", (2 * crease_lines.SIZE,) * 2, "white")
        draw, view = ImageDraw.Draw(picture), crease_lines.View(made["box" if what == "boxed" else "points"])
        if what != "boxed":
            view.scale *= 1.6  # what bounds a ball is its box
        if what == "points":
            draw.point(view.pixels(made["points"][made["points"] @ crease_lines.SEEN_FROM > 0]), fill=(60, 60, 60))
        elif what == "boxed":
            creases = made[what].creases
            crease_lines.draw_mesh(draw, view, made[what].vertices, made[what].faces)
            seen = (creases.vertices @ crease_lines.SEEN_FROM > -.35)[creases.edges].all(axis=1)
            pixels = view.pixels(creases.vertices)
            for one, other in creases.edges[seen]:
                draw.line([pixels[one], pixels[other]], fill=crease_lines.LINE, width=6)
        else:
            draw_painted(draw, view, made[what])
        yield picture.resize((crease_lines.SIZE,) * 2, Image.LANCZOS)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("picture", type=Path)
    parser.add_argument("--plugin", type=Path, required=True)
    options = parser.parse_args()
    target = options.picture.absolute()
    with tempfile.TemporaryDirectory() as folder:
        sys.path.insert(0, str(python_site.make(folder, options.plugin)))
        os.chdir(folder)  # where the code writes files
        made = {}
        for code, _ in library_page.blocks()[:3]:
            exec(code, made)
        sheet = Image.new("RGB", (4 * crease_lines.SIZE, crease_lines.SIZE), "white")
        for column, picture in enumerate(panels(made)):
            sheet.paste(picture, (column * crease_lines.SIZE, 0))
    sheet.save(target)


if __name__ == "__main__":
    main()
