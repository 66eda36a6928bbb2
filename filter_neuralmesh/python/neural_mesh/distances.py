# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The distances of all points of a cloud to a mesh: chunk by chunk, in processes that hold the mesh each."""

from __future__ import annotations

import math
import multiprocessing
import os
from collections import deque
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Iterable, Iterator

import numpy as np

from neural_mesh.clouds import finite
from neural_mesh.worker import end_with

POINT_BYTES = 350  # for each point of a chunk in a process: the layer, its order, the copies on the way
VERTEX_BYTES = 800  # for each vertex of the mesh in a process: the mesh and pymeshlab's grid of its faces
# Chunks are sorted into cubes of this part of their box: neighbours find their faces in the processor's cache, which
# makes pymeshlab's search three times as fast.
CUBES = 200


class Unmeasured(Exception):
    """A sentence that says why the distances are not known."""


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

    def add(self, other: "Distances") -> None:
        self.points += other.points
        self.squares += other.squares
        self.total += other.total
        self.maximum = max(self.maximum, other.maximum)


def measure(mesh: Path, chunks: Iterable[np.ndarray], reach: float, workers: int,
            report: Callable[[], None]) -> Distances:
    """The exact distances of all finite points to the nearest face of the mesh. `reach`: more than any of them.
    The same for any number of workers. `report` is called after each chunk. Throws Unmeasured."""
    found = Distances()
    context = multiprocessing.get_context("spawn")  # a fork would copy the threads' locks of OpenMP
    try:
        with ProcessPoolExecutor(workers, context, _load, (str(mesh), os.getpid())) as pool:
            for part in _in_order(pool, chunks, reach, workers):
                found.add(part)
                report()
    except BrokenProcessPool:
        raise Unmeasured("The distances of the points are not known: a process that measured them has died, probably "
                         "for lack of memory.") from None
    return found


def _in_order(pool: ProcessPoolExecutor, chunks: Iterable[np.ndarray], reach: float,
              workers: int) -> Iterator[Distances]:
    """Results in the order of the chunks; at most one chunk more than workers is under way, which bounds memory."""
    under_way: deque[Future] = deque()
    for points in chunks:
        if len(under_way) > workers:
            yield under_way.popleft().result()
        under_way.append(pool.submit(_measure, points, reach))
    while under_way:
        yield under_way.popleft().result()


_meshes = None  # of a worker: one layer, the mesh


def _load(mesh: str, parent: int) -> None:
    global _meshes
    end_with(parent)
    import pymeshlab
    _meshes = pymeshlab.MeshSet(verbose=False)
    _meshes.load_new_mesh(mesh)


def _measure(points: np.ndarray, reach: float) -> Distances:
    import pymeshlab
    points = points[finite(points)]
    if not len(points):
        return Distances()
    low = points.min(axis=0)
    side = max((points.max(axis=0) - low).max() / CUBES, 1e-300)
    cubes = ((points - low) / side).astype(np.int32) @ np.array([CUBES * CUBES, CUBES, 1], dtype=np.int32)
    _meshes.add_mesh(pymeshlab.Mesh(points[np.argsort(cubes, kind="stable")]))
    found = _meshes.get_hausdorff_distance(sampledmesh=_meshes.current_mesh_id(), targetmesh=0, samplevert=True,
                                           sampleedge=False, sampleface=False, samplenum=len(points),
                                           maxdist=pymeshlab.PureValue(reach))
    _meshes.delete_current_mesh()
    if found["n_samples"] != len(points):
        raise Unmeasured("The distances of the points are not known: pymeshlab measured "
                         f"{found['n_samples']} of {len(points)} in a part.")
    return Distances(len(points), found["RMS"]**2 * len(points), found["mean"] * len(points), found["max"])
