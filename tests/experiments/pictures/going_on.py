#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""A start of one's own: a coarse result, that result edited, and what learning makes of the edited mesh.

    going_on.py OUT.png --learn build/tests/learn [--out FOLDER]

The cloud is a shaft. The edit opens its upper end and leaves out the points there, as one would cut away a web.
"""

import argparse
import sys
from pathlib import Path

sys.path[:0] = [str(Path(__file__).resolve().parents[1] / folder) for folder in ("accuracy", "paper")]

import numpy as np  # noqa: E402
from PIL import Image, ImageDraw  # noqa: E402

import features  # noqa: E402
import models  # noqa: E402
import paper_runs  # noqa: E402
from crease_lines import SIZE, View, draw_mesh, side_by_side  # noqa: E402

PART, POINTS, COARSE, FINE = "stepped-shaft", 100_000, 300, 3000


def picture(vertices, faces):
    image = Image.new("RGB", (2 * SIZE, 2 * SIZE), "white")
    draw_mesh(ImageDraw.Draw(image), View(vertices), vertices, faces)
    return image.resize((SIZE, SIZE), Image.LANCZOS)


def is_below(points, end):
    """Whether points are farther below the height end than a fiftieth of the diagonal of all."""
    return points[:, 2] < end - .02 * np.linalg.norm(np.ptp(points, axis=0))


def without_upper_end(vertices, faces):
    """The mesh without its faces at the upper end, and without vertices that are left over."""
    faces = faces[is_below(vertices, vertices[:, 2].max())[faces].any(axis=1)]
    used, faces = np.unique(faces, return_inverse=True)
    return vertices[used], faces.reshape(-1, 3)


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("picture")
    parser.add_argument("--learn", required=True, help="the core as a program (target learn)")
    parser.add_argument("--out", type=Path, default=Path("out/figures"))
    options = parser.parse_args(arguments)
    options.out.mkdir(parents=True, exist_ok=True)
    surface = features.load(PART, None)
    cloud, mesh, start = (options.out / f"going_on_{name}.ply" for name in ("cloud", "mesh", "start"))
    points = models.make_cloud(*surface, POINTS, 0)
    models.save_ply(cloud, points)
    paper_runs.learn(options.learn, cloud, mesh, target_vertices=COARSE)
    coarse = models.load_mesh(mesh)
    edited = without_upper_end(*coarse)
    models.save_ply(start, *edited)
    models.save_ply(cloud, points[is_below(points, points[:, 2].max())])
    paper_runs.learn(options.learn, cloud, mesh, start=start, target_vertices=FINE, start_mesh=2)
    side_by_side([picture(*shown) for shown in (coarse, edited, models.load_mesh(mesh))]).save(options.picture)


if __name__ == "__main__":
    main()
