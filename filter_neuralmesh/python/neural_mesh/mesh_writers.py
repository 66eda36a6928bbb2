# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Writes meshes to open files, in blocks, so that a large one needs little memory."""

from __future__ import annotations

from typing import TYPE_CHECKING, BinaryIO, Iterator

import numpy as np

if TYPE_CHECKING:
    from neural_mesh.mesh import Mesh

BLOCK = 100_000  # rows at a time


def _blocks(count: int) -> Iterator[slice]:
    return (slice(first, min(first + BLOCK, count)) for first in range(0, count, BLOCK))


def write_ply(file: BinaryIO, mesh: "Mesh") -> None:
    """Binary, with the names and types that MeshLab gives coordinates, colours and quality in its double build."""
    fields = [("x", "<f8"), ("y", "<f8"), ("z", "<f8")]
    if mesh.colors is not None:
        fields += [("red", "u1"), ("green", "u1"), ("blue", "u1"), ("alpha", "u1")]
    fields.append(("quality", "<f8"))
    words = {"<f8": "double", "u1": "uchar"}
    file.write("\n".join([
        "ply", "format binary_little_endian 1.0", f"element vertex {len(mesh.vertices)}",
        *(f"property {words[kind]} {name}" for name, kind in fields), f"element face {len(mesh.faces)}",
        "property list uchar int vertex_indices", "end_header", ""]).encode())
    for rows in _blocks(len(mesh.vertices)):
        block = np.empty(rows.stop - rows.start, fields)
        for column, axis in enumerate("xyz"):
            block[axis] = mesh.vertices[rows, column]
        if mesh.colors is not None:
            for column, name in enumerate(("red", "green", "blue")):
                block[name] = mesh.colors[rows, column]
            block["alpha"] = 255
        block["quality"] = mesh.quality[rows]
        file.write(block)
    for rows in _blocks(len(mesh.faces)):
        block = np.empty(rows.stop - rows.start, [("count", "u1"), ("corners", "<i4", 3)])
        block["count"], block["corners"] = 3, mesh.faces[rows]
        file.write(block)


def write_obj(file: BinaryIO, mesh: "Mesh") -> None:
    """Colours, from 0 to 1, follow the coordinates, as MeshLab and Blender read them. They are a quarter of a step of
    1/255 more than they should: MeshLab rounds down, others to the nearest."""
    file.write(b"# Neural Mesh\n")
    for rows in _blocks(len(mesh.vertices)):
        values, words = mesh.vertices[rows], "v %.17g %.17g %.17g"
        if mesh.colors is not None:
            values = np.column_stack([values, np.minimum((mesh.colors[rows] + .25) / 255, 1)])
            words += " %.6g %.6g %.6g"
        np.savetxt(file, values, words)
    for rows in _blocks(len(mesh.faces)):
        np.savetxt(file, mesh.faces[rows].astype(np.int64) + 1, "f %d %d %d")


def write_off(file: BinaryIO, mesh: "Mesh") -> None:
    """Colours from 0 to 255 follow the coordinates."""
    file.write(f"{'OFF' if mesh.colors is None else 'COFF'}\n{len(mesh.vertices)} {len(mesh.faces)} 0\n".encode())
    for rows in _blocks(len(mesh.vertices)):
        values, words = mesh.vertices[rows], "%.17g %.17g %.17g"
        if mesh.colors is not None:
            values, words = np.column_stack([values, mesh.colors[rows]]), words + " %d %d %d 255"
        np.savetxt(file, values, words)
    for rows in _blocks(len(mesh.faces)):
        np.savetxt(file, mesh.faces[rows], "3 %d %d %d")


WRITERS = {".ply": write_ply, ".obj": write_obj, ".off": write_off}
