#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The pictures of the documentation and two figures of the paper, drawn by MeshLab.

    paper_figures.py --learn build/tests/learn [--data FOLDER] [--out FOLDER] [--pictures FOLDER]

bunny.png: from points to mesh to counters. closeup.png: a part of it, as points and as wireframe. fig2.png:
counters as colours. fig3.png: levels of detail. The numbers in the captions are written to OUT/figures.json. With a data
folder Fig. 3 shows Max-Planck and Dino, as in the paper, else models from Debian packages.
"""

import argparse
import contextlib
import json
import os
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import import_paths  # noqa: F401
import models
import paper_runs
from compare_accuracy import numbers
from meshlab_picture import Picture, camera_axes, render
from meshlab_picture_sheet import contact_sheet, legend_of_mesh
from small_png import make_small

FIGURES = ("bunny", "closeup", "fig2", "fig3")
LEVELS = (500, 2000, 5000, 10000, 20000)
COUNTER_TITLE = "feature counter"


@dataclass(frozen=True)
class Subject:
    """A model, its name in a caption, and the camera that shows it best."""

    name: str
    title: str
    view: tuple = (0.25, 0.15, 1.0)
    up: tuple = (0.0, 1.0, 0.0)
    points: int = 200_000

    def pictures(self, meshes, style, color=False, **more):
        """One Picture for each mesh, all of the same scale."""
        return [Picture(str(mesh), style, color, self.view, self.up, fit_to=list(map(str, meshes)), **more)
                for mesh in meshes]


BUNNY = Subject("bunny", "Bunny")
SUBJECTS = {subject.name: subject for subject in (
    BUNNY,
    Subject("maxplanck", "Max-Planck", (0.55, 0.08, 1.0), points=100_000),
    Subject("dino", "Dino", (0.35, 0.2, 1.0), points=225_000),
    Subject("koala", "Koala", (0.8, 0.25, 1.0)),
    Subject("feline", "Feline", (-0.25, 1.0, -0.15), (0.0, 0.0, -1.0)),
    Subject("fandisk", "Fandisk", (-0.8, 0.55, -1.0)),
    Subject("armadillo", "Armadillo", (0.3, 0.1, -1.0), points=100_000),
    Subject("elephant", "Elephant", (0.5, 0.2, 1.0)),
    Subject("camel", "Camel", (1.0, 0.15, 0.4)),
)}
# Models of the data folder first; a figure shows the first available ones.
PAIR = ("maxplanck", "dino", "armadillo")
SIX = ("bunny", "maxplanck", "dino", "feline", "koala", "fandisk", "armadillo", "elephant", "camel")


class Studio:
    """Makes clouds and meshes in the scratch folder and sheets in the folder of the pictures."""

    def __init__(self, options):
        self.options = options
        self.numbers = {}
        for folder in (options.out, options.pictures):
            folder.mkdir(parents=True, exist_ok=True)

    def first_available(self, names, count):
        """The first `count` subjects whose model is available."""
        found = []
        for name in names:
            if len(found) < count:
                with contextlib.suppress(models.ModelError):
                    models.load_model(name, self.options.data)
                    found.append(SUBJECTS[name])
        return found

    def surface(self, subject):
        return models.load_model(subject.name, self.options.data)

    def cloud(self, subject):
        path = self.options.out / f"figure_{subject.name}.ply"
        if not path.exists():
            models.save_ply(path, models.make_cloud(*self.surface(subject), subject.points))
        return path

    def mesh(self, subject, vertices, **settings):
        """The neural mesh and its report."""
        label = "".join(f"_{key}{value}" for key, value in settings.items())
        path = self.options.out / f"figure_{subject.name}_{vertices}{label}.ply"
        report = paper_runs.learn(self.options.learn, self.cloud(subject), path, target_vertices=vertices, **settings)
        return path, report

    def sheet(self, name, rows, captions, legend=None, size=(420, 420)):
        drawn = iter(render([picture for row in rows for picture in row], size))
        images = [[next(drawn) for _ in row] for row in rows]
        path = self.options.pictures / f"{name}.png"
        contact_sheet(images, captions, path, legend=legend)
        make_small(path)
        print(f"{path}: {path.stat().st_size / 1000:.0f} kB", flush=True)


def bunny_mesh(studio):
    """The vertices of the bunny, the mesh learned from them, and its report."""
    cloud = studio.options.out / "figure_bunny_vertices.ply"
    models.save_ply(cloud, studio.surface(BUNNY)[0])
    mesh = studio.options.out / "figure_bunny_3000.ply"
    return cloud, mesh, paper_runs.learn(studio.options.learn, cloud, mesh, target_vertices=3000)


def bunny(studio):
    """From points to mesh to counters."""
    cloud, mesh, report = bunny_mesh(studio)
    shape = {"fit_to": [str(mesh)], "view": BUNNY.view, "up": BUNNY.up}
    row = [Picture(str(cloud), "points", point_size=0.7, **shape),
           Picture(str(mesh), "flat-lines", line_width=0.6, **shape),
           Picture(str(mesh), "smooth", True, **shape)]
    points = len(studio.surface(BUNNY)[0])
    captions = [f"{points:,} points, no normals", f"neural mesh, {report['vertices']:,} vertices",
                "its feature counter"]
    studio.sheet("bunny", [row], [captions], legend_of_mesh(mesh, COUNTER_TITLE), (460, 460))
    studio.numbers["bunny"] = report


def save_off(path, vertices, faces=()):
    """Writes a text file, which MeshLab reads and whose size meshlab_picture.py does not."""
    lines = ["OFF", f"{len(vertices)} {len(faces)} 0", *("%.9g %.9g %.9g" % tuple(v) for v in vertices),
             *("3 %d %d %d" % tuple(face) for face in faces)]
    path.write_text("\n".join(lines) + "\n")
    return str(path)


def closeup(studio):
    """Head and ears of the bunny."""
    _, mesh, _ = bunny_mesh(studio)
    vertices, faces = models.load_mesh(mesh)
    axes = camera_axes(BUNNY.view, BUNNY.up)
    seen = vertices @ axes.T
    low, size = seen.min(axis=0), np.ptp(seen, axis=0)
    part = studio.options.out / "closeup_box.ply"
    models.save_ply(part, np.array([low + size * (-0.02, 0.52, 0), low + size * (0.63, 1.02, 1)]) @ axes)
    shape = {"fit_to": [str(part)], "view": BUNNY.view, "up": BUNNY.up}
    points = save_off(studio.options.out / "closeup_points.off", studio.surface(BUNNY)[0])
    wires = save_off(studio.options.out / "closeup_mesh.off", vertices, faces)
    row = [Picture(points, "points", point_size=1.4, **shape), Picture(wires, "flat-lines", **shape)]
    studio.sheet("closeup", [row], [["the points", "the mesh"]], size=(440, 380))


def fig2(studio):
    """The counters of several models as colours."""
    subjects = studio.first_available(SIX, 6)
    meshes = [studio.mesh(subject, 10000)[0] for subject in subjects]
    pictures = [subject.pictures([mesh], "smooth", True)[0] for subject, mesh in zip(subjects, meshes)]
    titles = [subject.title for subject in subjects]
    rows = [slice(start, start + 3) for start in range(0, len(pictures), 3)]
    legend = legend_of_mesh(meshes[0], COUNTER_TITLE)
    legend.low, legend.high = "low", "high"  # each mesh is painted on a scale of its own
    studio.sheet("fig2", [pictures[row] for row in rows], [titles[row] for row in rows], legend)


def fig3(studio):
    """Levels of detail, with the processor time of each on one thread."""
    rows, captions, numbers_of_model = [], [], {}
    for subject in studio.first_available(PAIR, 2):
        made = [studio.mesh(subject, level, threads=1) for level in studio.options.levels]
        rows.append(subject.pictures([mesh for mesh, _ in made], "flat"))
        captions.append([f"{report['vertices']:,} vertices, {report['processor_seconds']:.1f} s" for _, report in made])
        numbers_of_model[subject.name] = {"points": subject.points, "levels": [report for _, report in made]}
    studio.sheet("fig3", rows, captions, size=(320, 320))
    studio.numbers["fig3"] = numbers_of_model


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--learn", required=True, help="the core as a program (target learn)")
    parser.add_argument("--data", default=os.environ.get("NEURAL_MESH_DATA"), help="data folder")
    parser.add_argument("--out", type=Path, default=Path("out/figures"), help="folder of clouds, meshes and numbers")
    parser.add_argument("--pictures", type=Path, default=Path("screenshots"))
    parser.add_argument("--figures", type=numbers(str), default=FIGURES, help=f"of {', '.join(FIGURES)}")
    parser.add_argument("--levels", type=numbers(int), default=LEVELS, help="vertices of Fig. 3")
    return parser.parse_args(arguments)


def main(arguments=None):
    options = parse(arguments)
    studio = Studio(options)
    makers = {"bunny": bunny, "closeup": closeup, "fig2": fig2, "fig3": fig3}
    unknown = [name for name in options.figures if name not in makers]
    if unknown:
        sys.exit(f"There is no figure '{unknown[0]}': there are {', '.join(makers)}.")
    for name in options.figures:
        makers[name](studio)
    numbers_file = options.out / "figures.json"
    earlier = json.loads(numbers_file.read_text()) if numbers_file.exists() else {}
    # One figure may be made without the others.
    numbers_file.write_text(json.dumps({**earlier, **studio.numbers}, indent=1))
    for name, numbers_of_model in studio.numbers.get("fig3", {}).items():
        print(f"fig3, {name}, {numbers_of_model['points']:,} points: " +
              ", ".join(f"{level['vertices']:,} vertices in {level['processor_seconds']:.1f} processor seconds, RMS "
                        f"{level['rms_error']:.4f} %" for level in numbers_of_model["levels"]))


if __name__ == "__main__":
    try:
        main()
    except (RuntimeError, ValueError, OSError) as error:
        sys.exit(f"paper_figures: {error}")
