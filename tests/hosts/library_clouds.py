# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Six clouds whose meshes must have the same bytes from the library and from the filter, on every system, and the
recorded sums of these bytes.

    library_clouds.py            runs each with the neural_mesh that Python finds, and compares with the record
    library_clouds.py --record   records the sums, after an intended change of results

Coordinates are made by additions, products and square roots of uniform random numbers, which are the same everywhere.
Needs numpy alone."""

import hashlib
import sys
from pathlib import Path

import numpy as np

RECORD = Path(__file__).with_name("library_bytes.txt")


def directions(count, seed):
    """Points of the unit sphere."""
    points = 2 * np.random.default_rng(seed).random((4 * count, 3)) - 1
    squares = points[:, 0] * points[:, 0] + points[:, 1] * points[:, 1] + points[:, 2] * points[:, 2]
    inside = (squares < 1) & (squares > .01)
    return (points[inside] / np.sqrt(squares[inside])[:, None])[:count]


def box(count, seed):
    """Points of the faces of a box of 2 x 1.4 x .6."""
    random = np.random.default_rng(seed)
    points = 2 * random.random((count, 3)) - 1
    side = random.integers(0, 3, count)
    points[np.arange(count), side] = np.where(random.random(count) < .5, -1, 1)
    return points * (1, .7, .3)


def grid(side):
    """A bowl of side x side vertices over the unit square, and its faces."""
    x, y = (axis.ravel() / (side - 1) for axis in np.meshgrid(np.arange(side), np.arange(side)))
    corner = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
    faces = np.concatenate([np.column_stack([corner, corner + 1, corner + side]),
                            np.column_stack([corner + 1, corner + side + 1, corner + side])])
    return np.column_stack([x, y, (x - .5) * (x - .5) + (y - .5) * y]), faces


def paint(points):
    low = points.min(axis=0)
    return ((points - low) / (points.max(axis=0) - low) * 255).astype(np.uint8)


def clouds():
    """{name: keyword arguments of reconstruct()}"""
    ball, bowl = directions(3000, 1), directions(4000, 2)
    bowl = bowl[bowl[:, 2] < .3]
    stray = 4 * np.random.default_rng(3).random((60, 3)) - 2
    surface, faces = grid(30)
    density = np.random.default_rng(4).random(3000) < np.where(ball[:, 0] < 0, 1, .2)
    edges = {"target_vertices": 300, "crease_lines": True, "feature_measure": 1}
    return {
        "colours": {"points": ball, "colors": paint(ball), "target_vertices": 150},
        "open with normals": {"points": bowl.astype(np.float32), "normals": -bowl, "target_vertices": 150},
        "creases of floats": {"points": box(3000, 7).astype(np.float32), "colors": paint(box(3000, 7)), **edges},
        "faces": {"points": surface, "faces": faces, "colors": paint(surface), "target_vertices": 150},
        "stray points": {"points": np.concatenate([ball, stray]), "target_vertices": 150, "surface": 1},
        "uneven, far away": {"points": ball[density] * 10 + (451234.25, 5801234.5, 312), "target_vertices": 150,
                             "utility_counter": 1, "close_holes_up_to": 1.2},
    }


def arrays_of(mesh):
    creases = mesh.creases
    return [mesh.vertices, mesh.faces, mesh.quality, mesh.features, mesh.colors,
            *((creases.vertices, creases.edges, creases.quality) if creases else (None,) * 3)]


def sum_of(arrays):
    return hashlib.sha256(b"".join(b"-" if array is None else bytes(array.data) for array in arrays)).hexdigest()[:16]


def recorded():
    return dict(line.rsplit(" ", 1) for line in RECORD.read_text().splitlines())


def main():
    import warnings

    import neural_mesh
    warnings.simplefilter("ignore", neural_mesh.NeuralMeshWarning)
    found = {name: sum_of(arrays_of(neural_mesh.reconstruct(**given))) for name, given in clouds().items()}
    if "--record" in sys.argv:
        RECORD.write_text("".join(f"{name} {value}\n" for name, value in found.items()))
    wrong = [name for name, value in recorded().items() if found.get(name) != value]
    print(f"{len(found)} clouds, other bytes than recorded: {', '.join(wrong) or 'none'}")
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main())
