# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Shared by the scripts of this folder: runs of the core, rows kept on disk."""

import hashlib
import json
import resource
import subprocess
from pathlib import Path


class RunError(RuntimeError):
    """A program that the experiment needs failed; the message contains its output."""


def learn(program, cloud, out, start=None, **settings):
    """Runs the core on a PLY file, from the mesh of the file start if any; returns its report, with the processor
    time, including reading and writing, as "processor_seconds". It depends less on other load than wall time."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    # The paper draws its signals evenly over the points.
    settings = {"even_sampling": 0, **settings}
    files = [cloud, out] if start is None else [cloud, out, start]
    command = [str(word) for word in (program, *files, *(f"{key}={value}" for key, value in settings.items()))]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    if run.returncode != 0:
        raise RunError(f"{' '.join(command)} failed: {run.stderr.strip()}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return {**json.loads(run.stdout), "processor_seconds":
            after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime}


def digest(data):
    return hashlib.sha256(data).hexdigest()[:16]


class Kept:
    """The rows of an experiment on disk, so that an interrupted run continues where it stopped.

    The key contains the checksum of the program, the cloud and the settings, so only rows of equal runs are reused.
    The file has one JSON object per line; an incomplete last line is ignored.
    """

    def __init__(self, path, program):
        self.path = path
        self.program = digest(Path(program).read_bytes())
        self.rows = {}
        path.parent.mkdir(parents=True, exist_ok=True)
        for line in path.read_text().splitlines() if path.exists() else ():
            try:
                found = json.loads(line)
            except json.JSONDecodeError:
                continue
            self.rows[found["key"]] = found["row"]

    def _word(self, key):
        return json.dumps({**key, "program": self.program}, sort_keys=True)

    def has(self, **key):
        return self._word(key) in self.rows

    def row(self, make, **key):
        """The row under the key; make() makes it if it is missing."""
        word = self._word(key)
        if word not in self.rows:
            self.rows[word] = make()
            with self.path.open("a") as file:
                file.write("\n" + json.dumps({"key": word, "row": self.rows[word]}))
        return self.rows[word]
