# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The filter "Surface Reconstruction: Neural Mesh" for pymeshlab. Importing this module makes it a method of MeshSet:

    import neural_mesh, pymeshlab
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh("cloud.ply")
    ms.generate_surface_reconstruction_neural_mesh(target_vertices=5000)
"""

from importlib import metadata
from pathlib import Path

BUILT_FOR = "2025.7"  # the release of pymeshlab; its post-releases have the same interface
FILTER = "generate_surface_reconstruction_neural_mesh"
PLUGIN = Path(__file__).with_name("libfilter_neuralmesh.so")
__version__ = metadata.version("neural-mesh")


def _check_release():
    try:
        found = metadata.version("pymeshlab")
    except metadata.PackageNotFoundError:
        raise ImportError(f"neural-mesh {__version__} needs pymeshlab {BUILT_FOR}, and no pymeshlab is installed: "
                          f"run 'pip install pymeshlab=={BUILT_FOR}.*'.") from None
    if found.split(".post")[0] != BUILT_FOR:
        raise ImportError(f"neural-mesh {__version__} is built for pymeshlab {BUILT_FOR}, but pymeshlab {found} is "
                          f"installed: run 'pip install pymeshlab=={BUILT_FOR}.*', or install the neural-mesh that is "
                          f"built for pymeshlab {found}.")


def _add_method():
    import pymeshlab
    if FILTER not in pymeshlab.filter_list():  # else the caller has loaded the plugin
        pymeshlab.load_plugin(str(PLUGIN))
    method = pymeshlab.bind_function(FILTER)  # as pymeshlab does for its own filters
    method.__doc__ = """Reconstructs the surface of the current layer's points as a triangle mesh, a new layer.

The mesh has exactly `target_vertices` vertices (default 10000), dense where the surface bends and sparse where it is
flat. The vertex quality measures how much it bends. All parameters and results are in the README of Neural Mesh;
pymeshlab.print_filter_parameter_list('%s') lists the parameters.

Returns a dict: vertices, faces, genus, components, rms_error, warnings and others. Raises PyMeshLabException with a
sentence that says what to do.""" % FILTER
    setattr(pymeshlab.MeshSet, FILTER, method)


_check_release()
_add_method()
