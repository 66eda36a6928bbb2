# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Every cloud of the folder clouds/ becomes a neural mesh in meshes/, one process per core.

folder_pymeshlab.py PLUGIN
"""
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import pymeshlab


def start(plugin):
    pymeshlab.load_plugin(plugin)


def reconstruct(cloud):
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.load_new_mesh(str(cloud))
    told = meshes.apply_filter("generate_surface_reconstruction_neural_mesh", target_vertices=2000, threads=1)
    meshes.save_current_mesh(str(Path("meshes") / cloud.name), save_vertex_quality=True)
    return cloud.name, told["vertices"], told["rms_error"]


if __name__ == "__main__":
    Path("meshes").mkdir(exist_ok=True)
    with ProcessPoolExecutor(initializer=start, initargs=sys.argv[1:2]) as pool:
        for name, vertices, rms in pool.map(reconstruct, sorted(Path("clouds").glob("*.ply"))):
            print(f"{name}: {vertices} vertices, RMS {rms:.3f} %")
