# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Writes meshes, and makes sure that they are whole: pymeshlab does not notice when no space is left."""

from pathlib import Path

import pymeshlab


class NotWhole(Exception):
    """The message is a sentence."""


def save(meshes: pymeshlab.MeshSet, mesh: Path) -> None:
    """Writes the current mesh, to PLY with its quality. Throws NotWhole, and PyMeshLabException."""
    is_ply = mesh.suffix.lower() == ".ply"
    meshes.save_current_mesh(str(mesh), **({"save_vertex_quality": True} if is_ply else {}))
    if not (_is_whole_ply(mesh) if is_ply else _loads_whole(mesh, meshes.current_mesh())):
        raise NotWhole(f"The mesh {mesh.name} could not be written whole: is there space left?")


def _loads_whole(mesh: Path, original: pymeshlab.Mesh) -> bool:
    try:
        copies = pymeshlab.MeshSet(verbose=False)
        copies.load_new_mesh(str(mesh))
    except pymeshlab.PyMeshLabException:
        return False
    copy = copies.current_mesh()
    return (copy.vertex_number(), copy.face_number()) == (original.vertex_number(), original.face_number())


def _is_whole_ply(mesh: Path) -> bool:
    """Whether the file is as long as its header says."""
    sizes = {"double": 8, "float": 4, "int": 4, "uint": 4, "short": 2, "ushort": 2, "char": 1, "uchar": 1}
    expected = 0
    count = 0
    with mesh.open("rb") as file:
        for line in file:
            word, *rest = line.decode("ascii", "replace").split() or [""]
            if word == "element":
                count = int(rest[1])
            elif word == "property" and rest[0] == "list":  # of three corners
                expected += count * (sizes[rest[1]] + 3 * sizes[rest[2]])
            elif word == "property":
                expected += count * sizes[rest[0]]
            elif word == "end_header":
                return mesh.stat().st_size == file.tell() + expected
    return False
