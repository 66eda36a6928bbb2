# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Runs of the neural mesh and of common methods on the same clouds, and their measures: shared by the tables."""

import hashlib
import json
from pathlib import Path

import numpy as np

import evaluate
import models
import peers

# Raise this after a change of the peers or the measures that makes cached results wrong.
CACHE_VERSION = 2


def numbers(kind):
    return lambda text: [kind(word) for word in text.split(",") if word]


class Case:
    """A model with noise: its true surface and the file of its cloud, both made on first use."""

    def __init__(self, name, noise, options):
        self.name, self.noise, self.options = name, noise, options
        self.folder = options.out / "work" / f"{name}-{options.samples}-{noise:g}-{options.cloud_seed}"
        self._truth = None

    def key(self):
        return {"model": self.name, "noise": self.noise, "samples": self.options.samples,
                "cloud_seed": self.options.cloud_seed}

    def truth(self):
        if self._truth is None:
            samples = getattr(self.options, "measure_samples", evaluate.SAMPLES)
            self._truth = evaluate.Truth(*models.load_model(self.name, self.options.data), samples)
        return self._truth

    def cloud(self):
        path = self.folder / "cloud.ply"
        if not path.exists():
            self.folder.mkdir(parents=True, exist_ok=True)
            truth = self.truth()
            points = models.make_cloud(truth.vertices, truth.faces, self.options.samples, self.noise,
                                       self.options.cloud_seed)
            models.save_ply(path, points)
        return path

    def rows(self, method, counts, seed=None, **ours):
        """Runs a method for all counts and measures the results. A failed run gives rows with its error."""
        truth = self.truth()  # a model that is not available is no failure of the method
        folder = self.folder / (method if seed is None else f"{method}-{seed}")
        try:
            figures = peers.run(method, self.cloud(), folder, counts, **ours)
        except peers.PeerError as error:
            return [{"method": method, "seed": seed, "target": n, **self.key(), "error": str(error)} for n in counts]
        rows = []
        for n in counts:
            row = {"method": method, "seed": seed, "target": n, **self.key(), **figures[n]}
            try:
                row.update(evaluate.evaluate(*models.load_mesh(folder / f"{n}.ply"), truth))
            except (ValueError, models.ModelError) as error:
                row["error"] = str(error)
            rows.append(row)
        return rows


def peer_rows(case, peer, counts, cache):
    """The rows of a peer, from the cache if possible."""
    known = {}
    for n in counts:
        name = json.dumps({"peer": peer, "target": n, "version": CACHE_VERSION, **case.key()}, sort_keys=True)
        known[n] = cache / f"{case.name}-{peer}-{n}-{hashlib.sha256(name.encode()).hexdigest()[:12]}.json"
    missing = [n for n in counts if not known[n].exists()]
    if missing:
        cache.mkdir(parents=True, exist_ok=True)
        for row in case.rows(peer, missing):
            known[row["target"]].write_text(json.dumps(row))
    return [json.loads(known[n].read_text()) for n in counts]


def geometric_mean(values):
    return float(np.exp(np.mean(np.log(values)))) if len(values) else float("nan")


def by_case(rows, method):
    """{(model, noise, vertices): rows of the method that gave a mesh}."""
    found = {}
    for row in rows:
        if row["method"] == method and "error" not in row:
            found.setdefault((row["model"], row["noise"], row["target"]), []).append(row)
    return found


def topology_right(row):
    model = models.MODELS[row["model"]]
    return row["genus"] == model.genus and row["components"] == model.components


def table(header, lines):
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in [header, ["---"] * len(header), *lines])


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
