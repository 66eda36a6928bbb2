# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Reads the vertices of a PLY file into a numpy table, so that the demo needs no mesh library.

The camera and the legend of a picture need the vertices only.
"""

import numpy as np

TYPES = {"char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2",
         "ushort": "u2", "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4",
         "float": "f4", "float32": "f4", "double": "f8", "float64": "f8"}


def read_header(file, path):
    """Returns (format, number of vertices, [(property, numpy type)]), the file left at the first vertex."""
    if file.readline().strip() != b"ply":
        raise ValueError(f"{path} is not a PLY file.")
    storage, count, fields, element = None, None, [], None
    for line in iter(file.readline, b""):
        words = line.decode("ascii", "replace").split()
        if words[:1] == ["end_header"]:
            break
        if words[:1] == ["format"]:
            storage = words[1]
        elif words[:1] == ["element"]:
            if element is None and words[1] != "vertex":
                raise ValueError(f"{path} does not begin with its vertices: save it again with MeshLab.")
            element = words[1]
            count = int(words[2]) if element == "vertex" else count
        elif words[:1] == ["property"] and element == "vertex":
            fields.append((words[2], TYPES[words[1]]))
    if storage in (None, "ascii") or count is None:
        raise ValueError(f"{path} has no binary vertices.")
    return storage, count, fields


def read_vertices(path):
    """The vertex element of a binary PLY file as a structured array, one field per property.

    Raises ValueError with a sentence when the file is not a PLY file or ends too soon.
    """
    with open(path, "rb") as file:
        storage, count, fields = read_header(file, path)
        order = "<" if storage == "binary_little_endian" else ">"
        table_type = np.dtype([(name, order + kind) for name, kind in fields])
        data = file.read(count * table_type.itemsize)
        if len(data) < count * table_type.itemsize:
            raise ValueError(f"{path} ends before its last vertex.")
        return np.frombuffer(data, dtype=table_type)


def positions(vertices):
    """Vertex positions, an n x 3 array of doubles."""
    return np.column_stack([vertices[axis].astype("f8") for axis in "xyz"])
