# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Parts with creases that are known exactly, made in code, each as (vertices, triangles)."""

import numpy as np
import pymeshlab

import shapes


def extruded(outline, low, high, centre=(0, 0)):
    """The prism over a counter-clockwise outline in the plane, every point of which the centre sees."""
    outline = np.asarray(outline, dtype=float)
    n = len(outline)
    k, k1 = np.arange(n), (np.arange(n) + 1) % n
    v = np.vstack([np.column_stack([outline, np.full(n, z)]) for z in (low, high)]
                  + [[[*centre, low], [*centre, high]]])
    f = [(k, k1, n + k1), (k, n + k1, n + k), (np.full(n, 2 * n), k1, k),
         (np.full(n, 2 * n + 1), n + k, n + k1)]
    return v, np.vstack([np.column_stack(part) for part in f])


def half_filleted_cube(fillet=0.2):
    """The cube [-1, 1]^3 with its four upright edges rounded with radius fillet, the others sharp."""
    arc = np.linspace(0, np.pi / 2, 25)
    corners = ((1, 1, 0), (-1, 1, np.pi / 2), (-1, -1, np.pi), (1, -1, 1.5 * np.pi))
    outline = np.vstack([np.column_stack([x * (1 - fillet) + fillet * np.cos(arc + start),
                                          y * (1 - fillet) + fillet * np.sin(arc + start)])
                         for x, y, start in corners])
    return extruded(outline, -1, 1)


def l_block():
    """A bracket: convex edges, and one that is concave."""
    return extruded([(0, 0), (2, 0), (2, .7), (.7, .7), (.7, 2), (0, 2)], 0, 1, centre=(.6, .6))


def stepped_shaft():
    """Three cylinders of different radii on one axis: circular creases, convex and concave."""
    profile = [(.5, 0), (.5, .8), (.8, .8), (.8, 1.8), (.35, 1.8), (.35, 3)]
    return shapes.revolved(shapes.refined(profile, 20), 128)


def plate_with_bores():
    """A plate with four round holes."""
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(*extruded([(-1.5, -1), (1.5, -1), (1.5, 1), (-1.5, 1)], -.25, .25)))
    turn = np.linspace(0, 2 * np.pi, 96, endpoint=False)
    for x, y, radius in ((-.8, -.4, .3), (.8, -.4, .3), (-.8, .5, .2), (.6, .45, .35)):
        plate = meshes.current_mesh_id()
        circle = np.column_stack([x + radius * np.cos(turn), y + radius * np.sin(turn)])
        meshes.add_mesh(pymeshlab.Mesh(*extruded(circle, -1, 1, centre=(x, y))))
        meshes.generate_boolean_difference(first_mesh=plate, second_mesh=meshes.current_mesh_id())
    return meshes.current_mesh().vertex_matrix(), meshes.current_mesh().face_matrix()


def chamfered_wedge(chamfer=.15):
    """A wedge whose thick end has two chamfered edges."""
    outline = [(0, 0), (2 - chamfer, 0), (2, chamfer), (2, 1 - chamfer), (2 - chamfer, 1), (1.4, .9)]
    return extruded(outline, 0, 1, centre=(1.4, .4))


PARTS = {"half-filleted-cube": half_filleted_cube, "l-block": l_block, "stepped-shaft": stepped_shaft,
         "plate-with-bores": plate_with_bores, "chamfered-wedge": chamfered_wedge}
