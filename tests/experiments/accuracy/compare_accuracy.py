# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Shared by the tables: their options, runs of the neural mesh and of common methods on the same clouds and the measures of
these, kept on disk."""

import argparse
import hashlib
import json
import os
import sys
import time
from pathlib import Path

import numpy as np

import evaluate
import models
import peers

# Raise this after a change of the peers or the measures that makes kept results wrong.
KEPT_VERSION = 3


def numbers(kind):
    return lambda text: [kind(word) for word in text.split(",") if word]


def parser(description):
    """Of the options that the tables have in common."""
    result = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    result.add_argument("--plugin", help="pymeshlab's libfilter_neuralmesh.so")
    result.add_argument("--data", default=os.environ.get("NEURAL_MESH_DATA"), help="data folder")
    result.add_argument("--out", type=Path, default=Path("build/experiments"))
    result.add_argument("--models", type=numbers(str), help="names of models.py")
    result.add_argument("--minutes", type=float, default=float("inf"), help="start no run later than this")
    result.add_argument("--timeout", type=float, default=300, help="seconds of one run")
    result.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="a parameter of ours")
    return result


def parsed(options, arguments):
    """The values of such options; those without a plugin end the program."""
    values = options.parse_args(arguments)
    if not values.plugin or not Path(values.plugin).exists():
        options.error(f"There is no plugin {values.plugin}: build it, and give --plugin.")
    values.settings = dict(word.split("=", 1) for word in values.set)
    values.models = values.models or list(models.TABLE_MODELS if values.data else models.PUBLIC_MODELS)
    return values


def note(text):
    print(text, file=sys.stderr, flush=True)


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
    return (row["genus"], row["components"]) == (model.genus, model.components)


def table(header, lines):
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in [header, ["---"] * len(header), *lines])


def digest(data):
    return hashlib.sha256(data).hexdigest()[:16]


class Kept:
    """The rows of an experiment on disk, so that an interrupted run continues where it stopped.

    The key has what a row depends on: the cloud, the settings, and of our own runs the checksum of the program, so only
    rows of equal runs are reused. The file has one JSON object per line; an incomplete last line is ignored.
    """

    def __init__(self, name, options):
        self.path = options.out / f"{name}.jsonl"
        self.program = digest(Path(options.plugin).read_bytes())
        self.end = time.monotonic() + 60 * options.minutes
        self.rows = {}
        self.path.parent.mkdir(parents=True, exist_ok=True)
        for line in self.path.read_text().splitlines() if self.path.exists() else ():
            try:
                found = json.loads(line)
            except json.JSONDecodeError:
                continue
            self.rows[found["key"]] = found["row"]

    def row(self, make, method="neural", **key):
        """The row under the key; make() makes it if it is missing. Nothing if that would begin after the last minute."""
        program = self.program if method == "neural" else None
        word = json.dumps({**key, "method": method, "program": program, "version": KEPT_VERSION}, sort_keys=True)
        if word not in self.rows:
            if time.monotonic() > self.end:
                return None
            self.rows[word] = make()
            with self.path.open("a") as file:
                file.write("\n" + json.dumps({"key": word, "row": self.rows[word]}))
        return self.rows[word]
