# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The mesh that reconstruct() returns, as arrays, and as objects and files of other programs."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, List, Optional, Union

import numpy as np

if TYPE_CHECKING:
    import open3d
    import pymeshlab
    import trimesh


class Report(Dict[str, Union[int, float]]):
    """The figures of a run by name, such as report["rms_error"]: those that the filter in pymeshlab returns."""

    def __init__(self, figures: Dict[str, Any], warnings: List[str], notes: List[str]) -> None:
        super().__init__(figures)
        self.warnings = warnings  #: full sentences: reasons to look at the mesh
        self.notes = notes  #: the same, of what is no reason for doubt


@dataclass
class Creases:
    """The sharp edges of a mesh as polylines, which meet at corners."""

    vertices: np.ndarray  #: (k, 3) float64, in the coordinates of the cloud
    edges: np.ndarray  #: (e, 2) int32, indices of `vertices`
    quality: np.ndarray  #: (k,) float32, the crease measure: above 1 on sharp edges


@dataclass
class Mesh:
    """A triangle mesh, counter-clockwise seen from outside, with one number for each vertex.

    The arrays of a reconstruction are views of the library's memory, which lives as long as any of them."""

    vertices: np.ndarray  #: (n, 3) float64, in the coordinates of the cloud
    faces: np.ndarray  #: (m, 3) int32, indices of `vertices`
    quality: np.ndarray  #: (n,) float32, >= 0: the normal counter or, with feature_measure 1, the crease measure
    features: np.ndarray  #: (n,) bool: which vertices are features, by select_by and feature_threshold
    colors: Optional[np.ndarray]  #: (n, 3) uint8: red, green, blue; None: there are none
    creases: Optional[Creases]  #: with crease_lines; None: there are none
    report: Report

    def save(self, path: Union[str, Path]) -> None:
        """Writes a file: PLY with quality and colours, as MeshLab writes it, OBJ or OFF with colours; coordinates in
        double precision. The name's ending chooses. Raises ValueError for another ending, OSError if it cannot be written."""
        from neural_mesh.mesh_writers import WRITERS
        path = Path(path)
        writer = WRITERS.get(path.suffix.lower())
        if writer is None:
            raise ValueError(f"{path} cannot be written: the name of the file must end in {' or '.join(WRITERS)}.")
        with path.open("wb") as file:
            writer(file, self)

    def to_trimesh(self) -> "trimesh.Trimesh":
        """The mesh for trimesh, with colours, and with the quality as vertex_attributes["quality"]. Raises ImportError
        without trimesh."""
        import trimesh
        return trimesh.Trimesh(self.vertices, self.faces, vertex_colors=self.colors, process=False,
                               vertex_attributes={"quality": self.quality})

    def to_open3d(self) -> "open3d.geometry.TriangleMesh":
        """The mesh for Open3D, with colours and vertex normals. Raises ImportError without open3d."""
        import open3d
        mesh = open3d.geometry.TriangleMesh(open3d.utility.Vector3dVector(self.vertices),
                                            open3d.utility.Vector3iVector(self.faces))
        if self.colors is not None:
            mesh.vertex_colors = open3d.utility.Vector3dVector(self.colors / 255)
        return mesh.compute_vertex_normals()

    def to_pymeshlab(self) -> "pymeshlab.Mesh":
        """The mesh for MeshSet.add_mesh() of pymeshlab, with quality and colours. Raises ImportError without pymeshlab."""
        import pymeshlab
        attributes: Dict[str, np.ndarray] = {"v_scalar_array": self.quality.astype(float)}
        if self.colors is not None:
            attributes["v_color_matrix"] = np.column_stack([self.colors / 255, np.ones(len(self.colors))])
        return pymeshlab.Mesh(self.vertices, self.faces, **attributes)
