#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The pictures of the documents.

    pictures.py --plugin LIBRARY.so [--data FOLDER] [--pictures FOLDER] [NAME...]

Without a data folder fig2 and fig3 show models of Debian packages instead, and there is no raw_scans."""

import argparse
import contextlib
import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "accuracy"))

import models  # noqa: E402
import numpy as np  # noqa: E402
import open_surfaces  # noqa: E402
import pymeshlab  # noqa: E402
from paint import Drawing, ramp_of, sheet  # noqa: E402
from scipy.spatial import cKDTree  # noqa: E402

FILTER = "generate_surface_reconstruction_neural_mesh"
# The direction to the viewer and what points upwards.
VIEWS = {
    "bunny": ((.25, .15, 1), (0, 1, 0)), "maxplanck": ((.55, .08, 1), (0, 1, 0)), "dino": ((.35, .2, 1), (0, 1, 0)),
    "koala": ((.8, .25, 1), (0, 1, 0)), "feline": ((-.25, 1, -.15), (0, 0, -1)), "fandisk": ((-.8, .55, -1), (0, 1, 0)),
    "armadillo": ((.3, .1, -1), (0, 1, 0)), "elephant": ((.5, .2, 1), (0, 1, 0)), "camel": ((1, .15, .4), (0, 1, 0)),
}
PART = ((1, .7, .6), (0, 0, 1))
CAMERA, OBLIQUE = ((0, 0, -1), (0, -1, 0)), ((.5, -1, .7), (0, 0, 1))
SCANS = {"CSite3_orig-utm": OBLIQUE, "Topography": OBLIQUE, "capture0001": CAMERA, "person": CAMERA,
         "room_scan2": OBLIQUE, "a001": OBLIQUE}


def learned(points, vertices, **parameters):
    """Vertices, faces, colours and counters of the mesh, and the MeshSet that has it."""
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(points))
    meshes.apply_filter(FILTER, target_vertices=vertices, vertex_color=0, **parameters)
    mesh = meshes.current_mesh()
    return (mesh.vertex_matrix(), mesh.face_matrix(), 255 * mesh.vertex_color_matrix()[:, :3],
            mesh.vertex_scalar_array(), meshes)


def available(names, count, data):
    """(name, surface) of the first that there are."""
    found = []
    for name in names:
        with contextlib.suppress(models.ModelError):
            found.append((name, models.load_model(name, data)))
    return found[:count]


def bunny(options):
    """From points to mesh to counters."""
    points = models.load_model("bunny")[0]
    vertices, faces, colors, counters, _ = learned(points, 3000)
    def drawing():
        return Drawing(vertices, (460, 460), *VIEWS["bunny"])
    sheet(options.pictures / "bunny.png", [[drawing().points(points).done(), drawing().mesh(vertices, faces).done(),
                                            drawing().mesh(vertices, faces, colors, None).done()]],
          [[f"{len(points):,} points, no normals", "neural mesh, 3,000 vertices", "its feature counter"]],
          ramp_of(counters, colors))


def closeup(options):
    """Head and ears of the bunny."""
    points = models.load_model("bunny")[0]
    vertices, faces, *_ = learned(points, 3000)
    axes = Drawing(vertices, (1, 1), *VIEWS["bunny"]).axes
    low, size = (vertices @ axes.T).min(0), np.ptp(vertices @ axes.T, axis=0)
    part = np.array([low + size * (-.02, .52, 0), low + size * (.63, 1.02, 1)]) @ axes
    def drawing():
        return Drawing(part, (440, 380), *VIEWS["bunny"])
    sheet(options.pictures / "closeup.png", [[drawing().points(points, 4).done(), drawing().mesh(vertices, faces).done()]],
          [["the points", "the mesh"]])


def fig2(options):
    """The counters of several models as colours."""
    pictures, names = [], []
    for name, surface in available(VIEWS, 6, options.data):
        vertices, faces, colors, counters, _ = learned(models.make_cloud(*surface), 10000, even_sampling=False)
        pictures.append(Drawing(vertices, (420, 420), *VIEWS[name]).mesh(vertices, faces, colors, None).done())
        names.append(name)
    sheet(options.pictures / "fig2.png", [pictures[:3], pictures[3:]], [names[:3], names[3:]], ramp_of(counters, colors))


def fig3(options):
    """Levels of detail."""
    rows, levels = [], (500, 2000, 5000, 10000, 20000)
    for name, surface in available(("maxplanck", "dino", "armadillo"), 2, options.data):
        cloud = models.make_cloud(*surface, 225_000 if name == "dino" else 100_000)
        meshes = [learned(cloud, level, even_sampling=False)[:2] for level in levels]
        rows.append([Drawing(cloud, (320, 320), *VIEWS[name]).mesh(*mesh, outline=None).done() for mesh in meshes])
    words = [f"{level:,} vertices" for level in levels]
    sheet(options.pictures / "fig3.png", rows, [words] * len(rows))


def crease_lines(options):
    """CAD parts with their crease lines; corners are blue, loose ends green."""
    row = []
    for name, noise in (("plate-with-bores", .1), ("crossed-cylinders", 0), ("stepped-shaft", 0)):
        surface = models.load_model(name)
        vertices, faces, _, _, meshes = learned(models.make_cloud(*surface, 100_000, noise), 3000, crease_lines=True)
        lines = list(meshes)[-1]
        places, edges = lines.vertex_matrix(), lines.edge_matrix()
        drawing = Drawing(vertices, (360, 360), *PART).mesh(vertices, faces, outline=(165, 168, 185))
        drawing.lines(places, edges, (205, 30, 40))
        degrees = np.bincount(edges.ravel(), minlength=len(places))
        for v in np.flatnonzero(degrees != 2):
            x, y, _ = drawing.places(places[v])
            drawing.draw.ellipse([x - 9, y - 9, x + 9, y + 9], fill=(30, 60, 190) if degrees[v] > 2 else (20, 140, 60))
        row.append(drawing.done())
    sheet(options.pictures / "crease_lines.png", [row], [[]])


def trimmed_poisson(points, sensor, vertices):
    """Screened Poisson of depth 8 whose normals face the sensor, without faces farther than six spacings from the points."""
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(points))
    meshes.compute_normal_for_point_clouds(k=16, flipflag=True, viewpos=sensor)
    meshes.generate_surface_reconstruction_screened_poisson(depth=8, preclean=True)
    corners, faces = meshes.current_mesh().vertex_matrix(), meshes.current_mesh().face_matrix()
    tree = cKDTree(points)
    spacing = np.median(tree.query(points[::50], k=7)[0][:, 6])
    meshes.add_mesh(pymeshlab.Mesh(corners, faces[tree.query(corners[faces].mean(axis=1))[0] < 6 * spacing]))
    meshes.meshing_remove_connected_component_by_face_number(mincomponentsize=50)
    meshes.meshing_decimation_quadric_edge_collapse(targetfacenum=2 * vertices, preserveboundary=True)
    meshes.meshing_remove_unreferenced_vertices()
    return meshes.current_mesh().vertex_matrix(), meshes.current_mesh().face_matrix()


def raw_scans(options):
    """Real scans, neural meshes of up to 10,000 vertices, at most one for five points, and trimmed Poisson."""
    rows = []
    for name, view in SCANS.items() if options.data else ():
        points = open_surfaces.points_of(Path(options.data, "real", f"{name}.ply"))
        vertices = min(10_000, len(points) // 5)
        mesh = learned(points, vertices)[:2]
        # Far outliers would shrink the pictures to a dot.
        low, high = mesh[0].min(axis=0), mesh[0].max(axis=0)
        edge = (high - low).max() / 20
        points = points[((points > low - edge) & (points < high + edge)).all(axis=1)]
        above = np.append(points.mean(axis=0)[:2], points[:, 2].max() + np.ptp(points[:, :2]))
        other = trimmed_poisson(points, np.zeros(3) if view == CAMERA else above, vertices)
        rows.append([Drawing(points, (330, 330), *view).points(points).done(),
                     *(Drawing(points, (330, 330), *view).mesh(*each).done() for each in (mesh, other))])
    if rows:
        sheet(options.pictures / "raw_scans.png", rows,
              [[]] * (len(rows) - 1) + [["points", "neural mesh", "Poisson, trimmed"]])


MAKERS = {maker.__name__: maker for maker in (bunny, closeup, fig2, fig3, crease_lines, raw_scans)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--plugin", required=True, help="pymeshlab's libfilter_neuralmesh.so")
    parser.add_argument("--data", default=os.environ.get("NEURAL_MESH_DATA"), help="data folder")
    parser.add_argument("--pictures", type=Path, default=Path("screenshots"))
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(MAKERS)}; default: all")
    options = parser.parse_args()
    pymeshlab.load_plugin(options.plugin)
    for name in options.names or MAKERS:
        MAKERS[name](options)


if __name__ == "__main__":
    main()
