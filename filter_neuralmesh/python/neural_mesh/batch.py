# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Learns many clouds. Results are written to DIR, with a line of DIR/manifest.jsonl for each cloud. The same command,
given again, learns only what is missing, has failed, or has changed."""

import argparse
import errno
import os
import signal
import sys
import time
from pathlib import Path
from typing import Any, Generator, List

from neural_mesh.batch_files import Job, jobs_of, remove, remove_asides
from neural_mesh.manifest import Busy, Manifest, Record
from neural_mesh.parameters import WrongUsage, check, check_space, files_and_settings, memory_size

# In a result: three coordinates and the quality of 8 bytes, a colour of 4, and two faces of 13.
BYTES_PER_VERTEX = 62
# Formats other than PLY may leak memory.
FILES_PER_PROCESS = 500
INTERRUPTED = 130  # as shells report Ctrl-C
SECONDS_BETWEEN_LINES = 10  # where lines stay, such as in the log of a cluster's job


def positive(kind: Any) -> Any:
    def parse(text: str) -> Any:
        value = kind(text)
        if not 0 < value < float("inf"):
            raise ValueError
        return value

    parse.__name__ = f"positive {kind.__name__}"  # for argparse's sentence
    return parse


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("words", nargs="+", metavar="IN | name=value", help="files, folders and patterns; parameters "
                        "of the filter, such as target_vertices=5000")
    parser.add_argument("--out", required=True, metavar="DIR", type=Path, help="the folder of the results")
    parser.add_argument("--workers", type=positive(int), metavar="N", help="processes at a time; default: one per core")
    parser.add_argument("--files-per-process", type=positive(int), default=FILES_PER_PROCESS, metavar="N",
                        help="a process is renewed after so many clouds; default: %(default)s")
    parser.add_argument("--time-limit", type=positive(float), metavar="SECONDS", help="for each cloud")
    parser.add_argument("--memory-limit", type=memory_size, metavar="SIZE", help="of each process, such as 4G")
    parser.add_argument("--engine", choices=("local", "dask"), default="local", help="dask: dask.distributed")
    parser.add_argument("--address", metavar="HOST:PORT", help="of dask's scheduler; default: workers on this machine")


def run(given: argparse.Namespace) -> int:
    inputs, settings = files_and_settings(given.words)
    if not inputs:
        raise WrongUsage("There is no input: give files, folders or patterns.")
    if given.address and given.engine != "dask":
        raise WrongUsage("--address is for --engine dask.")
    if given.address and given.workers:
        raise WrongUsage("--workers is for this machine: a cluster at an --address has its own workers.")
    vertices = check(settings)["target_vertices"]
    jobs = jobs_of(inputs, given.out, settings)
    manifest = opened(given.out)
    try:
        missing = [job for job in jobs if not manifest.has(job, given.out)]
        check_space(given.out, len(missing) * vertices * BYTES_PER_VERTEX, "The meshes")
        remove_asides(given.out, missing)
        there = f", {len(jobs) - len(missing)} of them done before" if len(missing) < len(jobs) else ""
        print(f"{counted(len(jobs))}{there}.", file=sys.stderr)
        return learn_missing(missing, manifest, given) if missing else 0
    finally:
        manifest.close()


def counted(clouds: int) -> str:
    return "1 cloud" if clouds == 1 else f"{clouds} clouds"


def opened(out: Path) -> Manifest:
    try:
        out.mkdir(parents=True, exist_ok=True)
        if not os.access(out, os.W_OK | os.X_OK):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
        return Manifest(out)
    except Busy as error:
        raise WrongUsage(str(error)) from None
    except OSError as error:
        raise WrongUsage(f"Results cannot be written to {out}: {error.strerror}.") from None


def learn_missing(jobs: List[Job], manifest: Manifest, given: argparse.Namespace) -> int:
    from neural_mesh.children import CannotStart
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # as Ctrl-C
    failures: List[Record] = []
    progress = Progress(len(jobs))
    records = started(jobs, given)
    done = 0
    try:
        for record in records:
            if "error" in record:
                failures.append(record)
                remove(given.out / record["output"])  # of an earlier input or other parameters
            manifest.append(record)
            done += 1
            progress.add("error" in record)
    except KeyboardInterrupt:
        print(f"\nStopped with {counted(len(jobs) - done)} left. The same command goes on.", file=sys.stderr)
        return INTERRUPTED
    except (CannotStart, OSError) as error:
        print(f"\nneural-mesh: {error}", file=sys.stderr)
        return 1
    finally:
        records.close()  # ends the processes
        progress.close()
    if failures:
        print(f"{len(failures)} of {counted(len(jobs))} failed:", file=sys.stderr)
        for record in sorted(failures, key=lambda record: record["input"]):
            print(f"  {record['input']}: {record['error']}", file=sys.stderr)
    return 1 if failures else 0


def started(jobs: List[Job], given: argparse.Namespace) -> Generator[Record, None, None]:
    """The records of the engine, as they come."""
    from neural_mesh.children import Limits
    out = given.out.absolute()
    limits = Limits(given.files_per_process, given.time_limit, given.memory_limit)
    cores = len(os.sched_getaffinity(0))
    workers = given.workers or cores
    if given.engine == "local":
        from neural_mesh import local_engine
        return local_engine.learn_all(jobs, out, limits, workers, max(1, cores // workers))
    from neural_mesh import dask_engine
    threads = 1 if given.address else max(1, cores // workers)
    return dask_engine.learn_all(jobs, out, limits, workers, threads, given.address)


def duration(seconds: float) -> str:
    if seconds < 60:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 60 else f"{minutes // 60} h {minutes % 60} min"


class Progress:
    """How far a batch is and the time left, on standard error: one line that is renewed, or lines in a file."""

    def __init__(self, total: int) -> None:
        self._total = total
        self._done = 0
        self._failed = 0
        self._start = self._shown = time.monotonic()
        self._renews = sys.stderr.isatty()
        if self._renews:
            self._show(self._start)

    def add(self, failed: bool) -> None:
        """Counts a cloud that is finished."""
        self._done += 1
        self._failed += failed
        now = time.monotonic()
        if self._renews or now - self._shown >= SECONDS_BETWEEN_LINES or self._done == self._total:
            self._show(now)

    def close(self) -> None:
        if self._renews:
            print(file=sys.stderr)

    def _show(self, now: float) -> None:
        self._shown = now
        text = f"{self._done} of {self._total}"
        if self._failed:
            text += f", {self._failed} failed"
        if 0 < self._done < self._total:
            text += f", {duration((now - self._start) / self._done * (self._total - self._done))} left"
        print(f"\r{text}\033[K" if self._renews else text, end="" if self._renews else "\n", file=sys.stderr, flush=True)
