# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Triangle meshes with exactly as many vertices as asked for, learned from point clouds.

    import neural_mesh
    mesh = neural_mesh.reconstruct(points, target_vertices=5000)    # points: an array of shape (n, 3)
    print(mesh.vertices, mesh.faces, mesh.report["rms_error"])
    mesh.save("mesh.ply")

Where pymeshlab is installed, importing this module makes the filters methods of MeshSet:

    import neural_mesh, pymeshlab
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh("cloud.ply")
    ms.generate_surface_reconstruction_neural_mesh(target_vertices=5000)

    ms.load_new_mesh("mesh.ply")
    ms.compute_scalar_by_neural_normal_counter_per_vertex(select_features=True)

neural_mesh.log() gives the warnings and notes of the last run of a filter in this thread, also with
MeshSet(verbose=False); mesh.report has those of reconstruct(). Each warning is a Python warning, too, of the category
neural_mesh.NeuralMeshWarning.
"""

import sys
import warnings
from importlib import metadata
from pathlib import Path

from neural_mesh import filters
from neural_mesh.filters import COUNTERS, FILTER
from neural_mesh.library import Parameter
from neural_mesh.mesh import Creases, Mesh, Report
from neural_mesh.reconstruction import counters, parameter_list, reconstruct
from neural_mesh.run_log import Log, Message, NeuralMeshWarning, log

__all__ = ["COUNTERS", "Creases", "FILTER", "Log", "Mesh", "Message", "NeuralMeshWarning", "Parameter", "Report",
           "counters", "log", "parameter_list", "reconstruct"]
__version__ = metadata.version("neural-mesh")

if filters.is_expected():
    _sentence = filters.why_not(__version__)
    _called = sys.argv[0] if sys.argv else ""
    if not _sentence:
        filters.add_methods()
    elif _called != "-m" and Path(_called).name != "neural-mesh":  # the command says it where it matters
        warnings.warn(_sentence, NeuralMeshWarning, stacklevel=2)
