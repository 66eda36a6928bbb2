# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""reconstruct() and counters(): from numpy arrays to a mesh, without pymeshlab."""

from __future__ import annotations

import functools
import math
import warnings
from typing import Any, Dict, Optional, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike

from neural_mesh.library import COUNTERS, RECONSTRUCTION, Parameter, Progress, Result, Task
from neural_mesh.library import parameters as parameters_of
from neural_mesh.mesh import Creases, Mesh, Report
from neural_mesh.run_log import NeuralMeshWarning

GIVEN_MESH = 2  # of the parameter start_mesh


def reconstruct(points: ArrayLike, *, colors: Optional[ArrayLike] = None, normals: Optional[ArrayLike] = None,
                faces: Optional[ArrayLike] = None, start: Any = None, progress: Union[None, bool, Progress] = None,
                **parameters: Any) -> Mesh:
    """Learns a triangle mesh with exactly `target_vertices` vertices (default 10000) from a point cloud.

    points      (n, 3), in any unit: float32 and float64 are read where they are, whatever their strides
    colors      (n, 3) or (n, 4): uint8 from 0 to 255, or floats from 0 to 1; the mesh gets them
    normals     (n, 3), of any length; they say which side of an open surface faces out
    faces       (m, 3), indices of points: learns the surface of these faces, unless draw_from_faces is False
    start       a mesh to start learning from: a Mesh, or any object with `vertices` and `faces`, or a pair of arrays
    progress    True: a bar of tqdm. A function f(part, activity), part from 0 to 1: is called while learning; if it
                returns False, learning ends early with the mesh so far (report["stop_reason"] is 2)
    parameters  those of the filter, such as target_vertices=5000, surface="Open", close_holes_up_to="2%": a choice is
                its name or number, a length is in the unit of the points, or a text with a % of their diagonal.
                neural_mesh.parameter_list() lists them.

    The same arguments give the same mesh, bit by bit, on every system and with any number of threads. Other Python
    threads run meanwhile. Ctrl-C ends it.

    Warnings are in mesh.report.warnings, and Python warnings of the category NeuralMeshWarning.
    Raises ValueError with a sentence that says what to do: wrong parameters or shapes, coordinates that are not finite,
    points that show no surface; MemoryError; and what `progress` raises."""
    with Task(RECONSTRUCTION) as task:
        cloud = _give(task, points=points, colors=colors, normals=normals, faces=faces)
        if start is not None:
            task.set_arrays("mesh", *_arrays_of(start, "start"))
            parameters.setdefault("start_mesh", GIVEN_MESH)
        set_parameters(task, parameters_of(RECONSTRUCTION), parameters, cloud["points"])
        result = _run(task, progress)
    assert result.vertices is not None and result.faces is not None
    creases = None
    if result.crease_edges is not None:
        creases = Creases(result.crease_vertices, result.crease_edges, result.crease_quality)
    return _mesh(result.vertices, result.faces, result.colors, creases, result)


def counters(mesh: Any, points: Optional[ArrayLike] = None, *, faces: Optional[ArrayLike] = None,
             progress: Union[None, bool, Progress] = None, **parameters: Any) -> Mesh:
    """Computes how much of a feature each vertex of a given mesh is. Returns the mesh with `quality` and `features`.

    mesh        a Mesh, or any object with `vertices` and `faces` (or `triangles`), or a pair of arrays: an oriented
                manifold, with or without boundaries. It stays as it is
    points      (n, 3): the cloud it was made of, in the same coordinates; without it, the mesh itself is learned
    faces       (m, 3), indices of points: learns the surface of these faces instead
    progress    as in reconstruct()
    parameters  those of the filter compute_scalar_by_neural_normal_counter_per_vertex, such as feature_measure=1;
                neural_mesh.parameter_list("counters") lists them

    Vertices that belong to no face get 0. Raises what reconstruct() raises."""
    vertices, corners = _arrays_of(mesh, "mesh")
    with Task(COUNTERS) as task:
        task.set_arrays("mesh", vertices, corners)
        _give(task, points=points, faces=faces)
        set_parameters(task, parameters_of(COUNTERS), parameters, vertices)
        result = _run(task, progress)
    return _mesh(vertices, corners, getattr(mesh, "colors", None), None, result)


def parameter_list(what: str = "reconstruct") -> Dict[str, Parameter]:
    """The parameters of reconstruct() or, given "counters", of counters(), by name: label, help, kind, range, default
    and the names of choices."""
    return dict(parameters_of({"reconstruct": RECONSTRUCTION, "counters": COUNTERS}[what]))


def _give(task: Task, **arrays: Any) -> Dict[str, np.ndarray]:
    """Gives the task the arrays that are not None, and returns them as it takes them. Raises ValueError."""
    taken = {}
    for what, values in arrays.items():
        if values is not None:
            taken[what] = {"colors": _colors, "faces": _indices}.get(what, functools.partial(_rows, name=what))(values)
            task.set_arrays(what, taken[what])
    return taken


def _mesh(vertices: np.ndarray, faces: np.ndarray, colors: Optional[np.ndarray], creases: Optional[Creases],
          result: Result) -> Mesh:
    assert result.quality is not None and result.features is not None
    report = Report(result.figures, result.warnings, result.notes)
    for text in report.warnings:
        warnings.warn(text, NeuralMeshWarning, stacklevel=3)
    return Mesh(vertices, faces, result.quality, result.features, colors, creases, report)


def _rows(values: ArrayLike, name: str) -> np.ndarray:
    """(n, 3) of float32 or float64; a view of `values` if they are."""
    try:
        array = np.asarray(values)
        if array.dtype not in (np.float32, np.float64):
            array = array.astype(np.float64)
    except (TypeError, ValueError):
        raise ValueError(f"{name} are no numbers: give an array of shape (n, 3).") from None
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{name} have the shape {array.shape}: give an array of shape (n, 3).")
    return array


def _indices(values: ArrayLike) -> np.ndarray:
    array = np.asarray(values)
    if array.ndim != 2 or array.shape[1] != 3 or array.dtype.kind not in "iu":
        raise ValueError(f"faces have the shape {array.shape} and the type {array.dtype}: give whole numbers in an array "
                         "of shape (m, 3).")
    return array if array.dtype in (np.int32, np.int64) else array.astype(np.int64)


def _colors(values: ArrayLike) -> np.ndarray:
    """(n, 3) of uint8."""
    array = np.asarray(values)
    if array.ndim != 2 or array.shape[1] not in (3, 4):
        raise ValueError(f"colors have the shape {array.shape}: give an array of shape (n, 3) or (n, 4).")
    array = array[:, :3]
    if array.dtype == np.uint8:
        return array
    if array.dtype.kind != "f" or not ((array >= 0) & (array <= 1)).all():
        raise ValueError("colors are neither uint8 from 0 to 255 nor floats from 0 to 1: convert them to one of these.")
    return np.rint(array * 255).astype(np.uint8)


def _arrays_of(mesh: Any, name: str) -> Tuple[np.ndarray, np.ndarray]:
    """Vertices and faces of a mesh of ours, trimesh or Open3D, or of a pair."""
    if isinstance(mesh, (tuple, list)) and len(mesh) == 2:
        return _rows(mesh[0], "vertices"), _indices(mesh[1])
    faces = getattr(mesh, "faces", getattr(mesh, "triangles", None))
    if faces is None or not hasattr(mesh, "vertices"):
        raise ValueError(f"{name} is no mesh: give an object with vertices and faces, or a pair of arrays.")
    return _rows(mesh.vertices, "vertices"), _indices(faces)


def set_parameters(task: Task, table: Dict[str, Parameter], given: Dict[str, Any], positions: np.ndarray) -> None:
    """Sets the parameters that are given, for points at `positions`. Raises ValueError."""
    for name, value in given.items():
        task.set(name, _number(table[name], value, positions) if name in table else math.nan)


def _number(parameter: Parameter, value: Any, positions: np.ndarray) -> float:
    """The value as the library takes it. Raises ValueError."""
    wrong = f"The parameter {parameter.name} ({parameter.label}) is {value!r}: give "
    if isinstance(value, str) and parameter.kind == "choice":
        if value in parameter.choices:
            return parameter.choices.index(value)
        raise ValueError(wrong + " or ".join(map(repr, parameter.choices)) + ".")
    if isinstance(value, str) and parameter.kind == "length":
        return _percentage(wrong, value) * _diagonal(positions) / 100
    if isinstance(value, str) or (isinstance(value, (bool, np.bool_)) and parameter.kind != "boolean"):
        raise ValueError(wrong + ("True or False." if parameter.kind == "boolean" else "a number."))
    try:
        return float(value)
    except (TypeError, ValueError):
        raise ValueError(wrong + "a number.") from None


def _percentage(wrong: str, text: str) -> float:
    try:
        if text.endswith("%") and 0 <= float(text[:-1]) <= 100:
            return float(text[:-1])
    except ValueError:
        pass
    raise ValueError(f"{wrong}a length, or a percentage of the diagonal from 0 to 100 such as '5%'.")


def _diagonal(positions: np.ndarray) -> float:
    if not len(positions):
        return 0.0
    return math.sqrt(sum((float(high) - float(low))**2 for low, high in zip(positions.min(axis=0), positions.max(axis=0))))


def _run(task: Task, progress: Union[None, bool, Progress]) -> Result:
    if progress is not True:
        return task.run(progress or None)
    from tqdm.auto import tqdm
    with tqdm(total=100, bar_format="{l_bar}{bar}| {elapsed}<{remaining}{postfix}") as bar:
        def show(part: float, activity: str) -> None:
            bar.set_postfix_str(activity, refresh=False)
            bar.update(round(100 * part, 1) - bar.n)
        result = task.run(show)
        bar.update(100 - bar.n)
        return result
