#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Real scans and open meshes of them, drawn by MeshLab: the points, ours, and those of other methods.

    open_scans.py OUT.png --learn build/tests/learn --data FOLDER [--sheet few|raw] [--out FOLDER]

"few" is three scans with 3,000 vertices beside Ball Pivoting and trimmed Poisson,
"raw" six scans of other kinds with up to 10,000, at most one for five points, beside Screened Poisson of depth 8 whose
normals face the sensor, and whose faces farther than six spacings from the points are dropped. All meshes of a scan have
about the same number of vertices.
"""

import argparse
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pymeshlab
from scipy.spatial import cKDTree

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "accuracy"))

import models  # noqa: E402
import open_surfaces  # noqa: E402
import open_table  # noqa: E402
from meshlab_picture import Picture, render  # noqa: E402
from meshlab_picture_sheet import contact_sheet  # noqa: E402

Y_UP, CAMERA, OBLIQUE = ((0, 0.1, 1), (0, 1, 0)), ((0, 0, -1), (0, -1, 0)), ((0.5, -1, 0.7), (0, 0, 1))


@dataclass
class Sheet:
    vertices: int
    methods: dict  # by what is written below them
    scans: dict  # by file: the direction to the viewer, and what points upwards


SHEETS = {
    "few": Sheet(3000, {"Ball Pivoting": "pivoting", "Poisson, trimmed": "trimmed"}, {
        "cloud/scan_bunny_bun000.ply": Y_UP, "cloud/scan_iron.ply": ((0, 0.1, -1), (0, 1, 0)),
        "cloud/pts_poste_france.ply": ((0.5, -1, 0.5), (0, 0, 1))}),
    "raw": Sheet(10000, {"Poisson, trimmed": "facing"}, {
        "real/CSite3_orig-utm.ply": OBLIQUE, "real/Topography.ply": OBLIQUE, "real/capture0001.ply": CAMERA,
        "real/person.ply": CAMERA, "real/room_scan2.ply": OBLIQUE, "real/a001.ply": OBLIQUE}),
}
PER_VERTEX = 5  # points, at least
SIZE = (330, 330)


def near(points, mesh_points):
    """The points in the box of the mesh, enlarged by a twentieth."""
    low, high = mesh_points.min(axis=0), mesh_points.max(axis=0)
    edge = (high - low).max() / 20
    return points[((points > low - edge) & (points < high + edge)).all(axis=1)]


def eye_of(points, view):
    """Where the sensor of a raw scan is: at the origin, or above."""
    if view == CAMERA[0]:
        return np.zeros(3)
    return np.append(points.mean(axis=0)[:2], points[:, 2].max() + np.ptp(points[:, :2]))


def facing_poisson(points, eye, vertices):
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(points))
    meshes.compute_normal_for_point_clouds(k=16, flipflag=True, viewpos=eye)
    meshes.generate_surface_reconstruction_screened_poisson(depth=8, preclean=True)
    corners, faces = meshes.current_mesh().vertex_matrix(), meshes.current_mesh().face_matrix()
    tree = cKDTree(points)
    spacing = np.median(tree.query(points[::50], k=7)[0][:, 6])
    meshes.add_mesh(pymeshlab.Mesh(corners, faces[tree.query(corners[faces].mean(axis=1))[0] < 6 * spacing]))
    meshes.meshing_remove_connected_component_by_face_number(mincomponentsize=50)
    meshes.meshing_decimation_quadric_edge_collapse(targetfacenum=2 * vertices, preserveboundary=True)
    meshes.meshing_remove_unreferenced_vertices()
    return meshes.current_mesh().vertex_matrix(), meshes.current_mesh().face_matrix()


def meshes_of(program, scan, folder, sheet, view):
    """The files to draw in a row: the points, and a list of meshes, ours first. Ours is of all points, the others are
    of those near it: far outliers would shrink their pictures to a dot."""
    points = open_surfaces.points_of(scan)
    vertices = min(sheet.vertices, len(points) // PER_VERTEX)
    files = [folder / f"{scan.stem}_{method}.ply" for method in ("ours", *sheet.methods.values())]
    subprocess.run([program, scan, files[0], f"target_vertices={vertices}", "surface=0", "draw_from_faces=0"],
                   check=True, capture_output=True)
    points = near(points, models.load_mesh(files[0])[0])
    cloud = folder / f"{scan.stem}_points.ply"
    models.save_ply(cloud, points)
    for method, file in zip(sheet.methods.values(), files[1:]):
        if method == "facing":
            mesh = facing_poisson(points, eye_of(points, view), vertices)
        else:
            mesh, _ = open_table.in_pymeshlab(method, cloud, vertices)
        models.save_ply(file, *mesh)
    return cloud, files


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("picture")
    parser.add_argument("--learn", required=True, help="the core as a program (target learn)")
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--sheet", choices=SHEETS, default="few")
    parser.add_argument("--out", type=Path, default=Path("out/figures"))
    options = parser.parse_args(arguments)
    options.out.mkdir(parents=True, exist_ok=True)
    sheet, pictures = SHEETS[options.sheet], []
    for name, (view, up) in sheet.scans.items():
        cloud, files = meshes_of(options.learn, options.data / name, options.out, sheet, view)
        seen = {"view": view, "up": up, "fit_to": [str(cloud)]}
        pictures.append(Picture(str(cloud), "points", **seen))
        pictures += [Picture(str(file), "flat-lines", line_width=.3, **seen) for file in files]
    drawn = render(pictures, SIZE)
    words = ["points", "neural mesh", *sheet.methods]
    rows = [drawn[i:i + len(words)] for i in range(0, len(drawn), len(words))]
    contact_sheet(rows, [[""] * len(words)] * (len(rows) - 1) + [words], options.picture)


if __name__ == "__main__":
    main()
