# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Makes a neural mesh in meshes/ of each cloud in clouds/, with one process per core.

folder_pymeshlab.py PLUGIN
"""
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import pymeshlab


def start(plugin):
    # One MeshSet for all clouds: pymeshlab 2025.7 crashes if a MeshSet in which a filter has raised is deleted and
    # another one loads a file.
    global meshes
    pymeshlab.load_plugin(plugin)
    meshes = pymeshlab.MeshSet(verbose=False)


def reconstruct(cloud):
    meshes.clear()
    meshes.load_new_mesh(str(cloud))
    try:
        report = meshes.apply_filter("generate_surface_reconstruction_neural_mesh", target_vertices=2000, threads=1)
    except pymeshlab.PyMeshLabException as error:
        return f"{cloud.name}: {error}"
    meshes.save_current_mesh(str(Path("meshes") / cloud.name), save_vertex_quality=True)
    return f"{cloud.name}: {report['vertices']} vertices, RMS {report['rms_error']:.3f} %"


if __name__ == "__main__":
    Path("meshes").mkdir(exist_ok=True)
    with ProcessPoolExecutor(initializer=start, initargs=sys.argv[1:2]) as pool:
        for line in pool.map(reconstruct, sorted(Path("clouds").glob("*.ply"))):
            print(line)
