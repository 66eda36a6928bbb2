#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Real scans and open meshes of them, drawn by MeshLab: the points, ours, Ball Pivoting, trimmed Poisson.

    open_scans.py LEARN OUT.png --data FOLDER [--vertices 3000] [--out FOLDER]

LEARN is the program build/tests/learn. All meshes have about the same number of vertices.
"""

import argparse
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "accuracy"))

import models  # noqa: E402
import open_surfaces  # noqa: E402
import open_table  # noqa: E402
from meshlab_picture import Picture, render  # noqa: E402
from meshlab_picture_sheet import contact_sheet  # noqa: E402

# The scan's file, the direction from it to the viewer, and what points upwards.
SCANS = (("scan_bunny_bun000.ply", (0, 0.1, 1), (0, 1, 0)), ("scan_iron.ply", (0, 0.1, -1), (0, 1, 0)),
         ("pts_poste_france.ply", (0.5, -1, 0.5), (0, 0, 1)))
METHODS = ("ours", "pivoting", "trimmed")
SIZE = (330, 330)


def near(points, mesh_points):
    """The points in the box of the mesh, enlarged by a twentieth."""
    low, high = mesh_points.min(axis=0), mesh_points.max(axis=0)
    edge = (high - low).max() / 20
    return points[((points > low - edge) & (points < high + edge)).all(axis=1)]


def meshes_of(program, scan, folder, vertices):
    """The files to draw in a row: the points, and a list of meshes, ours first. Ours is of all points, the others are
    of those near it: far outliers would shrink their pictures to a dot."""
    files = [folder / f"{scan.stem}_{method}.ply" for method in METHODS]
    subprocess.run([program, scan, files[0], f"target_vertices={vertices}", "surface=0", "draw_from_faces=0"],
                   check=True, capture_output=True)
    cloud = folder / f"{scan.stem}_points.ply"
    models.save_ply(cloud, near(open_surfaces.points_of(scan), models.load_mesh(files[0])[0]))
    for method, file in zip(METHODS[1:], files[1:]):
        models.save_ply(file, *open_table.in_pymeshlab(method, cloud, vertices)[0])
    return cloud, files


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("picture")
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--vertices", type=int, default=3000)
    parser.add_argument("--out", type=Path, default=Path("out/figures"))
    options = parser.parse_args(arguments)
    options.out.mkdir(parents=True, exist_ok=True)
    pictures = []
    for name, view, up in SCANS:
        cloud, files = meshes_of(options.program, options.data / "cloud" / name, options.out, options.vertices)
        seen = {"view": view, "up": up, "fit_to": [str(cloud)]}
        pictures.append(Picture(str(cloud), "points", **seen))
        pictures += [Picture(str(file), "flat-lines", line_width=.3, **seen) for file in files]
    drawn = render(pictures, SIZE)
    columns = len(pictures) // len(SCANS)
    rows = [drawn[i:i + columns] for i in range(0, len(drawn), columns)]
    words = ["points", "neural mesh", "Ball Pivoting", "Poisson, trimmed"]
    contact_sheet(rows, [[""] * columns] * (len(rows) - 1) + [words], options.picture)


if __name__ == "__main__":
    main()
