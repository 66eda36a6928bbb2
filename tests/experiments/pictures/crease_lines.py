#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Meshes of CAD parts with their crease lines, drawn as wireframes. Corners are blue, loose ends green.

    crease_lines.py OUT.png --learn build/tests/learn [--data FOLDER] [--out FOLDER]
"""

import argparse
import os
import sys
from pathlib import Path

sys.path[:0] = [str(Path(__file__).resolve().parents[1] / folder) for folder in ("accuracy", "paper")]

import numpy as np  # noqa: E402
import pymeshlab  # noqa: E402
from PIL import Image, ImageDraw  # noqa: E402

import features  # noqa: E402
import models  # noqa: E402
import paper_runs  # noqa: E402

PARTS = (("plate-with-bores", 0.1), ("crossed-cylinders", 0), ("stepped-shaft", 0))  # with noise in %
VERTICES, POINTS = 3000, 100_000
SIZE = 720  # pixels of one picture, drawn twice as large
SEEN_FROM = np.array([1, .7, .6]) / np.linalg.norm([1, .7, .6])
LINE, CORNER, END, WIRE = (205, 30, 40), (30, 60, 190), (20, 140, 60), (165, 168, 185)


class View:
    """Parallel projection of what lies within the box of points."""

    def __init__(self, points):
        self.right = np.cross([0, 0, 1], SEEN_FROM)
        self.right /= np.linalg.norm(self.right)
        self.up = np.cross(SEEN_FROM, self.right)
        self.centre = (points.min(0) + points.max(0)) / 2
        self.scale = 1.9 * SIZE / np.linalg.norm(np.ptp(points, axis=0))

    def pixels(self, points):
        off = self.scale * (points - self.centre)
        return [(SIZE + x, SIZE - y) for x, y in zip(off @ self.right, off @ self.up)]


def draw_mesh(draw, view, vertices, faces):
    normals, pixels = features.unit_normals(vertices, faces), view.pixels(vertices)
    lit = normals @ SEEN_FROM
    for f in np.argsort(vertices[faces].mean(axis=1) @ SEEN_FROM):
        if lit[f] > 0:
            draw.polygon([pixels[v] for v in faces[f]], fill=(int(150 + 100 * lit[f]),) * 3, outline=WIRE)


def draw_lines(draw, view, vertices, edges):
    pixels, degrees = view.pixels(vertices), np.bincount(edges.ravel(), minlength=len(vertices))
    for a, b in edges:
        draw.line([pixels[a], pixels[b]], fill=LINE, width=6)
    for v in np.flatnonzero(degrees != 2):
        x, y = pixels[v]
        draw.ellipse([x - 11, y - 11, x + 11, y + 11], fill=CORNER if degrees[v] > 2 else END)


def picture(name, noise, options):
    surface = features.load(name, options.data)
    cloud, out = options.out / "crease_cloud.ply", options.out / "crease_mesh.ply"
    models.save_ply(cloud, models.make_cloud(*surface, POINTS, noise))
    paper_runs.learn(options.learn, cloud, out, target_vertices=VERTICES, crease_lines=1)
    meshes = pymeshlab.MeshSet(verbose=False)
    for path in (out, f"{out}.creases.ply"):
        meshes.load_new_mesh(str(path))
    mesh, lines = meshes
    view, image = View(mesh.vertex_matrix()), Image.new("RGB", (2 * SIZE, 2 * SIZE), "white")
    draw = ImageDraw.Draw(image)
    draw_mesh(draw, view, mesh.vertex_matrix(), mesh.face_matrix())
    draw_lines(draw, view, lines.vertex_matrix(), lines.edge_matrix())
    return image.resize((SIZE, SIZE), Image.LANCZOS)


def side_by_side(pictures):
    sheet = Image.new("RGB", (len(pictures) * SIZE, SIZE), "white")
    for column, image in enumerate(pictures):
        sheet.paste(image, (column * SIZE, 0))
    return sheet


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("picture")
    parser.add_argument("--learn", required=True, help="the core as a program (target learn)")
    parser.add_argument("--data", default=os.environ.get("NEURAL_MESH_DATA"), help="data folder")
    parser.add_argument("--out", type=Path, default=Path("out/figures"))
    options = parser.parse_args(arguments)
    options.out.mkdir(parents=True, exist_ok=True)
    side_by_side([picture(name, noise, options) for name, noise in PARTS]).save(options.picture)


if __name__ == "__main__":
    main()
