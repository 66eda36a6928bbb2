#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The colours of a dense cloud on a mesh of few vertices, drawn by MeshLab: the points, the vertex colours, and the
texture that tests/hosts/examples/texture_pymeshlab.py makes, which runs first.

    texture.py OUT.png --plugin LIBRARY.so [--out FOLDER]
"""

import argparse
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / folder) for folder in ("accuracy", "paper", "../hosts")]

import numpy as np  # noqa: E402
import pymeshlab  # noqa: E402

import models  # noqa: E402
import python_site  # noqa: E402
from creases import learned_with_colors, save  # noqa: E402
from meshlab_picture import Picture, render  # noqa: E402
from meshlab_picture_sheet import contact_sheet  # noqa: E402
from PIL import Image  # noqa: E402

POINTS, VERTICES = 400_000, 1000
EXAMPLE = HERE.parents[1] / "hosts/examples/texture_pymeshlab.py"
SIZE = (340, 340)
SEEN = {"view": (.3, .2, 1), "up": (0, 1, 0)}
GLAZE, BLUE, RED = (240, 234, 216), (38, 84, 150), (186, 44, 34)
CUTS = 24  # of the edges of each face, so that vertex colours can show its part of the texture


def painted(points):
    """Blue dots and red rings, as on a glazed figure."""
    at = (points - points.min(0)) / np.ptp(points, axis=0).max()
    cells = at / .085
    dots = np.linalg.norm(cells - np.round(cells), axis=1) < .3
    rings = np.abs(np.modf(at[:, 1] / .17)[0] - .5) < .05
    return np.where(rings[:, None], RED, np.where(dots[:, None], BLUE, GLAZE))


def pieces(corners):
    """Arrays of one value for each corner (faces, 3, d): the same at the corners of CUTS x CUTS parts of each face."""
    weights = []
    for i in range(CUTS):
        for j in range(CUTS - i):
            here = [(i, j), (i + 1, j), (i, j + 1)]
            weights.append(here)
            if i + j + 2 <= CUTS:
                weights.append([(i + 1, j), (i + 1, j + 1), (i, j + 1)])
    u, v = np.moveaxis(np.array(weights) / CUTS, -1, 0)
    barycentric = np.stack([1 - u - v, u, v], axis=-1)  # (parts, 3, 3)
    return np.einsum("pck,fkd->fpcd", barycentric, corners).reshape(-1, corners.shape[-1])


def textured(obj, path):
    """A PLY file whose vertex colours show the texture of `obj`."""
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.load_new_mesh(str(obj))
    mesh = meshes.current_mesh()
    image = np.asarray(Image.open(obj.with_suffix(".png")).convert("RGB"))
    places = pieces(mesh.vertex_matrix()[mesh.face_matrix()])
    u, v = pieces(mesh.wedge_tex_coord_matrix().reshape(-1, 3, 2)).T
    rows = np.clip(((1 - v) * image.shape[0]).astype(int), 0, image.shape[0] - 1)
    columns = np.clip((u * image.shape[1]).astype(int), 0, image.shape[1] - 1)
    return save(path, places, np.arange(len(places)).reshape(-1, 3), image[rows, columns])


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("picture")
    parser.add_argument("--plugin", required=True, help="the plugin for pymeshlab")
    parser.add_argument("--out", type=Path, default=Path("out/figures"))
    options = parser.parse_args(arguments)
    options.out.mkdir(parents=True, exist_ok=True)
    pymeshlab.load_plugin(options.plugin)
    site = python_site.make(options.out / "site", options.plugin)
    cloud = models.make_cloud(*models.load_model("bunny"), POINTS, 0)
    points = save(options.out / "texture_cloud.ply", cloud, None, painted(cloud))
    obj = options.out / "texture_mesh.obj"
    done = python_site.run(site, EXAMPLE, points, obj, VERTICES)
    if done.returncode:
        sys.exit(done.stderr)
    colored = options.out / "texture_colors.ply"
    learned_with_colors(points, colored, target_vertices=VERTICES)
    files = [points, str(colored), textured(obj, options.out / "texture_texture.ply")]
    styles = [("points", {"point_size": 1.5}), ("flat", {}), ("flat", {})]
    drawn = render([Picture(file, style, True, **SEEN, **more) for file, (style, more) in zip(files, styles)], SIZE)
    captions = [f"{POINTS:,} coloured points", f"{VERTICES:,} vertices with their colours", "the same with a texture"]
    contact_sheet([drawn], [captions], options.picture)


if __name__ == "__main__":
    main()
