#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""A mesh of few vertices with all colours of the cloud, as a texture: texture_pymeshlab.py CLOUD OUT.obj [VERTICES]"""

import sys
from pathlib import Path

import neural_mesh  # noqa: F401  adds the method
import pymeshlab

cloud, out, vertices = sys.argv[1], sys.argv[2], int((*sys.argv, 2000)[3])
ms = pymeshlab.MeshSet()
ms.load_new_mesh(cloud)
ms.generate_surface_reconstruction_neural_mesh(target_vertices=vertices)
mesh = ms.current_mesh_id()
ms.compute_texcoord_parametrization_triangle_trivial_per_wedge(textdim=2048)
ms.transfer_attributes_to_texture_per_vertex(sourcemesh=0, targetmesh=mesh, textname=f"{Path(out).stem}.png", textw=2048,
                                             texth=2048, upperbound=pymeshlab.PercentageValue(5))
ms.save_current_mesh(out, save_vertex_color=False)
