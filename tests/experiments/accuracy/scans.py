# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Clouds with the defects of raw scans, made from true surfaces: virtual views, outliers, uneven density.

A view is orthographic: of the samples that fall into a pixel the one nearest to the scanner is seen, if the surface
is not too oblique there. All lengths are shares of the bounding-box diagonal, everything random is numpy's PCG64 under
a given seed.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

import models

DENSE = 2_000_000  # samples of the true surface that views choose from
OBLIQUE = .15  # cosine between normal and view below which nothing is seen
LIFT, CLUMP_RADIUS, CLUMPS, SPREAD, LARGER_BOX = .2, .01, 20, .1, 1.2


@dataclass(frozen=True)
class Level:
    """Noise along the view, misregistration of the views, and the share of points moved anywhere."""

    noise: float
    shift: float
    degrees: float
    outliers: float


LEVELS = {1: Level(.001, .0025, .25, .001), 2: Level(.003, .005, .5, .003), 3: Level(.006, .01, 1, .006)}


@dataclass
class Scan:
    points: np.ndarray
    outlier: np.ndarray  # per point
    seen: np.ndarray  # samples of the true surface that at least one view can see
    seen_normals: np.ndarray


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def rotation(axis, degrees):
    x, y, z = unit(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = np.radians(degrees)
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def view_directions(count, rng):
    """Even over the sphere (a spiral by the golden angle), turned at random."""
    i = np.arange(count) + .5
    height, turn = 1 - 2 * i / count, np.pi * (1 + 5 ** .5) * i
    ring = np.sqrt(1 - height ** 2)
    spiral = np.stack([ring * np.cos(turn), ring * np.sin(turn), height], axis=1)
    return spiral @ rotation(rng.normal(size=3), rng.uniform(0, 360)).T


def axes_of_view(direction):
    """Rows: two axes of the image plane, and the direction towards the scanner."""
    helper = np.eye(3)[np.argmin(np.abs(direction))]
    across = unit(np.cross(direction, helper))
    return np.stack([across, np.cross(direction, across), direction])


def visible(samples, normals, axes, centre, diagonal, pixels):
    """The samples that are the foremost of their pixels, and which others are about as near to the scanner."""
    local = (samples - centre) @ axes.T
    pixel = np.floor((local[:, :2] / diagonal + .5) * pixels).astype(int) @ [pixels + 1, 1]
    depth, facing = local[:, 2], normals @ axes[2] > OBLIQUE
    order = np.lexsort((-depth, pixel))
    first = np.concatenate([[True], np.diff(pixel[order]) != 0])
    foremost = order[first]
    nearest = np.full(pixel.max() + 1, -np.inf)
    nearest[pixel[foremost]] = depth[foremost]
    return foremost[facing[foremost]], facing & (depth > nearest[pixel] - 3 * diagonal / pixels)


def scan(vertices, faces, level, views=10, pixels=300, seed=1, dense=DENSE):
    """A closed mesh with its normals outwards, as seen by a scanner from all sides."""
    rng = np.random.default_rng(seed)
    diagonal, centre = models.diagonal(vertices), (vertices.max(0) + vertices.min(0)) / 2
    samples, of_face = models.sample_surface(vertices, faces, dense, rng)
    corners = vertices[faces]
    normals = unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) + 1e-300)[of_face]
    seen, parts = np.zeros(len(samples), bool), []
    for direction in view_directions(views, rng):
        axes = axes_of_view(direction)
        chosen, could_see = visible(samples, normals, axes, centre, diagonal, pixels)
        seen |= could_see
        points = samples[chosen] + rng.normal(size=(len(chosen), 1)) * level.noise * diagonal * direction
        turned = (points - centre) @ rotation(rng.normal(size=3), rng.normal() * level.degrees).T + centre
        parts.append(turned + rng.normal(size=3) * level.shift * diagonal / 3 ** .5)
    points = np.concatenate(parts)
    moved, outlier = with_moved(points, level.outliers, rng, diagonal)
    return Scan(moved, outlier, samples[seen], normals[seen])


def chosen_of(points, share, rng):
    return rng.choice(len(points), int(round(share * len(points))), replace=False)


def flagged(points, indices):
    flags = np.zeros(len(points), bool)
    flags[indices] = True
    return points, flags


def with_moved(points, share, rng, diagonal):
    """A share of the points moved by a normal distribution of a tenth of the diagonal."""
    indices, result = chosen_of(points, share, rng), points.copy()
    result[indices] += rng.normal(size=(len(indices), 3)) * SPREAD * diagonal
    return flagged(result, indices)


def with_rays(points, share, rng, diagonal):
    """A share of the points of one view drawn out towards the scanner, by up to a fifth of the diagonal."""
    indices, result = chosen_of(points, share, rng), points.copy()
    result[indices] += unit(rng.normal(size=3)) * (rng.random((len(indices), 1)) * LIFT * diagonal)
    return flagged(result, indices)


def in_larger_box(points, count, rng):
    middle, half = (points.max(0) + points.min(0)) / 2, (points.max(0) - points.min(0)) / 2
    return middle + LARGER_BOX * half * (2 * rng.random((count, 3)) - 1)


def with_box(points, share, rng, _diagonal):
    """More points, uniform in a box 20 % larger."""
    more = in_larger_box(points, int(round(share * len(points))), rng)
    return flagged(np.concatenate([points, more]), slice(len(points), None))


def with_clumps(points, share, rng, diagonal):
    """Twenty balls of points of radius 1 % of the diagonal, off the surface."""
    tree, centres = cKDTree(points), []
    while len(centres) < CLUMPS:
        centre = in_larger_box(points, 1, rng)[0]
        if tree.query(centre)[0] > 3 * CLUMP_RADIUS * diagonal:
            centres.append(centre)
    each = max(1, int(round(share * len(points) / CLUMPS)))
    inside = unit(rng.normal(size=(CLUMPS, each, 3))) * rng.random((CLUMPS, each, 1)) ** (1 / 3)
    more = (np.array(centres)[:, None] + CLUMP_RADIUS * diagonal * inside).reshape(-1, 3)
    return flagged(np.concatenate([points, more]), slice(len(points), None))


OUTLIERS = {"moved": with_moved, "box": with_box, "clumps": with_clumps, "rays": with_rays}


def with_outliers(points, kind, share, seed=1):
    """The points with outliers of a kind, and which of them are."""
    return OUTLIERS[kind](points, share, np.random.default_rng(seed), models.diagonal(points))


def thinned(vertices, faces, ratio, count=50_000, seed=1):
    """Points whose number per area falls exponentially along the longest axis, to 1/ratio at the end."""
    rng = np.random.default_rng(seed)
    points, _ = models.sample_surface(vertices, faces, 8 * count, rng)
    axis = np.argmax(np.ptp(points, axis=0))
    along = (points[:, axis] - points[:, axis].min()) / np.ptp(points[:, axis])
    weight = float(ratio) ** -along
    return points[rng.choice(len(points), count, replace=False, p=weight / weight.sum())]
