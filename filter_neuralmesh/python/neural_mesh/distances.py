# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The distances of all points of a cloud to a mesh, chunk by chunk."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Callable, Iterable

import numpy as np

from neural_mesh.clouds import finite
from neural_mesh.library import COUNTERS, Task
from neural_mesh.mesh import Mesh


@dataclass
class Distances:
    """Of `points` points, in the units of their coordinates."""

    points: int = 0
    squares: float = 0  # the sum of the squared distances
    total: float = 0
    maximum: float = 0

    @property
    def rms(self) -> float:
        return math.sqrt(self.squares / self.points) if self.points else 0.0

    @property
    def mean(self) -> float:
        return self.total / self.points if self.points else 0.0

    def add(self, distances: np.ndarray) -> None:
        if len(distances):
            self.points += len(distances)
            self.squares += float(np.square(distances).sum())
            self.total += float(distances.sum())
            self.maximum = max(self.maximum, float(distances.max()))


def measure(mesh: Mesh, chunks: Iterable[np.ndarray], threads: int, report: Callable[[], None]) -> Distances:
    """The distances of all finite points to the nearest face of the mesh. The same for any number of threads; 0: one per
    core. `report` is called after each chunk."""
    found = Distances()
    with Task(COUNTERS) as task:
        task.set("threads", threads)
        task.set_arrays("mesh", mesh.vertices, mesh.faces)
        for points in chunks:
            found.add(task.distances(points[finite(points)]))
            report()
    return found
