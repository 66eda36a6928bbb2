# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""A sample of a cloud that passes by once, in bounded memory, more even than the cloud.

Space is divided into cubes. Of each cube the points of least priority are held; a priority is a hash of the point's
number in the file. When more points are held than allowed, the cubes double, in one direction at a time. The least of
two cubes are among the least of each, so what is held depends on the file only, not on the chunks in which it came
(bottom-k sampling: Cohen and Kaplan, PODC 2007). At the end each cube is thinned at a rate that follows from the number
of points in and around it."""

from __future__ import annotations

import math
from itertools import product
from typing import Optional

import numpy as np

from neural_mesh.clouds import finite
from neural_mesh.cubes import FACTORS, joined, keys_of

# Points held of a cube, of which some 8 to 16 are taken. The last priority says how many the cube had, within 18 %.
MOST = 32
# The sample's density is this power of the cloud's: 1 would keep the cloud's, 0 makes all parts alike, and noise across
# the surface as dense far off as on it. 1/2 comes closest to learning all points; the filter evens out the rest
# (tests/bench/stream_sampling.py).
POWER = .5
# A part that is so many times sparser than the median is not told from outliers. The filter itself evens out 100:1.
SPARSEST = 300
# Cubes along the widest side of the cloud at most: finer than any scanner, and far within the range of int64.
FINEST = 2.0**40
HASHES = 2**32  # priorities are less
HOLD_BYTES = 110  # for each point of the capacity, with room for new points and what a choice needs
CHUNK_BYTES = 200  # for each point of a chunk while it is added, also to averages.py


def priorities(numbers: np.ndarray) -> np.ndarray:
    """A hash of each number: the upper half of splitmix64."""
    x = (numbers + np.uint64(1)) * FACTORS[0]
    x ^= x >> np.uint64(30)
    x *= FACTORS[1]
    x ^= x >> np.uint64(27)
    x *= FACTORS[2]
    x ^= x >> np.uint64(31)
    return (x >> np.uint64(32)).astype(np.uint32)


class _Cubes:
    """The cubes of some points, in the order of their keys."""

    def __init__(self, keys: np.ndarray, priority: np.ndarray) -> None:
        self._order = np.argsort(keys)
        keys = keys[self._order]
        new = np.ones(len(keys), dtype=bool)
        np.not_equal(keys[1:], keys[:-1], out=new[1:])
        starts = np.flatnonzero(new)
        self.keys = keys[starts]
        del keys
        self._sizes = np.diff(starts, append=len(new))
        # Sorted by cube, then by priority, to find the k-th of each.
        ranked = np.cumsum(new, dtype=np.uint64) << np.uint64(32)
        ranked |= priority[self._order]
        ranked.sort()
        self.full = self._sizes >= MOST
        # Points of higher priority than `last` are not held.
        self.last = np.full(len(starts), HASHES - 1, dtype=np.uint32)
        self.last[self.full] = (ranked[starts[self.full] + MOST - 1]).astype(np.uint32)  # the lower half
        self.held = np.minimum(self._sizes, MOST)

    def up_to(self, highest: np.ndarray, priority: np.ndarray) -> np.ndarray:
        """Which points have at most the priority given for their cube."""
        mask = np.empty(len(priority), dtype=bool)
        mask[self._order] = priority[self._order] <= np.repeat(highest, self._sizes)
        return mask

    def counts(self) -> np.ndarray:
        """How many points each cube had: as many as are held, or an unbiased estimate from the last of them."""
        return np.where(self.full, (MOST - 1) * (HASHES / (self.last + 1.0)), self.held)

    def around(self, counts: np.ndarray) -> np.ndarray:
        """The sum of the counts of each cube and its 26 neighbours."""
        sums = np.zeros(len(counts))
        for step in product((-1, 0, 1), repeat=3):
            wanted = self.keys + joined(np.array(step, dtype=np.int64)[:, None])
            found = np.minimum(np.searchsorted(self.keys, wanted), len(counts) - 1)
            sums += np.where(self.keys[found] == wanted, counts[found], 0)
        return sums


class _Full:
    """The last priorities of the cubes that are full, in a table by the upper bits of their keys."""

    ROOM = 8  # places of the table for a cube

    def __init__(self, keys: np.ndarray, last: np.ndarray) -> None:
        """`keys` are sorted."""
        self._shift = np.uint64(64 - max(1, math.ceil(math.log2(self.ROOM * max(len(keys), 1)))))
        self._keys = np.zeros(1 << (64 - int(self._shift)), dtype=np.uint64)
        self._last = np.full(len(self._keys), HASHES - 1, dtype=np.uint32)
        places = keys >> self._shift
        self._keys[places], self._last[places] = keys, last
        # Of those with the same place the table has one.
        left = self._keys[places] != keys
        self._left_keys, self._left_last = keys[left], last[left]

    def below(self, keys: np.ndarray, priority: np.ndarray) -> np.ndarray:
        """The indices of the points, by their keys and priorities, that are not above the last of a full cube."""
        places = keys >> self._shift
        in_table = self._keys[places] == keys
        below = priority <= self._last[places]
        below[~in_table] = True
        if len(self._left_keys):
            others = np.flatnonzero(~in_table)
            found = np.minimum(np.searchsorted(self._left_keys, keys[others]), len(self._left_keys) - 1)
            below[others] = (self._left_keys[found] != keys[others]) | (priority[others] <= self._left_last[found])
        return np.flatnonzero(below)


class EvenSample:
    """add() all points, then take() the sample."""

    def __init__(self, limit: int, capacity: int, chunk: int) -> None:
        """Samples about `limit` points at most, from `capacity`, better twice to four times as many, that are held
        between chunks of at most `chunk` points."""
        self._limit = limit
        self._capacity = capacity
        # The more room for new points, the fewer choices.
        self._points = np.empty((capacity + max(chunk, capacity // 4), 3))
        self._numbers = np.empty(len(self._points), dtype=np.uint64)  # in the file
        self._held = 0
        self.level: Optional[int] = None  # of the cubes (cubes.py); None: all points are held
        self._full = _Full(np.empty(0, np.uint64), np.empty(0, np.uint32))
        self._origin = np.zeros(3)
        self.low, self.high = np.full(3, np.inf), np.full(3, -np.inf)  # the box of all points
        self.seen = 0
        self.skipped = 0  # points with NaN or infinite coordinates

    def add(self, points: np.ndarray) -> None:
        """Adds the next points of the file, an (n, 3) array."""
        numbers = np.arange(self.seen, self.seen + len(points), dtype=np.uint64)
        self.seen += len(points)
        self.skipped += len(points)
        wanted = finite(points)
        points, numbers = points[wanted], numbers[wanted]
        self.skipped -= len(points)
        if not len(points):
            return
        if self.seen - self.skipped == len(points):  # the first
            self._origin = points[0].copy()
        for axis, column in enumerate(points.T):  # much faster than numpy's reduction of rows
            self.low[axis], self.high[axis] = min(self.low[axis], column.min()), max(self.high[axis], column.max())
        if self.level is not None:
            wanted = self._full.below(self._keys(points, self.level), priorities(numbers))
            points, numbers = points[wanted], numbers[wanted]
        if self._held + len(points) > len(self._points):
            self._choose(self._capacity)
        end = self._held + len(points)
        self._points[self._held:end] = points
        self._numbers[self._held:end] = numbers
        self._held = end

    def take(self) -> np.ndarray:
        """The sample in the order of the file: all points, if they are no more than the limit. Of the points that lie
        apart from others the same share is taken as of all points, so that outliers gain no weight. Ends the sample."""
        if self.level is not None or self._held > self._limit:
            # A cloud that could be held whole needs cubes of several points, too.
            self._choose(min(self._capacity, .9 * (self.seen - self.skipped)))
            priority = priorities(self._numbers[:self._held])
            cubes = self._cubes(self.level, priority)
            highest = np.minimum(self._rates(cubes) * HASHES, HASHES - 1).astype(np.uint32)
            self._keep(cubes.up_to(highest, priority))
        points = self._points[:self._held][np.argsort(self._numbers[:self._held])]
        self._points, self._numbers = np.empty((0, 3)), np.empty(0, np.uint64)
        return points

    def _rates(self, cubes: _Cubes) -> np.ndarray:
        """The share of points to take of each cube: by a power of the number around it, scaled to meet the limit."""
        counts = cubes.counts()
        around = cubes.around(counts)
        order = np.argsort(around)
        half_of_points = np.searchsorted(np.cumsum(counts[order]), counts.sum() / 2)
        apart = around * SPARSEST < around[order[half_of_points]]
        share = self._limit / (self.seen - self.skipped)
        low, high = 0.0, float((around**(1 - POWER)).max())
        for _ in range(50):  # bisection; more would not change the number of points
            middle = (low + high) / 2
            rates = np.where(apart, share, np.minimum(1, middle / around**(1 - POWER)))
            too_many = np.minimum(counts * rates, cubes.held).sum() > self._limit
            low, high = (low, middle) if too_many else (middle, high)
        return rates

    def _choose(self, bound: float) -> None:
        """Doubles the cubes as often as the bound asks, and drops the points above the last of each cube."""
        priority = priorities(self._numbers[:self._held])
        cubes = self._smallest_cubes(priority, bound)
        self._full = _Full(cubes.keys[cubes.full], cubes.last[cubes.full])
        self._keep(cubes.up_to(cubes.last, priority))

    def _smallest_cubes(self, priority: np.ndarray, bound: float) -> _Cubes:
        """Sets the level to the least, not below the present one, with which at most `bound` points are held. A level
        that suffices for all points suffices for the first of them, so the last level is the same for any chunks."""
        widest = max((self.high - self.low).max(), 1e-300)
        finest = 3 * math.ceil(math.log2(widest / FINEST))
        if self.level is None:
            # Near the level found, if the points are of a surface.
            level = max(finest, 3 * math.ceil(math.log2(widest / math.sqrt(self._capacity / MOST))))
        else:
            level = finest = max(finest, self.level)
        cubes = self._cubes(level, priority)
        while cubes.held.sum() > bound:
            level += 1
            finest = level  # finer ones hold too many
            cubes = self._cubes(level, priority)
        while level > finest:
            finer = self._cubes(level - 1, priority)
            if finer.held.sum() > bound:
                break
            level, cubes = level - 1, finer
        self.level = level
        return cubes

    def _cubes(self, level: int, priority: np.ndarray) -> _Cubes:
        return _Cubes(self._keys(self._points[:self._held], level), priority)

    def _keys(self, points: np.ndarray, level: int) -> np.ndarray:
        return keys_of(points, self._origin, level)

    def _keep(self, mask: np.ndarray) -> None:
        """Moves the points of the mask together, a part at a time, because a copy of all would double the memory."""
        end, part = 0, 1 << 20
        for first in range(0, self._held, part):
            chosen = np.flatnonzero(mask[first:first + part]) + first
            self._points[end:end + len(chosen)] = self._points[chosen]
            self._numbers[end:end + len(chosen)] = self._numbers[chosen]
            end += len(chosen)
        self._held = end
