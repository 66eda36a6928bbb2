#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Crease vertices of meshes that other filters made: the counters of a given mesh, and analyses of that mesh.

    given_meshes.py --plugin LIBRARY.so [--data FOLDER] [--out FOLDER]

The models are CAD parts. Two meshes of each: *poisson*, Screened Poisson tuned for noise and Quadric Edge Collapse of
the noisy cloud; *even*, an isotropic remeshing of the true surface whose vertices have the noise of the cloud. The
counters learn signals from the *cloud* or from the *faces* of the mesh itself. True features and the thresholds of the
other measures are those of selection_table.py. Prints the F1, mean over the models, for each mesh and each source of
signals, and writes OUT/given_meshes.md.
"""

import json
import sys

import numpy as np
import pymeshlab

import features
import import_paths  # noqa: F401
import models
import peers
import selection_table

FILTER = "compute_scalar_by_neural_normal_counter_per_vertex"
MESHES = ("poisson", "even")
SIGNALS = ("cloud", "faces")
REMESHING_ROUNDS = 8


def evenly_remeshed(vertices, faces, count):
    """About count vertices, evenly spaced on the surface; creases stay."""
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(vertices, faces))
    meshes.meshing_merge_close_vertices()
    area = meshes.get_geometric_measures()["surface_area"]
    edge = np.sqrt(2 * area / (np.sqrt(3) * count))  # of equilateral triangles, two per vertex
    meshes.meshing_isotropic_explicit_remeshing(iterations=REMESHING_ROUNDS, targetlen=pymeshlab.PureValue(edge),
                                                checksurfdist=False)
    return meshes.current_mesh().vertex_matrix(), meshes.current_mesh().face_matrix()


def even(surface, _cloud, count, noise):
    vertices, faces = evenly_remeshed(*surface, count)
    spread = noise / 100 * models.diagonal(surface[0])
    return vertices + spread * np.random.default_rng(7).standard_normal(vertices.shape), faces


def poisson(_surface, cloud, count, _noise):
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(cloud))
    peers.reconstruct_poisson_smooth(meshes, count)
    # Else the collapse of a noisy mesh leaves edges that no manifold has.
    meshes.meshing_decimation_quadric_edge_collapse(targetfacenum=2 * count, preservetopology=True)
    meshes.meshing_remove_unreferenced_vertices()
    return meshes.current_mesh().vertex_matrix(), meshes.current_mesh().face_matrix()


def counted(vertices, faces, cloud=None, **settings):
    """A features.Mesh with the counters by signals from the cloud, or from the faces."""
    meshes = pymeshlab.MeshSet(verbose=False)
    if cloud is not None:
        meshes.add_mesh(pymeshlab.Mesh(cloud))
    meshes.add_mesh(pymeshlab.Mesh(vertices, faces))
    values = []
    for measure in (0, 1):
        meshes.apply_filter(FILTER, signal_layer=0, feature_measure=measure, **settings)
        values.append(meshes.current_mesh().vertex_scalar_array().copy())
    return features.Mesh(vertices, faces, *values)


def truth_of(mesh, creases):
    return creases.distance(mesh.positions) <= 0.5 * mesh.edge_length()


def rows_of(name, noise, options):
    surface = features.load(name, options.data)
    creases = features.Creases(*surface)
    cloud = models.make_cloud(*surface, options.samples, noise)
    for kind in MESHES:
        vertices, faces = {"poisson": poisson, "even": even}[kind](surface, cloud, options.vertices, noise)
        for signals in SIGNALS:
            mesh = counted(vertices, faces, cloud if signals == "cloud" else None)
            truth = truth_of(mesh, creases)
            curves = {key: selection_table.f1_curve(x, truth) for key, x in selection_table.measures_of(mesh)}
            yield {"model": name, "noise": noise, "mesh": kind, "signals": signals, "curves": curves}


def parse(arguments):
    parser = features.parser_of(__doc__, selection_table.MODELS)
    parser.add_argument("--plugin", required=True, help="the plugin for pymeshlab")
    return parser.parse_args(arguments)


def main(arguments=None):
    options = parse(arguments)
    pymeshlab.load_plugin(options.plugin)
    rows = []
    for name in options.models:
        for noise in options.noise:
            try:
                rows += rows_of(name, noise, options)
            except (models.ModelError, pymeshlab.PyMeshLabException) as error:
                print(f"{name}, noise {noise:g} %: {error}", file=sys.stderr)
        print(f"{name}: done", file=sys.stderr, flush=True)
    text = "\n\n".join(f"{kind}, signals from the {signals}\n\n"
                       + selection_table.report([r for r in rows if (r["mesh"], r["signals"]) == (kind, signals)])
                       for kind in MESHES for signals in SIGNALS)
    options.out.mkdir(parents=True, exist_ok=True)
    (options.out / "given_meshes.md").write_text(text + "\n")
    (options.out / "given_meshes.json").write_text(json.dumps(rows))
    print(text)


if __name__ == "__main__":
    main()
