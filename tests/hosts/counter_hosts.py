# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Runs the counters of a given mesh in each host on the layers of inputs.counted_inputs()."""

from dataclasses import dataclass

import input_hosts
import inputs
import meshlabserver
import numpy as np

KEPT = ("vc", "fc", "ff", "wt", "mp")  # what meshlabserver saves besides the attributes that the filter writes


@dataclass
class Counted:
    """What a host returned. Arrays have one entry per vertex that is not deleted."""

    sentence: str = ""  # the error message; empty: there are counters
    quality: np.ndarray = None
    selected: np.ndarray = None
    report: dict = None
    rest_unchanged: bool = True  # all but quality and selection; after an error, these too


def in_server(build, server, pymeshlab, layer, folder):
    script = input_hosts.write_script(build, layer, folder)
    out, kept, copy = (folder / name for name in ("out.ply", "kept.ply", "kept_copy.ply"))
    code, text = meshlabserver.run(server, *input_hosts.server_input(layer, folder), "-o", copy, "-l", 0, "-m", *KEPT,
                                   "-o", kept, "-l", 1, "-m", *KEPT, "-o", out, "-l", 1, "-m", "vq", "vf", "-s", script)
    assert code in (0, 255), f"ended with code {code}: {text[-2000:]}"
    if code != 0:
        return Counted(sentence=input_hosts.sentence_of_server(text))
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.load_new_mesh(str(out))
    mesh = meshes.current_mesh()
    same = kept.read_bytes() == copy.read_bytes() or layer.deleted.any()
    return Counted(quality=mesh.vertex_scalar_array().astype("f4"), selected=mesh.vertex_selection_array().copy(),
                   report=meshlabserver.figures(text), rest_unchanged=same)


def without_values(state):
    """input_hosts.state() without scalars and selection of the vertices."""
    layers, current = state
    return [(*layer[:6], layer[6][1 if layer[5][0] else 0:], *layer[8:]) for layer in layers], current


def in_pymeshlab(pymeshlab, layer, folder):
    meshes = input_hosts.load(pymeshlab, layer, folder)
    before = input_hosts.state(meshes)
    try:
        report = meshes.apply_filter(inputs.COUNTERS, **layer.all_parameters())
    except pymeshlab.PyMeshLabException as error:
        return Counted(sentence=str(error).split("Details: ", 1)[1].strip(),
                       rest_unchanged=input_hosts.state(meshes) == before)
    mesh = meshes.current_mesh()
    return Counted(quality=mesh.vertex_scalar_array().astype("f4"), selected=mesh.vertex_selection_array().copy(),
                   report=report, rest_unchanged=without_values(input_hosts.state(meshes)) == without_values(before))


def count(build, server, pymeshlab, host, layer, folder):
    if host == input_hosts.SERVER:
        return in_server(build, server, pymeshlab, layer, folder)
    return in_pymeshlab(pymeshlab, layer, folder)
