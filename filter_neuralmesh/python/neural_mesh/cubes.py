# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Space divided into cubes whose sides double in one direction at a time, and keys of the cubes of points."""

from __future__ import annotations

from typing import Optional

import numpy as np

# Odd numbers of 64 bits: the golden ratio and the factors of splitmix64 (Steele, Lea, Flood, OOPSLA 2014).
FACTORS = np.array([0x9E3779B97F4A7C15, 0xBF58476D1CE4E5B9, 0x94D049BB133111EB], dtype=np.uint64)


def joined(indices: np.ndarray) -> np.ndarray:
    """One number of three, modulo 2**64; that of a sum of indices is the sum of the numbers."""
    return sum(axis.view(np.uint64) * factor for axis, factor in zip(indices, FACTORS))


def keys_of(points: np.ndarray, origin: np.ndarray, level: int, places: Optional[np.ndarray] = None) -> np.ndarray:
    """The keys of the cubes of (n, 3) points. Cubes have the sides 2**((level + axis) // 3), one begins at the origin.
    `places`: (3, n) array that gets the points' places in their cubes, from 0 to 1."""
    keys = np.zeros(len(points), dtype=np.uint64)
    for axis, factor in enumerate(FACTORS):
        scaled = points[:, axis] - origin[axis]
        scaled *= 2.0**-((level + axis) // 3)
        index = np.floor(scaled)
        if places is not None:
            np.subtract(scaled, index, out=places[axis])
        keys += index.astype(np.int64).view(np.uint64) * factor
    return keys
