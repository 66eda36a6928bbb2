# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Reconstructs the surface of a cloud that need not fit into memory: learns from an even sample of its points, then
measures the distances of all its points to the mesh."""

from __future__ import annotations

import argparse
import contextlib
import math
import os
import signal
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Iterable, Iterator, Optional

import numpy as np

from neural_mesh import Mesh, reconstruct
from neural_mesh.averages import POINT_BYTES as AVERAGED_BYTES
from neural_mesh.averages import Averages
from neural_mesh.batch_files import aside_of, remove, remove_left
from neural_mesh.clouds import FORMATS, Cloud, CloudError, finite, open_cloud
from neural_mesh.even_sample import CHUNK_BYTES, HOLD_BYTES, EvenSample
from neural_mesh.files import NotWhole, save_aside
from neural_mesh.library import COUNTERS, Task
from neural_mesh.mesh_writers import WRITERS
from neural_mesh.parameters import (Settings, WrongUsage, check, check_space, gigabytes, line_of, memory_size,
                                    settings_of)

PER_VERTEX = 100  # points of the sample for each vertex wanted
FEWEST_PER_VERTEX = 10  # with fewer the mesh suffers
HELD = 4  # points held while reading for each of the sample, at most
# Bytes, measured with 1 to 10 million points and 10,000 to 100,000 vertices (tests/bench/stream.py), rounded up.
PROCESS = 120e6  # Python with numpy and pymeshlab
LEARNED_POINT = 220
LEARNED_VERTEX = 1500
SAVED_VERTEX = 200  # of a file, with its two faces
MEASURED_VERTEX = 600  # the mesh and the tree of its faces: 330 with a million vertices
CHUNK, SMALL_CHUNK = 500_000, 50_000  # points; smaller ones would save less than 10 MB
CHUNKS_SHARE = 15  # one of so many parts of the memory is for a chunk, the others are for the sample


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("cloud", type=Path, help=f"a file of points: {' '.join(FORMATS)}")
    parser.add_argument("mesh", type=Path, help=f"the file to write: {' '.join(WRITERS)}")
    parser.add_argument("settings", nargs="*", metavar="name=value", help="parameters of the filter, such as "
                        "target_vertices=100000")
    parser.add_argument("--memory", type=memory_size, default="2GB", metavar="SIZE", help="what the command may take, "
                        "such as 500MB or 16GB; default: %(default)s")


def run(given: argparse.Namespace) -> int:
    settings = settings_of(given.settings)
    values = check(settings)
    if given.mesh.suffix.lower() not in WRITERS:
        raise WrongUsage(f"{given.mesh} cannot be written: stream writes {', '.join(WRITERS)}, which keep "
                         "coordinates in double precision.")
    if given.mesh.exists() and given.cloud.exists() and given.mesh.samefile(given.cloud):
        raise WrongUsage(f"The mesh {given.mesh} would replace its cloud: give another name.")
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # as Ctrl-C: removes what is written aside
    try:
        cloud = open_cloud(given.cloud)
        plan = plan_for(given.memory, values["target_vertices"], cloud.count)
        with _aside(given.mesh) as aside:
            check_space(given.mesh.parent, plan.file_bytes(), "The mesh")
            print(plan.sentence(), flush=True)
            _Stream(cloud, plan, aside, values["threads"]).run(settings, given.mesh)
    except (CloudError, NotWhole, ValueError) as error:
        sentence = str(error)
    except OSError as error:
        sentence = f"{error.filename or given.mesh} cannot be written: {error.strerror}."
    except MemoryError:
        sentence = "There is not enough memory: close other programs, or give a smaller --memory."
    else:
        return 0
    print(f"neural-mesh: {sentence}", file=sys.stderr)
    return 1


@dataclass
class Plan:
    """What is held at a time, in points."""

    target: int
    sample: int
    held: int
    chunk: int
    memory: float

    def reading_bytes(self) -> float:
        return PROCESS + HOLD_BYTES * self.held + CHUNK_BYTES * self.chunk

    def averaging_bytes(self) -> float:
        return PROCESS + AVERAGED_BYTES * self.sample + CHUNK_BYTES * self.chunk

    def learning_bytes(self) -> float:
        return PROCESS + LEARNED_POINT * self.sample + LEARNED_VERTEX * self.target

    def measuring_bytes(self) -> float:
        return PROCESS + MEASURED_VERTEX * self.target + CHUNK_BYTES * self.chunk

    def file_bytes(self) -> float:
        return SAVED_VERTEX * self.target

    def bytes(self) -> float:
        return max(self.reading_bytes(), self.averaging_bytes(), self.learning_bytes(), self.measuring_bytes())

    def sentence(self) -> str:
        return (f"This will take up to {gigabytes(self.bytes())} of the {gigabytes(self.memory)} allowed: a sample of "
                f"about {self.sample:,} points ({self.sample / self.target:.0f} per vertex), chunks of {self.chunk:,} "
                "points.")


def plan_for(memory: float, target: int, count: Optional[int]) -> Plan:
    """The largest sample that memory allows. `count`: of the cloud's points, None if not known. Throws WrongUsage if memory
    is too small for the vertices."""
    chunk = int(min(max((memory - PROCESS) / (CHUNKS_SHARE * CHUNK_BYTES), SMALL_CHUNK), CHUNK))
    known = float("inf") if count is None else count
    learnable = (memory - PROCESS - LEARNED_VERTEX * target) / LEARNED_POINT
    holdable = (memory - PROCESS - CHUNK_BYTES * chunk) / HOLD_BYTES
    sample = int(min(PER_VERTEX * target, known, learnable, holdable))
    plan = Plan(target, sample, int(min(HELD * max(sample, 1), known, holdable)), chunk, memory)
    fewest = int(min(FEWEST_PER_VERTEX * target, known))
    if sample < fewest or plan.measuring_bytes() > memory:
        least = Plan(target, fewest, fewest, SMALL_CHUNK, 0)
        raise WrongUsage(f"{target:,} vertices need {gigabytes(least.bytes() * 1.01)} of memory, and "
                         f"{gigabytes(memory)} are allowed: give a larger --memory or a smaller target_vertices.")
    return plan


@contextlib.contextmanager
def _aside(mesh: Path) -> Iterator[Path]:
    """The file for the mesh until it is whole, removed at the end. Throws WrongUsage."""
    if mesh.is_dir():
        raise WrongUsage(f"{mesh} is a folder: give the name of a file.")
    remove_left(mesh)
    aside = aside_of(mesh, os.getpid())
    try:
        aside.touch()
    except OSError as error:
        raise WrongUsage(f"Nothing can be written into the folder {mesh.parent}: {error.strerror}.") from error
    try:
        yield aside
    finally:
        remove(aside)


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


class _Stream:
    """The passes over a cloud, and learning between them."""

    def __init__(self, cloud: Cloud, plan: Plan, aside: Path, threads: int) -> None:
        self._cloud, self._plan, self._aside, self._threads = cloud, plan, aside, threads
        self._started = time.monotonic()

    def run(self, settings: Settings, out: Path) -> None:
        """Writes the mesh to `out` when it is whole, then measures the distances. Prints what was done."""
        sample = self._read()
        diagonal = float(np.linalg.norm(sample.high - sample.low))
        points = self._points_of(sample)
        mesh = self._learn(points, settings, out)
        result = {**mesh.report, "sample": len(points)}
        del points
        found = measure(mesh, self._cloud.chunks(self._plan.chunk), self._threads, lambda: self._show("Measuring"))
        percent = 100 / diagonal if diagonal else 0
        print(f"Measured the distances of all {found.points:,} points in {self._seconds():.1f} s: RMS {found.rms:.6g} "
              f"({found.rms * percent:.4f} % of the diagonal), mean {found.mean:.6g} ({found.mean * percent:.4f} %), "
              f"maximum {found.maximum:.6g} ({found.maximum * percent:.4f} %).")
        result.update(points=sample.seen, skipped=sample.skipped, points_rms=found.rms, points_mean=found.mean,
                      points_maximum=found.maximum, diagonal=diagonal)
        print(line_of(result))

    def _read(self) -> EvenSample:
        sample = EvenSample(self._plan.sample, self._plan.held, self._plan.chunk)
        for points in self._cloud.chunks(self._plan.chunk):
            sample.add(points)
            self._show("Reading")
        if sample.seen == sample.skipped:
            raise CloudError(f"{self._cloud.path} holds no point with finite coordinates.")
        return sample

    def _points_of(self, sample: EvenSample) -> np.ndarray:
        """The points to learn from. Those of a larger cloud stand for all points."""
        points = sample.take()
        skipped = f" {sample.skipped:,} of them are left out: they are not finite." if sample.skipped else ""
        print(f"Read {sample.seen:,} points in {self._seconds():.1f} s.{skipped} The sample has {len(points):,}.",
              flush=True)
        if sample.level is not None:
            averages = Averages(points, sample.level)
            for chunk in self._cloud.chunks(self._plan.chunk):
                averages.add(chunk)
                self._show("Averaging")
            print(f"Moved {averages.move():,} points of the sample to the mean of all points around them in "
                  f"{self._seconds():.1f} s.", flush=True)
        return points

    def _learn(self, points: np.ndarray, settings: Settings, out: Path) -> Mesh:
        """Learns from the sample and writes the mesh."""
        mesh = reconstruct(points, **settings)
        save_aside(mesh, self._aside, out)
        print(f"Learned {len(mesh.vertices):,} vertices in {self._seconds():.1f} s and wrote {out}.", flush=True)
        return mesh

    def _seconds(self) -> float:
        """Since the last call. Ends the line of the progress."""
        if sys.stderr.isatty():
            print("\r\033[K", end="", file=sys.stderr, flush=True)
        last, self._started = self._started, time.monotonic()
        return self._started - last

    def _show(self, what: str) -> None:
        if sys.stderr.isatty():
            print(f"\r{what}: {100 * self._cloud.done:.0f} %", end="", file=sys.stderr, flush=True)
