# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Learns the clouds of a batch on this machine: a thread per worker, each with its child process."""

import queue
import threading
from pathlib import Path
from typing import Generator, List, Union

from neural_mesh.batch_files import Job
from neural_mesh.children import Child, Limits
from neural_mesh.manifest import Record


def learn_all(jobs: List[Job], out: Path, limits: Limits, workers: int, threads: int) -> Generator[Record, None, None]:
    """Yields the records as they come. Closing the iterator ends the processes. Throws CannotStart."""
    waiting: "queue.SimpleQueue[Job]" = queue.SimpleQueue()
    for job in jobs:
        waiting.put(job)
    finished: "queue.SimpleQueue[Union[Record, Exception]]" = queue.SimpleQueue()
    children = [Child(out, limits, threads) for _ in range(min(workers, len(jobs)))]

    def work(child: Child) -> None:
        try:
            while True:
                finished.put(child.learn(waiting.get_nowait()))
        except queue.Empty:
            child.close()
        except Exception as error:  # raised again by the thread that waits
            finished.put(error)

    runners = [threading.Thread(target=work, args=(child,)) for child in children]
    try:
        for runner in runners:
            runner.start()
        for _ in jobs:
            record = finished.get()
            if isinstance(record, Exception):
                raise record
            yield record
    finally:
        for child in children:
            child.stop()
        for runner in runners:
            runner.join()
