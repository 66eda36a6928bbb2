# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Small clouds for batches, and corrupt ones."""

import json

import numpy as np

POINTS = 200
# What the command is given, to learn them fast.
SETTINGS = ("target_vertices=60", "settling_signals_per_vertex=0")


def ellipsoid(rng):
    points = rng.normal(size=(POINTS, 3))
    return points / np.linalg.norm(points, axis=1, keepdims=True) * rng.uniform(1, 2, size=3)


def ply(points):
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points)}",
              *(f"property float {axis}" for axis in "xyz"), "end_header", ""]
    return "\n".join(header).encode() + np.asarray(points, dtype="<f4").tobytes()


CORRUPT = {
    "truncated": lambda points: ply(points)[:1000],
    "nan": lambda points: ply(points * np.nan),
    "empty": lambda points: b"",
    "text": lambda points: b"Scanned on a rainy day.\n" * 20,
    # pymeshlab 2025.7 ends with a segmentation fault when it loads this.
    "truncated_header": lambda points: ply(points)[:45],
}


def make(folder, count):
    """Writes `count` clouds, cloud_0000.ply and so on."""
    folder.mkdir(parents=True)
    rng = np.random.default_rng(1)
    for i in range(count):
        (folder / f"cloud_{i:04}.ply").write_bytes(ply(ellipsoid(rng)))


def records(out):
    """The whole lines of the manifest in the folder `out`."""
    path = out / "manifest.jsonl"
    lines = path.read_bytes().split(b"\n") if path.exists() else []
    return [json.loads(line) for line in lines if line.endswith(b"}")]
