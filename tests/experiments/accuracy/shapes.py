# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Surfaces made in code, each as (vertices, triangles), counter-clockwise seen from outside."""

import numpy as np
import pymeshlab


def grid_faces(rows, columns, wrap_rows, wrap_columns):
    i, j = np.meshgrid(np.arange(rows if wrap_rows else rows - 1),
                       np.arange(columns if wrap_columns else columns - 1), indexing="ij")
    i, j = i.ravel(), j.ravel()
    i1, j1 = (i + 1) % rows, (j + 1) % columns
    a, b, c, d = i * columns + j, i1 * columns + j, i1 * columns + j1, i * columns + j1
    return np.vstack([np.column_stack([a, b, c]), np.column_stack([a, c, d])])


def merged(*parts):
    """Several surfaces as one mesh; they are not joined."""
    starts = np.cumsum([0] + [len(v) for v, _ in parts[:-1]])
    return np.vstack([v for v, _ in parts]), np.vstack([f + s for (_, f), s in zip(parts, starts)])


def sphere(radius=1.0, centre=(0, 0, 0), subdivisions=6):
    """An icosphere; 6 subdivisions have 40,962 vertices, all on the sphere."""
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.create_sphere(radius=1.0, subdiv=subdivisions)
    v = meshes.current_mesh().vertex_matrix()
    v = v / np.linalg.norm(v, axis=1, keepdims=True)
    return v * radius + np.asarray(centre), meshes.current_mesh().face_matrix()


def torus(major=1.0, minor=0.35, centre=(0, 0, 0), upright=False, around=240, across=90):
    """A torus about the z axis, or about the y axis if upright."""
    u, w = np.meshgrid(np.arange(around) * 2 * np.pi / around, np.arange(across) * 2 * np.pi / across, indexing="ij")
    ring = major + minor * np.cos(w)
    v = np.stack([ring * np.cos(u), ring * np.sin(u), minor * np.sin(w)], axis=-1).reshape(-1, 3)
    if upright:
        v = np.column_stack([v[:, 0], -v[:, 2], v[:, 1]])
    return v + np.asarray(centre), grid_faces(around, across, True, True)


def linked_tori(links=3):
    """A chain: each torus passes through the hole of the next, with gaps of the size of the tubes' radius."""
    return merged(*(torus(1.0, 0.2, (1.4 * i, 0, 0), upright=i % 2 == 1) for i in range(links)))


def two_spheres():
    """Two spheres of different size, a third of the smaller radius apart."""
    return merged(sphere(1.0), sphere(0.6, (1.8, 0, 0)))


def revolved(profile, around=256):
    """The closed surface of revolution about the z axis of a profile (radius, height) from axis to axis."""
    profile = np.asarray(profile, dtype=float)
    u = np.arange(around) * 2 * np.pi / around
    ring = profile[1:-1]
    v = np.stack([ring[:, :1] * np.cos(u), ring[:, :1] * np.sin(u), np.repeat(ring[:, 1:], around, axis=1)], axis=-1)
    v = np.vstack([v.reshape(-1, 3), [[0, 0, profile[0, 1]], [0, 0, profile[-1, 1]]]])
    k, k1 = np.arange(around), (np.arange(around) + 1) % around
    first, last, end = len(v) - 2, len(v) - 1, (len(ring) - 1) * around
    caps = [np.column_stack([np.full(around, first), k1, k]),
            np.column_stack([np.full(around, last), end + k, end + k1])]
    return v, np.vstack([grid_faces(len(ring), around, False, True)[:, ::-1]] + caps)


def turned_ring(profile, around=256):
    """The surface of revolution about the z axis of a closed profile (radius, height), counter-clockwise seen with the
    radius to the right: genus 1."""
    profile = np.asarray(profile, dtype=float)
    u = np.arange(around) * 2 * np.pi / around
    v = np.stack([profile[:, :1] * np.cos(u), profile[:, :1] * np.sin(u), np.repeat(profile[:, 1:], around, axis=1)],
                 axis=-1)
    return v.reshape(-1, 3), grid_faces(len(profile), around, True, True)[:, ::-1]


def cup(wall=0.06):
    """A drinking cup of radius 1, height 1.8 and a thin wall with a rounded rim: one closed surface of genus 0."""
    arc = np.linspace(0, np.pi, 9)
    radius = 1 - wall / 2
    corners = [(0, 0), (1, 0), (1, 1.8)]
    rim = [(radius + wall / 2 * np.cos(a), 1.8 + wall / 2 * np.sin(a)) for a in arc[1:-1]]
    inside = [(1 - wall, 1.8), (1 - wall, wall), (0, wall)]
    return revolved(refined(corners, 60) + rim + refined(inside, 60))


def refined(corners, pieces):
    """The corners of an open polygon, and between each two pieces - 1 more points."""
    points = [corners[0]]
    for a, b in zip(corners, corners[1:]):
        points += [tuple(np.add(np.multiply(a, 1 - t), np.multiply(b, t))) for t in np.linspace(0, 1, pieces + 1)[1:]]
    return points


def filleted_cube(fillet=0.2):
    """The cube [-1, 1]^3 with all edges and corners rounded by a radius of fillet."""
    core = 1 - fillet
    arc = core + fillet * np.tan(np.linspace(0, np.pi / 4, 13))[1:]
    line = np.concatenate([-arc[::-1], np.linspace(-core, core, 33), arc])
    n = len(line)
    a, b = (g.ravel() for g in np.meshgrid(line, line, indexing="ij"))
    one = np.ones_like(a)
    faces = grid_faces(n, n, False, False)
    sides = []
    for axis in range(3):
        for sign in (1, -1):
            corners = np.empty((n * n, 3))
            corners[:, axis], corners[:, (axis + 1) % 3], corners[:, (axis + 2) % 3] = sign * one, a, b
            sides.append((corners, faces if sign > 0 else faces[:, ::-1]))
    v, f = merged(*sides)
    _, index, where = np.unique(np.round(v, 9), axis=0, return_index=True, return_inverse=True)
    v, f = v[index], where.ravel()[f]
    inner = v.clip(-core, core)
    away = v - inner
    return inner + fillet * away / np.linalg.norm(away, axis=1, keepdims=True), f


def area_of(vertices, faces):
    corners = vertices[faces]
    return np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum() / 2


def combined(operation, first, *others):
    """The union of surfaces, or the difference of the first and the others."""
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(*first))
    for other in others:
        before = meshes.current_mesh_id()
        meshes.add_mesh(pymeshlab.Mesh(*other))
        getattr(meshes, f"generate_boolean_{operation}")(first_mesh=before, second_mesh=meshes.current_mesh_id())
    return meshes.current_mesh().vertex_matrix(), meshes.current_mesh().face_matrix()


def crossed_cylinders():
    """The union of three cylinders along the axes: smooth sides, creases where they meet, genus 0."""
    def along(axis):
        one = pymeshlab.MeshSet(verbose=False)
        one.create_cone(r0=0.4, r1=0.4, h=2.4 - 0.2 * axis, subdiv=128)
        return np.roll(one.current_mesh().vertex_matrix(), axis, axis=1), one.current_mesh().face_matrix()

    return combined("union", *map(along, range(3)))


# Parts with creases that are known exactly.


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


def box(low, high):
    (x0, y0, z0), (x1, y1, z1) = low, high
    return extruded([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], z0, z1, ((x0 + x1) / 2, (y0 + y1) / 2))


def cylinder(centre, radius, low, high, around=64):
    turn = np.linspace(0, 2 * np.pi, around, endpoint=False)
    outline = np.column_stack([centre[0] + radius * np.cos(turn), centre[1] + radius * np.sin(turn)])
    return extruded(outline, low, high, centre)


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
    return revolved(refined(profile, 20), 128)


def plate_with_bores():
    """A plate with four round holes."""
    bores = ((-.8, -.4, .3), (.8, -.4, .3), (-.8, .5, .2), (.6, .45, .35))
    return combined("difference", box((-1.5, -1, -.25), (1.5, 1, .25)),
                    *(cylinder((x, y), radius, -1, 1, 96) for x, y, radius in bores))


def chamfered_wedge(chamfer=.15):
    """A wedge whose thick end has two chamfered edges."""
    outline = [(0, 0), (2 - chamfer, 0), (2, chamfer), (2, 1 - chamfer), (2 - chamfer, 1), (1.4, .9)]
    return extruded(outline, 0, 1, centre=(1.4, .4))


# Closed surfaces with thin walls, each for a wall of given thickness.


def slab(wall):
    """A rectangular sheet."""
    return box((-1.5, -1, 0), (1.5, 1, wall))


def tube(wall):
    """A pipe of radius 1 and length 2.5, open at both ends: genus 1."""
    outside = refined([(1 - wall, 0), (1, 0), (1, 2.5), (1 - wall, 2.5), (1 - wall, 0)], 40)[:-1]
    return turned_ring(outside)


def nested_boxes(wall):
    """A hollow box: two components, the inner one seen from inside."""
    v, f = box((-1, -.8, -.6), (1, .8, .6))
    w, g = box((-1 + wall, -.8 + wall, -.6 + wall), (1 - wall, .8 - wall, .6 - wall))
    return merged((v, f), (w, g[:, ::-1]))


def hollow_sphere(wall):
    """Two spheres about one centre: two components."""
    v, f = sphere()
    return merged((v, f), (v * (1 - wall), f[:, ::-1]))


def blade(wall):
    """A straight blade: a lens, which tapers from the given thickness at the middle to sharp edges."""
    across = np.linspace(-1, 1, 33)
    half = wall / 2 * (1 - across ** 2)
    outline = np.vstack([np.column_stack([across, -half]), np.column_stack([across, half])[-2:0:-1]])
    return extruded(outline, 0, 2.5)


def casting(wall):
    """A plate with three ribs across and nine bores between them, all walls alike: genus 9."""
    ribs = (box((x - wall / 2, -1, wall / 2), (x + wall / 2, 1, .5)) for x in (-.75, 0, .75))
    bores = (cylinder((x, y), .15, -.2, .3) for x in (-1.125, -.375, .375) for y in (-.6, 0, .6))
    return combined("difference", combined("union", slab(wall), *ribs), *bores)


def walled(make, edges, count):
    """The shape whose wall is as thick as that many mean edges of an even mesh with count vertices, and that thickness. The
    edge depends on the area, which depends on the wall."""
    wall = .03
    for _ in range(4):
        wall = edges * np.sqrt(4 / np.sqrt(3) * area_of(*make(wall)) / (2 * count))
    return make(wall), wall


# Name: the shape for a wall, its genus and its number of components.
WALLS = {"cup": (cup, 0, 1), "slab": (slab, 0, 1), "tube": (tube, 1, 1), "nested-boxes": (nested_boxes, 0, 2),
         "hollow-sphere": (hollow_sphere, 0, 2), "blade": (blade, 0, 1), "casting": (casting, 9, 1)}
