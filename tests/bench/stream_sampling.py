#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""How much a mesh loses if it is learned from a sample of two million points: one drawn at random, one whose density is
a power of the cloud's, and that of `neural-mesh stream`, whose points are moved to the means of all points.

    stream_sampling.py --plugin LIBRARY.so [--vertices 1500] [--powers .5] [CLOUD...]

prints the RMS distance of points without noise to the mesh of all points, in radii of the ball with bumps or half widths
of the box, and how much larger it is with samples.
"""

import argparse
import sys
import tempfile

import numpy as np
import stream

POINTS = 2_000_000


def halves(noise, ratio):
    """One half with a density `ratio` times that of the other."""
    points = stream.surface(2 * POINTS, 1, noise)
    return points[(points[:, 0] > 0) | (np.random.default_rng(2).random(len(points)) < 1 / ratio)]


def box(noise, count=POINTS, seed=1):
    """Points of a box's faces, with noise in all directions."""
    random = np.random.default_rng(seed)
    points, axes = random.uniform(-1, 1, (count, 3)), random.integers(0, 3, count)
    points[np.arange(count), axes] = random.choice([-1.0, 1.0], count)
    return points * (1, .7, .4) + noise * random.normal(size=(count, 3))


def outliers():
    random = np.random.default_rng(2)
    far = random.uniform(-1.3, 1.3, (POINTS // 100, 3))
    return random.permutation(np.concatenate([stream.surface(POINTS, 1), far]))


CLOUDS = {
    "noise of .001": lambda: stream.surface(POINTS, 1),
    "noise of .01": lambda: stream.surface(POINTS, 1, .01),
    "noise of .03": lambda: stream.surface(POINTS, 1, .03),
    "halves of 100:1": lambda: halves(.001, 100),
    "halves of 30:1, noise of .01": lambda: halves(.01, 30),
    "1 % outliers": outliers,
    "box, noise of .001": lambda: box(.001),
    "box, noise of .01": lambda: box(.01),
}


def samples(points, limit, powers):
    """The names of samples and their points."""
    from neural_mesh import averages, even_sample
    yield "random", points[np.random.default_rng(4).random(len(points)) < limit / len(points)]
    for power in powers:
        even_sample.POWER = power
        sample = even_sample.EvenSample(limit, 4 * limit, len(points))
        sample.add(points)
        taken = sample.take()
        yield f"power {power:g}", taken
        means = averages.Averages(taken, sample.level)
        means.add(points)
        means.move()
        yield "moved", taken


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--plugin", required=True)
    parser.add_argument("--vertices", type=int, default=1500)
    parser.add_argument("--powers", type=float, nargs="*", default=[.5])
    parser.add_argument("clouds", nargs="*", help=f"of: {', '.join(CLOUDS)}")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        sys.path.insert(0, str(stream.python_site.make(folder, options.plugin)))
        import neural_mesh
        import pymeshlab
        meshes = pymeshlab.MeshSet(verbose=False)

        def error(points, clean):
            meshes.add_mesh(pymeshlab.Mesh(points))
            meshes.apply_filter(neural_mesh.FILTER, target_vertices=options.vertices)
            meshes.add_mesh(pymeshlab.Mesh(clean))
            found = meshes.get_hausdorff_distance(sampledmesh=2, targetmesh=1, samplevert=True, samplenum=len(clean),
                                                  maxdist=pymeshlab.PureValue(10))["RMS"]
            meshes.clear()
            return found

        for name in options.clouds or CLOUDS:
            points = CLOUDS[name]()
            clean = box(0, 300_000, 3) if name.startswith("box") else stream.surface(300_000, 3, 0)
            whole = error(points, clean)
            row = [f"{sample} {100 * (error(taken, clean) / whole - 1):+.1f} %"
                   for sample, taken in samples(points, 100 * options.vertices, options.powers)]
            print(f"{name:30} all {whole:.6f}   " + "   ".join(row), flush=True)


if __name__ == "__main__":
    main()
