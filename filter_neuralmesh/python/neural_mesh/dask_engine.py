# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Learns the clouds of a batch with dask.distributed: on a cluster with an address, or on workers of this machine.

The folders must be the same on all machines, and neural-mesh must be installed on all."""

import contextlib
import sys
import threading
from pathlib import Path
from typing import Any, Dict, Generator, List, Optional, Tuple

from neural_mesh.batch_files import Job
from neural_mesh.children import Child, Limits, failed
from neural_mesh.manifest import Record
from neural_mesh.parameters import WrongUsage

RETRIES = 2  # of a task that raises; dask itself repeats tasks of workers that are lost

# In a worker of dask. A child process belongs to a thread, and is kept from task to task.
_children: Dict[Tuple[int, Path, Limits, int], Child] = {}


def learn_one(job: Job, out: Path, limits: Limits, threads: int) -> Record:
    """The task of dask."""
    key = (threading.get_ident(), out, limits, threads)
    if key not in _children:
        _children[key] = Child(out, limits, threads)
    return _children[key].learn(job)


def end_children(out: Path) -> None:
    for key in [key for key in _children if key[1] == out]:
        _children.pop(key).stop()


def learn_all(jobs: List[Job], out: Path, limits: Limits, workers: int, threads: int,
              address: Optional[str]) -> Generator[Record, None, None]:
    """Yields the records as they come, in any order. Throws WrongUsage if the cluster cannot be reached."""
    try:
        from dask.distributed import CancelledError, Client, LocalCluster, as_completed
    except ImportError:
        raise WrongUsage("The engine dask is not installed: run 'pip install neural_mesh-*.whl[dask]', or 'pip install "
                         "distributed'.") from None
    cluster: Any = None
    try:
        if not address:
            # Limits are those of the child processes.
            cluster = LocalCluster(n_workers=workers, threads_per_worker=1, memory_limit=0, dashboard_address=":0")
        client = Client(address or cluster, timeout="30s")
    except (OSError, ValueError) as error:
        raise WrongUsage(f"No scheduler of dask answers at {address}: {error}") from None
    print(f"dask's dashboard: {client.dashboard_link}", file=sys.stderr)
    finished = as_completed()
    try:
        tasks = client.map(learn_one, jobs, out=out, limits=limits, threads=threads, pure=False, retries=RETRIES)
        job_of = dict(zip((task.key for task in tasks), jobs))
        finished.update(tasks)
        del tasks  # or the scheduler would keep every result
        for task in finished:
            problem = task.exception()
            yield failed(job_of[task.key], f"dask: {' '.join(str(problem).split())}") if problem else task.result()
    except CancelledError:
        raise OSError(f"dask's scheduler at {client.scheduler.address} has gone. The same command goes on.") from None
    finally:
        with contextlib.suppress(OSError):  # the scheduler may have gone
            client.cancel(list(finished.futures))
            client.run(end_children, out, on_error="ignore")
        client.close()
        if cluster is not None:
            cluster.close()
