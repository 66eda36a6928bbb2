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


def crossed_cylinders():
    """The union of three cylinders along the axes: smooth sides, creases where they meet, genus 0."""
    meshes = pymeshlab.MeshSet(verbose=False)
    for axis in range(3):
        one = pymeshlab.MeshSet(verbose=False)
        one.create_cone(r0=0.4, r1=0.4, h=2.4 - 0.2 * axis, subdiv=128)
        cylinder = one.current_mesh()
        meshes.add_mesh(pymeshlab.Mesh(np.roll(cylinder.vertex_matrix(), axis, axis=1), cylinder.face_matrix()))
    meshes.generate_boolean_union(first_mesh=0, second_mesh=1)
    meshes.generate_boolean_union(first_mesh=meshes.current_mesh_id(), second_mesh=2)
    mesh = meshes.current_mesh()
    return mesh.vertex_matrix(), mesh.face_matrix()
