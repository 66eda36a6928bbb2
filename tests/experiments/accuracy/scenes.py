# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Virtual scans of scenes made in code, by the sensors that people use: a room seen from inside by a turning scanner or a
depth camera, and ground seen from above through trees. Each is an open_surfaces.Case: the cloud, points of what the sensor
sees, to measure forward from, and the whole scene, to measure backward to.

A room is made of boxes, which rays are cast at exactly. Lengths are metres, everything random is numpy's PCG64 under a
given seed.
"""

import numpy as np

import open_surfaces
import shapes
from models import sample_surface
from scans import unit

SEEN = 20_000  # samples to measure forward from
ROOM = (6, 4.5, 2.6)


def room_boxes(rng):
    """Low and high corners of boxes; the first is the room, seen from inside, the others stand in it."""
    x, y = rng.uniform((2, 1.2), (3.4, 2.4))
    table = [((x, y, .7), (x + 1.4, y + .8, .74))]
    legs = [((x + a, y + b, 0), (x + a + .05, y + b + .05, .7)) for a in (.03, 1.32) for b in (.03, .72)]
    shelf = [((0, .4, z), (.32, 1.8, z + .03)) for z in (.1, .7, 1.3)] + [((0, y, 0), (.32, y + .03, 1.6))
                                                                          for y in (.37, 1.8)]
    others = [((4.6, .4, 0), (5.5, 2.4, .42)), ((5.5, .4, 0), (5.8, 2.4, .85)), ((2.4, 4.2, 0), (3.4, 4.5, 2)),
              ((x + .5, y + .3, .74), (x + .8, y + .5, .95))]
    return np.array([((0, 0, 0), ROOM), *table, *legs, *shelf, *others], dtype=float)


def surface_of(boxes):
    """The faces of all boxes, the first turned inwards."""
    corners = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)])
    faces = np.array([(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4), (2, 6, 3), (3, 6, 7), (0, 4, 2),
                      (2, 4, 6), (1, 3, 5), (3, 7, 5)])
    return shapes.merged(*((low + corners * (high - low), faces if i else faces[:, ::-1])
                           for i, (low, high) in enumerate(boxes)))


def depths(boxes, eye, directions):
    """How far rays of unit directions go from the eye, and how squarely they hit. O(rays x boxes)"""
    with np.errstate(divide="ignore"):
        inverse = 1 / np.where(np.abs(directions) < 1e-12, 1e-12, directions)
    best, square = np.full(len(directions), np.inf), np.zeros(len(directions))
    for i, (low, high) in enumerate(boxes):
        to_low, to_high = (low - eye) * inverse, (high - eye) * inverse
        entries, exits = np.minimum(to_low, to_high), np.maximum(to_low, to_high)
        axis = np.argmax(entries, axis=1) if i else np.argmin(exits, axis=1)
        entry, leaving = entries.max(axis=1), exits.min(axis=1)
        depth = entry if i else leaving
        hit = (entry < leaving) & (depth > 0) & (depth < best)
        best = np.where(hit, depth, best)
        square = np.where(hit, np.abs(directions[np.arange(len(axis)), axis]), square)
    return best, square


def with_mixed(image, rng, jump, share):
    """Some pixels beside a jump of the depth get a depth between those of its two sides."""
    mixed = (np.abs(np.diff(image, axis=1)) > jump) & (rng.random((len(image), image.shape[1] - 1)) < share)
    part = rng.random(mixed.shape)
    result = image.copy()
    result[:, :-1][mixed] = (image[:, :-1] * part + image[:, 1:] * (1 - part))[mixed]
    return result


def turning_scanner(boxes, eye, rng, step=1.2, noise=.002):
    """Even steps of both angles, so the density falls with the squared distance."""
    up, around = np.meshgrid(np.radians(np.arange(-60, 80, step)), np.radians(np.arange(0, 360, step)), indexing="ij")
    directions = np.stack([np.cos(up) * np.cos(around), np.cos(up) * np.sin(around), np.sin(up)], axis=-1)
    depth, square = depths(boxes, eye, directions.reshape(-1, 3))
    depth = depth + rng.normal(size=len(depth)) * noise * (1 + .15 / np.maximum(square, .1))
    depth = with_mixed(depth.reshape(up.shape), rng, .15, .25)
    return eye + (directions * depth[..., None]).reshape(-1, 3)


def depth_camera(boxes, eye, target, rng, pixels=(200, 150), view=57):
    """One frame. The noise grows with the squared depth, which has steps; nothing returns from far and oblique places."""
    ahead = unit(np.subtract(target, eye))
    across = unit(np.cross(ahead, (0, 0, 1)))
    width, height = pixels
    focus = width / 2 / np.tan(np.radians(view / 2))
    u, v = np.meshgrid((np.arange(width) + .5 - width / 2) / focus, (np.arange(height) + .5 - height / 2) / focus)
    rays = np.stack([u, v, np.ones_like(u)], axis=-1).reshape(-1, 3) @ np.stack([across, np.cross(ahead, across), ahead])
    distance, square = depths(boxes, np.array(eye), unit(rays))
    depth = distance / np.linalg.norm(rays, axis=1)
    seen = (depth > .4) & (depth < 5) & (square > .17)
    depth = depth + rng.normal(size=len(depth)) * (.0012 + .0019 * (depth - .4) ** 2)
    steps = 585 * .075 * 8  # of the disparity: focus in pixels, base, parts of a pixel
    depth = with_mixed((steps / np.round(steps / depth)).reshape(height, width), rng, .08, .3).ravel()
    return (eye + rays * depth[:, None])[seen]


def in_sight(boxes, eyes, points):
    seen = np.zeros(len(points), bool)
    for eye in eyes:
        way = points - eye
        length = np.linalg.norm(way, axis=1)
        seen |= depths(boxes, np.array(eye), way / length[:, None])[0] > length - 1e-6
    return seen


def room_case(cloud, boxes, eyes, rng, reach):
    """What the eyes see of the room within reach."""
    vertices, faces = surface_of(boxes)
    samples, _ = sample_surface(vertices, faces, 5 * SEEN, rng)
    near = samples[open_surfaces.cKDTree(cloud).query(samples)[0] < reach]
    seen = near[in_sight(boxes, eyes, near)]
    area = shapes.area_of(vertices, faces) * len(seen) / len(samples)
    return open_surfaces.Case(cloud, seen[:SEEN], (vertices, faces), area)


def scanned_room(seed=1):
    """Two stations that meet within some millimetres."""
    rng = np.random.default_rng(seed)
    boxes, eyes = room_boxes(rng), ((2.6, 3.5, 1.4), (4.0, 1.0, 1.5))
    parts = [turning_scanner(boxes, np.array(eye), rng) for eye in eyes]
    cloud = np.concatenate([parts[0], parts[1] + rng.normal(size=3) * .002])
    return room_case(cloud, boxes, eyes, rng, .1)


def framed_room(seed=1):
    rng = np.random.default_rng(seed)
    boxes, eye = room_boxes(rng), (.9, .6, 1.5)
    return room_case(depth_camera(boxes, eye, (4.5, 3, .7), rng), boxes, [eye], rng, .1)


def relief(rng, size=120):
    """Hills on a square of 100 metres."""
    x, y = np.meshgrid(np.linspace(0, 100, size), np.linspace(0, 100, size), indexing="ij")
    z = np.zeros_like(x)
    for octave in range(1, 6):
        for _ in range(4):
            a, b, phase = rng.normal(size=2).tolist() + [rng.uniform(0, 6.3)]
            z += 6 / octave ** 2 * np.sin(.03 * octave * (a * x + b * y) + phase)
    return np.column_stack([x.ravel(), y.ravel(), z.ravel()]), shapes.grid_faces(size, size, False, False)


def ground_under_trees(seed=1, points=40_000, trees=40):
    """Two strips of an aerial scan, .08 m apart in height, and crowns that fill with returns and hide some ground."""
    rng = np.random.default_rng(seed)
    vertices, faces = relief(rng)
    samples, _ = sample_surface(vertices, faces, points, rng)
    crowns, _ = sample_surface(vertices, faces, trees, rng)
    cloud = samples + rng.normal(size=samples.shape) * .05
    cloud[len(cloud) // 2:, 2] += .08
    hidden = open_surfaces.cKDTree(crowns[:, :2]).query(cloud[:, :2])[0] < 3
    cloud = cloud[~hidden | (rng.random(len(cloud)) < .3)]
    leaves = [crown + (0, 0, 7) + unit(rng.normal(size=(n, 3))) * rng.random((n, 1)) ** (1 / 3) * (3, 3, 4)
              for crown, n in zip(crowns, rng.integers(60, 200, trees))]
    return open_surfaces.Case(np.concatenate([cloud, *leaves]), samples[:SEEN], (vertices, faces),
                              shapes.area_of(vertices, faces))


SCENES = {"room, turning scanner": scanned_room, "room, depth camera": framed_room, "ground, from above": ground_under_trees}
