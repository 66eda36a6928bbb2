# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The filters of Neural Mesh as methods of pymeshlab's MeshSet, where pymeshlab is installed."""

from importlib import metadata
from pathlib import Path

from neural_mesh import run_log

BUILT_FOR = "2025.7"  # the release of pymeshlab; its post-releases have the same interface
FILTER = "generate_surface_reconstruction_neural_mesh"
COUNTERS = "compute_scalar_by_neural_normal_counter_per_vertex"
PLUGIN = Path(__file__).with_name("libfilter_neuralmesh.so")  # only wheels for Linux on x86-64 have it
_RESULTS = """ All parameters and results are in the pages of Neural Mesh; pymeshlab.print_filter_parameter_list('%s')
lists the parameters. Returns a dict of figures; neural_mesh.log() gives the warnings and notes as sentences. Raises
PyMeshLabException with a sentence that says what to do."""
_DOCUMENTATION = {
    FILTER: """Reconstructs the surface of the current layer's points as a triangle mesh, a new layer.

The mesh has exactly `target_vertices` vertices (default 10000), dense where the surface bends and sparse where it is
flat. The vertex quality measures how much it bends.""" + _RESULTS,
    COUNTERS: """Computes how much of a feature each vertex of the current mesh is, as its scalar.

A copy of the mesh learns random points of the layer `signal_layer` (default: the mesh itself). The scalar holds the
normal counter or, with `feature_measure` 1, the crease measure; `select_features` selects the features.""" + _RESULTS,
}


def why_not(version: str) -> str:
    """A sentence on why MeshSet has no filters of Neural Mesh; empty: it has them. `version`: of neural-mesh."""
    install = f"run 'pip install pymeshlab=={BUILT_FOR}.*'"
    if not PLUGIN.exists():
        return (f"neural-mesh {version} has no filters for pymeshlab on this system, only on Linux on x86-64: use "
                "neural_mesh.reconstruct().")
    try:
        found = metadata.version("pymeshlab")
    except metadata.PackageNotFoundError:
        return f"The filters of neural-mesh {version} need pymeshlab {BUILT_FOR}, and no pymeshlab is installed: {install}."
    if found.split(".post")[0] != BUILT_FOR:
        return (f"The filters of neural-mesh {version} are built for pymeshlab {BUILT_FOR}, but pymeshlab {found} is "
                f"installed: {install}, or install the neural-mesh that is built for pymeshlab {found}.")
    try:
        import pymeshlab  # noqa: F401
    except ImportError as error:
        return f"The filters of neural-mesh {version} need pymeshlab, which cannot be imported: {error}."
    return ""


def is_expected() -> bool:
    """Whether the user, who has pymeshlab, may look for the filters in it."""
    try:
        metadata.version("pymeshlab")
    except metadata.PackageNotFoundError:
        return False
    return PLUGIN.exists()


def add_methods() -> None:
    """Loads the plugin, unless the caller has, and adds the methods. why_not() must be empty."""
    import pymeshlab
    if FILTER in pymeshlab.filter_list():
        run_log.read_messages_of(run_log.loaded_file(PLUGIN.name))
    else:
        pymeshlab.load_plugin(str(PLUGIN))
        run_log.read_messages_of(PLUGIN)
    for name, documentation in _DOCUMENTATION.items():
        method = pymeshlab.bind_function(name)  # as pymeshlab does for its own filters
        method.__doc__ = documentation % name
        setattr(pymeshlab.MeshSet, name, method)
    run_log.warn_after(_DOCUMENTATION, pymeshlab.MeshSet)
