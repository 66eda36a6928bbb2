#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""What selects the creases of noisy data, drawn by MeshLab: selected vertices are red.

    creases.py OUT.png --plugin LIBRARY.so [--out FOLDER]

First row, the counters of a given mesh: a noisy mesh, the best of MeshLab's curvatures at the threshold that is best
for it, found with the truth, and the crease measure at its default threshold. Second row, the reconstruction of a
coloured noisy cloud: the points, the mesh with their colours (`vertex_color` 1), its features (`select_by` 1).
"""

import argparse
import sys
from pathlib import Path

sys.path[:0] = [str(Path(__file__).resolve().parents[1] / folder) for folder in ("accuracy", "paper")]

import numpy as np  # noqa: E402
import pymeshlab  # noqa: E402

import features  # noqa: E402
import models  # noqa: E402
from meshlab_picture import Picture, render  # noqa: E402
from meshlab_picture_sheet import contact_sheet  # noqa: E402

MODEL, NOISE, VERTICES, POINTS = "crossed-cylinders", .6, 4000, 60_000
RECONSTRUCTION = "generate_surface_reconstruction_neural_mesh"
SIZE = (340, 340)
SEEN = {"view": (1, .55, .8), "up": (0, 1, 0)}
PLAIN, SELECTED = (205, 208, 214), (200, 30, 40)


def save(path, vertices, faces, colors):
    """colors: RGB from 0 to 255 per vertex. Returns the path."""
    rgba = np.column_stack([np.asarray(colors) / 255, np.ones(len(vertices))])
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(vertices, *([] if faces is None else [faces]), v_color_matrix=rgba))
    meshes.save_current_mesh(str(path), save_vertex_color=True)
    return str(path)


def learned_with_colors(points, path, **parameters):
    """A MeshSet with the mesh learned from a PLY file of coloured points; the PLY file `path` shows its colours."""
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.load_new_mesh(points)
    meshes.apply_filter(RECONSTRUCTION, **parameters)
    mesh = meshes.current_mesh()
    save(path, mesh.vertex_matrix(), mesh.face_matrix(), 255 * mesh.vertex_color_matrix()[:, :3])
    return meshes  # which owns the mesh


def marked(path, vertices, faces, selected):
    return save(path, vertices, faces, np.where(selected[:, None], SELECTED, PLAIN))


def best_selection(values, truth):
    """The vertices above the threshold of the highest F1."""
    order = np.argsort(-values, kind="stable")
    f1 = 2 * np.cumsum(truth[order]) / (np.arange(1, len(values) + 1) + truth.sum())
    return values >= values[order[f1.argmax()]]


def given_row(surface, cloud, folder):
    vertices, faces = features.noisy_mesh(surface, VERTICES, NOISE)
    mesh = features.counted(vertices, faces, cloud)
    truth = features.truth_of(mesh, features.Creases(*surface))
    curvature = max((values for name, values in features.measures_of(mesh) if name in features.CURVATURES),
                    key=lambda values: max(features.f1_curve(values, truth)))
    none = np.zeros(len(vertices), dtype=bool)
    found = {"mesh": none, "curvature": best_selection(curvature, truth), "measure": mesh.measure > 1}
    files = [marked(folder / f"creases_{name}.ply", vertices, faces, chosen) for name, chosen in found.items()]
    return [Picture(file, "flat", True, **SEEN) for file in files]


def painted(points):
    """Colours of eight cells of space, as a scanner's camera may give."""
    palette = np.array([(236, 205, 120), (150, 190, 120), (120, 170, 205), (215, 150, 120), (190, 160, 200),
                        (130, 200, 190), (225, 175, 185), (170, 175, 130)])
    return palette[(points > 0) @ [1, 2, 4]]


def learned_row(cloud, folder):
    points = save(folder / "creases_cloud.ply", cloud, None, painted(cloud))
    colored = folder / "creases_colored.ply"
    meshes = learned_with_colors(points, colored, target_vertices=VERTICES, vertex_color=1, select_features=True,
                                 select_by=1)
    mesh = meshes.current_mesh()
    selected = marked(folder / "creases_selected.ply", mesh.vertex_matrix(), mesh.face_matrix(),
                      mesh.vertex_selection_array())
    return [Picture(points, "points", True, point_size=1.5, **SEEN), Picture(str(colored), "smooth", True, **SEEN),
            Picture(selected, "flat", True, **SEEN)]


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("picture")
    parser.add_argument("--plugin", required=True, help="the plugin for pymeshlab")
    parser.add_argument("--out", type=Path, default=Path("out/figures"))
    options = parser.parse_args(arguments)
    options.out.mkdir(parents=True, exist_ok=True)
    pymeshlab.load_plugin(options.plugin)
    surface = features.load(MODEL, None)
    cloud = models.make_cloud(*surface, POINTS, NOISE)
    rows = [given_row(surface, cloud, options.out), learned_row(cloud, options.out)]
    drawn = iter(render([picture for row in rows for picture in row], SIZE))
    captions = [["a given mesh, noise .6 %", "best curvature, best threshold", "crease measure above 1"],
                ["coloured points, noise .6 %", "neural mesh with their colours", "its features"]]
    contact_sheet([[next(drawn) for _ in row] for row in rows], captions, options.picture)


if __name__ == "__main__":
    main()
