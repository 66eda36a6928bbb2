# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Lets the points of a sample stand for all points of the cloud, in one more pass over it.

Space is divided into cubes that hold some points of the sample each. Where the cloud is flat within a cube, the points
of the sample in it are moved together along the normal, so that their mean lies on that of all points of the cloud. The
noise of the mean is then that of all points. Number, spread and density of the sample stay as they are. Points at edges
and between walls are not moved."""

from __future__ import annotations

import numpy as np

from neural_mesh.clouds import finite
from neural_mesh.cubes import keys_of

PER_CUBE = 32  # points of the sample in a cube, in the mean, at most: some half of an edge of the mesh
WIDER = 12  # levels at most: a sample of few points may lie in few cubes at any level
FEWEST = 16  # points of the cloud in a cube, to tell its normal
# Flat: the variance along the normal is at most this part of the next smaller one (1/2 at a right edge), ...
THICKEST = .3
# ... and at most so many times the median of all flat cubes: more is shape, not noise.
ROUGHEST = 3
# Places in a cube are whole numbers up to this, so that sums of 2**25 products are exact in double precision: they do
# not depend on chunks.
STEPS = 2.0**14
POINT_BYTES = 130  # for each point of the sample, at most: while its cubes are found
SWEEPS = 6  # of rotations; four suffice for all but a few matrices
PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))


class _Moments:
    """Of the places of points in cubes: their number, sums, and sums of products."""

    def __init__(self, keys: np.ndarray) -> None:
        self.keys = keys  # sorted
        self.counts, self._sums = np.zeros(len(keys)), np.zeros((3, len(keys)))
        self._products = np.zeros((len(PAIRS), len(keys)))

    def add(self, keys: np.ndarray, places: np.ndarray) -> None:
        """Adds points by the keys of their cubes; other cubes are ignored."""
        order = np.argsort(keys)
        keys = keys[order]
        starts = np.flatnonzero(np.concatenate([[True], keys[1:] != keys[:-1]]))
        found = np.minimum(np.searchsorted(self.keys, keys[starts]), len(self.keys) - 1)
        known = self.keys[found] == keys[starts]
        found = found[known]
        places = [np.rint(place[order] * STEPS) for place in places]
        self.counts[found] += np.diff(starts, append=len(keys))[known]
        for sums, place in zip(self._sums, places):
            sums[found] += np.add.reduceat(place, starts)[known]
        for sums, (one, other) in zip(self._products, PAIRS):
            sums[found] += np.add.reduceat(places[one] * places[other], starts)[known]

    def means(self, cubes: np.ndarray) -> np.ndarray:
        """Of the cubes with these indices, which must have points."""
        return self._sums[:, cubes] / self.counts[cubes]

    def flat(self, steps: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The indices of the flat cubes and their normals. `steps`: the lengths that places count."""
        enough = np.flatnonzero(self.counts >= FEWEST)
        counts, sums = self.counts[enough], self._sums[:, enough]
        covariances = np.empty((3, 3, len(enough)))
        for products, (one, other) in zip(self._products, PAIRS):
            covariances[one, other] = covariances[other, one] = (
                products[enough] / counts - sums[one] * sums[other] / counts**2) * steps[one] * steps[other]
        least, middle, normals = _least_axes(covariances)
        thin = least <= THICKEST * middle
        chosen = thin & (least <= ROUGHEST * np.median(least[thin])) if thin.any() else thin
        return enough[chosen], normals[:, chosen]


def _least_axes(matrices: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The least and the middle eigenvalue of (3, 3, n) symmetric matrices, which are overwritten, and the unit vectors
    of the least: by Jacobi's rotations, because numpy's eigh() gives other last bits on other processors."""
    a = matrices
    axes = np.zeros_like(a)
    axes[range(3), range(3)] = 1
    for one, other in SWEEPS * ((0, 1), (0, 2), (1, 2)):
        off, third = a[one, other].copy(), 3 - one - other
        with np.errstate(all="ignore"):  # no angle where nothing is left to turn
            half = (a[other, other] - a[one, one]) / (2 * off)
            tangent = np.where(off == 0, 0, np.copysign(1 / (np.abs(half) + np.sqrt(half * half + 1)), half))
        cosine = 1 / np.sqrt(tangent * tangent + 1)
        sine = tangent * cosine
        a[one, one] -= tangent * off
        a[other, other] += tangent * off
        a[one, other] = a[other, one] = 0
        for row in (a[third], *axes):
            row[one], row[other] = cosine * row[one] - sine * row[other], sine * row[one] + cosine * row[other]
        a[one, third], a[other, third] = a[third, one], a[third, other]
    values = a[range(3), range(3)]
    least, middle, _ = np.sort(values, axis=0)
    return least, middle, axes[:, values.argmin(axis=0), np.arange(a.shape[2])]


class Averages:
    """add() all points of the cloud, then move() the sample."""

    def __init__(self, sample: np.ndarray, level: int) -> None:
        """`sample`: an (n, 3) array, n > 0. `level`: of cubes (cubes.py) that are too small, if any."""
        self._sample, self._origin = sample, sample[0].copy()
        self._level = self._widest(level)
        sides = np.array([2.0**((self._level + axis) // 3) for axis in range(3)])
        # Not at a point: where cubes meet within the noise of a wall, the number of points in each is not averaged.
        self._origin -= sides / 2
        self._steps = sides / STEPS
        keys, places = self._keys_and_places(sample)
        self._of_all = _Moments(np.unique(keys))
        self._of_sample = _Moments(self._of_all.keys)
        self._cubes = np.searchsorted(self._of_all.keys, keys).astype(np.int32)  # of each point of the sample
        self._of_sample.add(keys, places)

    def _widest(self, level: int) -> int:
        """The last level with at most PER_CUBE points of the sample in a cube, in the mean."""
        for wider in range(level + 1, level + WIDER):
            keys = np.sort(keys_of(self._sample, self._origin, wider))
            if (np.count_nonzero(keys[1:] != keys[:-1]) + 1) * PER_CUBE < len(keys):
                return wider - 1
        return level

    def _keys_and_places(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        places = np.empty((3, len(points)))
        return keys_of(points, self._origin, self._level, places), places

    def add(self, points: np.ndarray) -> None:
        """Adds the next points of the cloud, an (n, 3) array. Those that are not finite are ignored."""
        points = points[finite(points)]
        if len(points):
            self._of_all.add(*self._keys_and_places(points))

    def move(self) -> int:
        """Moves the points of the sample. Returns how many lie where the cloud is flat."""
        flat, normals = self._of_all.flat(self._steps)
        differences = (self._of_all.means(flat) - self._of_sample.means(flat)) * self._steps[:, None]
        shifts = np.zeros((3, len(self._of_all.keys)))
        shifts[:, flat] = normals * (normals * differences).sum(axis=0)
        for axis, shift in enumerate(shifts):
            self._sample[:, axis] += shift[self._cubes]
        return int(self._of_sample.counts[flat].sum())
