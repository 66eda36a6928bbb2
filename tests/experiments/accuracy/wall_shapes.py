# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Closed surfaces with thin walls, made in code, each as (vertices, triangles) for a wall of given thickness."""

import numpy as np
import pymeshlab

import open_surfaces
import shapes
from cad_parts import extruded

RECTANGLE = ((-1.5, -1), (1.5, -1), (1.5, 1), (-1.5, 1))


def slab(wall):
    """A rectangular sheet."""
    return extruded(RECTANGLE, 0, wall)


def tube(wall):
    """A pipe of radius 1 and length 2.5, open at both ends: genus 1."""
    outside = shapes.refined([(1 - wall, 0), (1, 0), (1, 2.5), (1 - wall, 2.5), (1 - wall, 0)], 40)[:-1]
    return shapes.turned_ring(outside)


def nested_boxes(wall):
    """A hollow box: two components, the inner one seen from inside."""
    v, f = box((-1, -.8, -.6), (1, .8, .6))
    w, g = box((-1 + wall, -.8 + wall, -.6 + wall), (1 - wall, .8 - wall, .6 - wall))
    return shapes.merged((v, f), (w, g[:, ::-1]))


def hollow_sphere(wall):
    """Two spheres about one centre: two components."""
    v, f = shapes.sphere()
    return shapes.merged((v, f), (v * (1 - wall), f[:, ::-1]))


def blade(wall):
    """A straight blade: a lens, which tapers from the given thickness at the middle to sharp edges."""
    across = np.linspace(-1, 1, 33)
    half = wall / 2 * (1 - across ** 2)
    outline = np.vstack([np.column_stack([across, -half]), np.column_stack([across, half])[-2:0:-1]])
    return extruded(outline, 0, 2.5)


def casting(wall):
    """A plate with three ribs across and nine bores between them, all walls alike: genus 9."""
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(*box((-1.5, -1, 0), (1.5, 1, wall))))
    for x in (-.75, 0, .75):
        _combine(meshes, "union", *box((x - wall / 2, -1, wall / 2), (x + wall / 2, 1, .5)))
    for x in (-1.125, -.375, .375):
        for y in (-.6, 0, .6):
            _combine(meshes, "difference", *cylinder((x, y), .15, -.2, .3))
    return meshes.current_mesh().vertex_matrix(), meshes.current_mesh().face_matrix()


def box(low, high):
    x0, y0, z0 = low
    x1, y1, z1 = high
    return extruded([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], z0, z1, ((x0 + x1) / 2, (y0 + y1) / 2))


def cylinder(centre, radius, low, high):
    turn = np.linspace(0, 2 * np.pi, 64, endpoint=False)
    outline = np.column_stack([centre[0] + radius * np.cos(turn), centre[1] + radius * np.sin(turn)])
    return extruded(outline, low, high, centre)


def _combine(meshes, operation, vertices, faces):
    first = meshes.current_mesh_id()
    meshes.add_mesh(pymeshlab.Mesh(vertices, faces))
    getattr(meshes, f"generate_boolean_{operation}")(first_mesh=first, second_mesh=meshes.current_mesh_id())


def walled(make, edges, count):
    """The shape whose wall is as thick as that many mean edges of an even mesh with count vertices, and that thickness. The
    edge depends on the area, which depends on the wall."""
    wall = .03
    for _ in range(4):
        wall = edges * np.sqrt(4 / np.sqrt(3) * open_surfaces.area_of(*make(wall)) / (2 * count))
    return make(wall), wall


# Name: the shape for a wall, its genus and its number of components.
WALLS = {"cup": (shapes.cup, 0, 1), "slab": (slab, 0, 1), "tube": (tube, 1, 1), "nested-boxes": (nested_boxes, 0, 2),
         "hollow-sphere": (hollow_sphere, 0, 2), "blade": (blade, 0, 1), "casting": (casting, 9, 1)}
