# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The process that learns clouds for a batch, one after another, so that a crash costs one cloud only.

It reads jobs as lines of JSON and answers each with a line on what was its standard output. The driver's side is
children.py."""

import ctypes
import json
import os
import resource
import signal
import sys
import time
import warnings
from pathlib import Path
from typing import Any, Dict, List, Optional

from neural_mesh import NeuralMeshWarning, reconstruct
from neural_mesh.clouds import CloudError
from neural_mesh.files import NotWhole, load, save_aside

PR_SET_PDEATHSIG = 1  # of linux/prctl.h


def end_with(parent: int) -> None:
    """Lets the system end this process when its parent ends, however that happens."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != parent:  # it has ended before the call
        os._exit(1)


class Log:
    """What the process writes to its standard error, where pymeshlab's log goes."""

    WARNING = "1 "  # the level

    def __init__(self) -> None:
        self._file = open(2, "r+", encoding="utf-8", errors="replace", closefd=False)

    def clear(self) -> None:
        os.lseek(2, 0, os.SEEK_SET)
        os.ftruncate(2, 0)

    def warnings(self) -> List[str]:
        self._file.seek(0)
        entries = ("\n" + self._file.read()).split("\nLOG: ")
        return [" ".join(entry[2:].split()) for entry in entries if entry.startswith(self.WARNING)]


def reset_peak_memory() -> None:
    try:
        Path("/proc/self/clear_refs").write_text("5")
    except OSError:  # a system that does not let us: the peak is then that of all clouds so far
        pass


def peak_memory() -> int:
    """The largest resident memory in bytes since reset_peak_memory()."""
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith("VmHWM:"):
            return int(line.split()[1]) * 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def learn(job: Dict[str, Any]) -> Dict[str, Any]:
    """Makes the mesh of a job. Returns the results and warnings of the run, or an error, after which the process must
    end."""
    aside = Path(job["aside"])
    try:
        mesh = reconstruct(**load(Path(job["input"]), verbose=True), **job["settings"])
        result = Path(job["result"])
        save_aside(mesh, aside, result)
        return {"output_size": result.stat().st_size, "result": dict(mesh.report), "warnings": mesh.report.warnings}
    except CloudError as error:
        return {"error": f"The file cannot be loaded: {error}"}
    except MemoryError as error:
        return {"error": str(error) or "There was not enough memory."}
    except (ValueError, OSError, NotWhole) as error:
        return {"error": " ".join(str(error).split())}


def answer_jobs(answers: Any, memory_limit: Optional[int]) -> None:
    log = Log()
    if memory_limit:
        # Memory that can be written to: not that of libraries, nor what is only reserved, unlike RLIMIT_AS.
        resource.setrlimit(resource.RLIMIT_DATA, (memory_limit, memory_limit))
    print("{}", file=answers, flush=True)  # ready
    for line in sys.stdin:
        job = json.loads(line)
        log.clear()
        reset_peak_memory()
        start = time.monotonic()
        answer = learn(job)
        answer["seconds"] = round(time.monotonic() - start, 3)
        answer["peak_memory"] = peak_memory()
        answer["warnings"] = log.warnings() + answer.get("warnings", [])
        print(json.dumps(answer), file=answers, flush=True)


def main() -> None:
    end_with(int(sys.argv[1]))
    warnings.simplefilter("ignore", NeuralMeshWarning)  # the report has them
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # pymeshlab prints the parameters of each filter
    answer_jobs(answers, int(sys.argv[2]) or None)


if __name__ == "__main__":
    main()
