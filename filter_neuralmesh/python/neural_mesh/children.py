# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The driver's side of the processes that learn the clouds of a batch: limits, renewal, and what became of them."""

import json
import os
import select
import signal
import subprocess
import sys
import tempfile
import threading
import time
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, Dict, Optional

from neural_mesh import __version__
from neural_mesh.batch_files import Job, aside_of, remove
from neural_mesh.manifest import Record

START_SECONDS = 300  # for the libraries to load from a slow network disk
START_TRIES = 3  # if someone kills it before its first cloud
REASONS = {"SIGSEGV": " (segmentation fault)", "SIGKILL": " (by the system if memory ran out, or by someone)"}


class CannotStart(Exception):
    """The process that learns ends before its first cloud."""


@dataclass(frozen=True)
class Limits:
    files_per_process: int
    seconds: Optional[float]  # per cloud
    memory: Optional[int]  # bytes


def described(job: Job) -> Record:
    """The part of a record that is known before the work."""
    return {"output": job.output, "input": job.input, "size": job.size, "modified_ns": job.modified_ns,
            "parameters": job.settings, "version": __version__}


def failed(job: Job, sentence: str) -> Record:
    return {**described(job), "error": sentence}


class Child:
    """A process that learns one cloud after another, and is renewed. For one thread, but for stop()."""

    def __init__(self, out: Path, limits: Limits, threads: int) -> None:
        """`threads`: of the filter, unless the settings say how many."""
        self._out = out
        self._limits = limits
        self._threads = threads
        self._process: Optional[subprocess.Popen] = None
        self._files = 0  # that the process has been given
        self._log: Optional[IO[str]] = None
        self._lock = threading.Lock()
        self._stopped = False

    def learn(self, job: Job) -> Record:
        """Learns a cloud, whatever happens to the process, and returns its line of the manifest. Throws CannotStart."""
        if self._files >= self._limits.files_per_process:
            self._end()
        if self._process is None:
            self._start()
        assert self._process is not None
        self._files += 1
        result = self._out / job.output
        aside = aside_of(result, self._process.pid)
        start = time.monotonic()
        try:
            result.parent.mkdir(parents=True, exist_ok=True)
            self._send({"input": job.input, "result": str(result), "aside": str(aside),
                        "settings": {"threads": self._threads, **job.settings}})
            answer = self._answer(self._limits.seconds)
        except OSError as error:  # the folder, not the process: a broken pipe is found by _answer()
            answer = {"error": f"{error.strerror}: {error.filename}"}
        if answer is None:
            answer = {"error": self._why_no_answer(self._limits.seconds), "seconds": round(time.monotonic() - start, 3)}
        if "error" in answer:
            # pymeshlab 2025.7 crashes if it loads a file after a MeshSet was deleted in which a filter has failed.
            self._end()
            remove(aside)
        return {**described(job), **answer}

    def stop(self) -> None:
        """Ends the process at once, and learn() with it. May be called by any thread."""
        with self._lock:
            self._stopped = True
            if self._process is not None:
                self._process.kill()

    def close(self) -> None:
        self._end()

    def _start(self) -> None:
        for tries_left in reversed(range(START_TRIES)):
            self._spawn()
            if self._answer(START_SECONDS) is not None:
                return
            sentence = self._why_no_answer(START_SECONDS)
            assert self._process is not None
            killed = (self._process.returncode or 0) < 0
            self._end()
            if not (killed and tries_left):
                raise CannotStart(f"The process that learns cannot start. {sentence}")

    def _spawn(self) -> None:
        self._log = tempfile.TemporaryFile("w+", encoding="utf-8", errors="replace")
        # BLAS would start a thread per core, and is not used. Qt takes names of files for those of the locale.
        environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "LC_ALL": "C.UTF-8"}
        with self._lock:
            if self._stopped:
                raise CannotStart("stopped")
            self._process = subprocess.Popen(
                [sys.executable, "-m", "neural_mesh.worker", str(os.getpid()), str(self._limits.memory or 0)],
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._log, env=environment,
                start_new_session=True)  # Ctrl-C in a terminal goes to the driver only
        self._files = 0

    def _send(self, job: Dict[str, Any]) -> None:
        assert self._process is not None and self._process.stdin is not None
        try:
            self._process.stdin.write(json.dumps(job).encode() + b"\n")
            self._process.stdin.flush()
        except BrokenPipeError:
            pass

    def _answer(self, seconds: Optional[float]) -> Optional[Dict[str, Any]]:
        """The next line of the process; None if it ends or takes longer."""
        if not self._has_output(seconds):
            return None
        assert self._process is not None and self._process.stdout is not None
        line = self._process.stdout.readline()
        return json.loads(line) if line.endswith(b"\n") else None

    def _why_no_answer(self, seconds: Optional[float]) -> str:
        """What became of the process, after _answer() has waited for `seconds`."""
        assert self._process is not None
        try:
            status = self._process.wait(timeout=1 if self._has_output(0) else 0)
        except subprocess.TimeoutExpired:
            return f"It took longer than the limit of {seconds:g} seconds."
        log = self._log_text().splitlines()
        if status >= 0:
            return f"The process ended with status {status}: {log[-1] if log else 'no message'}"
        name = signal.Signals(-status).name
        if name == "SIGABRT" and any("bad_alloc" in line for line in log):
            return "There was not enough memory."
        return f"The process was ended by signal {-status}, {name}{REASONS.get(name, '')}."

    def _has_output(self, seconds: Optional[float]) -> bool:
        """Whether the process writes, or ends, within the time."""
        assert self._process is not None and self._process.stdout is not None
        return bool(select.select([self._process.stdout], [], [], seconds)[0])

    def _log_text(self) -> str:
        assert self._log is not None
        self._log.seek(0)
        return self._log.read()

    def _end(self) -> None:
        with self._lock:
            if self._process is None:
                return
            self._process.kill()
            self._process.communicate()
            self._process = None
        if self._log is not None:
            self._log.close()
