# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The filters of Neural Mesh for pymeshlab. Importing this module makes them methods of MeshSet:

    import neural_mesh, pymeshlab
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh("cloud.ply")
    ms.generate_surface_reconstruction_neural_mesh(target_vertices=5000)

    ms.load_new_mesh("mesh.ply")
    ms.compute_scalar_by_neural_normal_counter_per_vertex(select_features=True)

neural_mesh.log() gives the warnings and notes of the last run in this thread, also with MeshSet(verbose=False). Each
warning is a Python warning, too, of the category neural_mesh.NeuralMeshWarning.
"""

import sys
from importlib import metadata
from pathlib import Path

from neural_mesh import run_log
from neural_mesh.run_log import Log, Message, NeuralMeshWarning, log

__all__ = ["COUNTERS", "FILTER", "Log", "Message", "NeuralMeshWarning", "log"]

BUILT_FOR = "2025.7"  # the release of pymeshlab; its post-releases have the same interface
FILTER = "generate_surface_reconstruction_neural_mesh"
COUNTERS = "compute_scalar_by_neural_normal_counter_per_vertex"
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


_DOCUMENTATION = {
    FILTER: """Reconstructs the surface of the current layer's points as a triangle mesh, a new layer.

The mesh has exactly `target_vertices` vertices (default 10000), dense where the surface bends and sparse where it is
flat. The vertex quality measures how much it bends. All parameters and results are in the pages of Neural Mesh;
pymeshlab.print_filter_parameter_list('%s') lists the parameters.

Returns a dict: vertices, faces, genus, components, rms_error, warnings and others. neural_mesh.log() gives the warnings
and notes as sentences. Raises PyMeshLabException with a sentence that says what to do.""",
    COUNTERS: """Computes how much of a feature each vertex of the current mesh is, as its scalar.

A copy of the mesh learns random points of the layer `signal_layer` (default: the mesh itself). The scalar holds the
normal counter or, with `feature_measure` 1, the crease measure; `select_features` selects the features. Nothing else
changes. All parameters and results are in the pages of Neural Mesh; pymeshlab.print_filter_parameter_list('%s') lists
the parameters.

Returns a dict: vertices, signals, feature_vertices, mean_counter, seconds and others. neural_mesh.log() gives the
warnings and notes as sentences. Raises PyMeshLabException with a sentence that says what to do.""",
}


def _add_methods():
    import pymeshlab
    if FILTER in pymeshlab.filter_list():  # the caller has loaded the plugin
        run_log.read_messages_of(run_log.loaded_file(PLUGIN.name))
    else:
        pymeshlab.load_plugin(str(PLUGIN))
        run_log.read_messages_of(PLUGIN)
    for name, documentation in _DOCUMENTATION.items():
        method = pymeshlab.bind_function(name)  # as pymeshlab does for its own filters
        method.__doc__ = documentation % name
        setattr(pymeshlab.MeshSet, name, method)
    run_log.warn_after(_DOCUMENTATION, pymeshlab.MeshSet)


try:
    _check_release()
except ImportError as error:
    called = sys.argv[0] if sys.argv else ""
    if called == "-m" or Path(called).name == "neural-mesh":  # -m: while python looks for the module to run
        sys.exit(f"neural-mesh: {error}")  # a sentence, and no traceback, for the command
    raise
_add_methods()
