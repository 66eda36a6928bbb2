# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The manifest of a batch: a file with a line of JSON for each cloud that was tried. The last line about a result
counts."""

import fcntl
import json
import math
import os
from pathlib import Path
from typing import Any, Dict

from neural_mesh.batch_files import Job

Record = Dict[str, Any]

NAME = "manifest.jsonl"


class Busy(Exception):
    """Another process writes to this manifest."""


class Manifest:
    """Opens or makes the manifest of the folder `out` and keeps other batches from it until closed. Throws Busy,
    OSError."""

    def __init__(self, out: Path) -> None:
        self.path = out / NAME
        # Every line is one write at the end of the file, so that a killed batch leaves whole lines but for the last.
        self._file = os.open(self.path, os.O_RDWR | os.O_APPEND | os.O_CREAT, 0o666)
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            os.close(self._file)
            raise Busy(f"Another batch is writing to {self.path}.") from None
        self.records = self._read()  # by the name of the result

    def _read(self) -> Dict[str, Record]:
        text = self.path.read_bytes()
        if text and not text.endswith(b"\n"):
            os.write(self._file, b"\n")  # ends the line that a killed batch has left
        records = {}
        for line in text.splitlines():
            try:
                record = json.loads(line)
                records[record["output"]] = record
            except (ValueError, KeyError, TypeError):  # a torn line: its cloud is learned again
                pass
        return records

    def append(self, record: Record) -> None:
        """Adds a line. Throws OSError if it cannot be written whole."""
        line = json.dumps(_finite(record), allow_nan=False).encode() + b"\n"
        if os.write(self._file, line) < len(line):
            raise OSError(f"No space is left for {self.path}.")
        self.records[record["output"]] = record

    def has(self, job: Job, out: Path) -> bool:
        """Whether the result of the job is there, whole, from the same input and parameters."""
        record = self.records.get(job.output)
        if record is None or "error" in record:
            return False
        try:
            return (record["size"] == job.size and record["modified_ns"] == job.modified_ns
                    and _that_matter(record["parameters"]) == _that_matter(job.settings)
                    and record["output_size"] == (out / job.output).stat().st_size)
        except (OSError, KeyError, TypeError):
            return False

    def close(self) -> None:
        os.close(self._file)


def _that_matter(settings: Dict[str, Any]) -> Dict[str, Any]:
    """The mesh does not depend on the number of threads."""
    return {name: value for name, value in settings.items() if name != "threads"}


def _finite(value: Any) -> Any:
    """JSON has no numbers that are not finite."""
    if isinstance(value, dict):
        return {name: _finite(entry) for name, entry in value.items()}
    return None if isinstance(value, float) and not math.isfinite(value) else value
