# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Files of clouds as arrays, and meshes as files, for the commands. What the package cannot read or write itself, pymeshlab
does, where it is installed."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, Dict

import numpy as np

from neural_mesh import __version__, filters
from neural_mesh.clouds import FORMATS, CloudError, PlyCloud, open_cloud
from neural_mesh.mesh import Mesh
from neural_mesh.mesh_writers import WRITERS

CHUNK = 500_000  # points


class NotWhole(Exception):
    """The message is a sentence."""


def load(path: Path, verbose: bool = False) -> Dict[str, Any]:
    """The points of a file, with colours, normals and faces if it has them, as arguments of reconstruct(). `verbose`:
    pymeshlab's warnings are printed. Raises CloudError with a sentence."""
    lack = filters.why_not(__version__)
    if path.suffix.lower() == ".ply":
        try:
            arrays = PlyCloud(path).arrays()
        except CloudError:  # a kind that PlyCloud does not know, or no PLY: then pymeshlab says so
            arrays = None
            if lack:
                raise
        except OSError as error:
            raise CloudError(f"{path} cannot be read: {error.strerror}.") from None
        if arrays is not None:
            return arrays
    if not lack:
        return _by_pymeshlab(path, verbose)
    if path.suffix.lower() not in FORMATS:
        raise CloudError(f"{path} has no ending that is read without pymeshlab ({', '.join(FORMATS)}). {lack}")
    return {"points": np.concatenate(list(open_cloud(path).chunks(CHUNK)))}


def _by_pymeshlab(path: Path, verbose: bool) -> Dict[str, Any]:
    import pymeshlab
    meshes = pymeshlab.MeshSet(verbose=verbose)
    try:
        meshes.load_new_mesh(str(path))
    except pymeshlab.PyMeshLabException as error:
        text = str(error)
        raise CloudError(f"{text.partition('Error details: ')[2] or text.splitlines()[-1]}.") from None
    layer = meshes.current_mesh()
    arrays = {"points": layer.transformed_vertex_matrix(), "normals": layer.transformed_vertex_normal_matrix()}
    if layer.face_number():
        arrays["faces"] = layer.face_matrix()
    if layer.has_vertex_color():
        arrays["colors"] = np.rint(layer.vertex_color_matrix()[:, :3] * 255).astype(np.uint8)
    return arrays


def save_aside(mesh: Mesh, aside: Path, path: Path) -> None:
    """Writes a mesh to `aside`, and gives it the name `path` when it is whole. Raises NotWhole, OSError."""
    try:
        save(mesh, aside)
    except NotWhole as error:
        raise NotWhole(str(error).replace(aside.name, path.name)) from None
    os.replace(aside, path)


def save(mesh: Mesh, path: Path) -> None:
    """Writes a mesh, to PLY with its quality. Raises NotWhole."""
    try:
        if path.suffix.lower() in WRITERS:
            mesh.save(path)
        else:
            _save_by_pymeshlab(mesh, path)
    except OSError as error:
        raise NotWhole(f"The mesh {path.name} could not be written whole ({error.strerror}): is there space left?") from None


def _save_by_pymeshlab(mesh: Mesh, path: Path) -> None:
    if lack := filters.why_not(__version__):
        raise NotWhole(f"The mesh {path.name} is written by pymeshlab, other than {', '.join(WRITERS)}. {lack}")
    import pymeshlab
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(mesh.to_pymeshlab())
    copies = pymeshlab.MeshSet(verbose=False)
    try:
        meshes.save_current_mesh(str(path))
        copies.load_new_mesh(str(path))  # pymeshlab does not notice when no space is left
    except pymeshlab.PyMeshLabException as error:
        raise NotWhole(f"The mesh {path.name} could not be written: {str(error).splitlines()[-1]}") from None
    copy = copies.current_mesh()
    if (copy.vertex_number(), copy.face_number()) != (len(mesh.vertices), len(mesh.faces)):
        raise NotWhole(f"The mesh {path.name} could not be written whole: is there space left?")
