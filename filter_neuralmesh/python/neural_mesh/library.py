# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The core as a shared library, by ctypes: numpy arrays in and out without copies, parameters by name, errors as
exceptions with the library's sentence. Its manual is vcg_core/c_api/neural_mesh.h."""

from __future__ import annotations

import ctypes
import functools
import math
import signal
import sys
import threading
from ctypes import POINTER, c_char_p, c_double, c_float, c_int, c_size_t, c_ssize_t, c_ubyte, c_void_p
from pathlib import Path
from typing import Any, Callable, Dict, List, NamedTuple, Optional, Tuple, Union

import numpy as np

ABI = 1  # NEURAL_MESH_ABI of the header that the structures below are those of
RECONSTRUCTION, COUNTERS = 0, 1
OK, NO_MEMORY, UNEXPECTED = 0, 3, 5  # other statuses are ValueErrors
CANCELLED = 2  # the figure stop_reason
NAMES = {"win32": "neural_mesh.dll", "darwin": "libneural_mesh.dylib"}
FILE = Path(__file__).with_name(NAMES.get(sys.platform, "libneural_mesh.so"))

# Types of arrays that the library reads where they are, whatever their strides.
TYPES = {np.dtype(np.float32): 0, np.dtype(np.float64): 1, np.dtype(np.uint8): 2, np.dtype(np.int32): 3,
         np.dtype(np.int64): 4}
KINDS = ("boolean", "integer", "real", "length", "choice")

Progress = Callable[[float, str], Any]
_CallBack = ctypes.CFUNCTYPE(c_int, c_void_p, c_double, c_char_p)


class _Array(ctypes.Structure):
    _fields_ = [("data", c_void_p), ("rows", c_size_t), ("type", c_int), ("row_step", c_ssize_t),
                ("value_step", c_ssize_t)]


def _described(array: np.ndarray) -> _Array:
    return _Array(array.ctypes.data, len(array), TYPES[array.dtype], *array.strides)


class _Parameter(ctypes.Structure):
    _fields_ = [("name", c_char_p), ("label", c_char_p), ("help", c_char_p), ("kind", c_int), ("low", c_double),
                ("high", c_double), ("value", c_double), ("choices", c_size_t), ("choice", POINTER(c_char_p))]


class _Figure(ctypes.Structure):
    _fields_ = [("name", c_char_p), ("value", c_double), ("is_count", c_int)]


class _Message(ctypes.Structure):
    _fields_ = [("kind", c_int), ("text", c_char_p)]


class _Result(ctypes.Structure):
    _fields_ = [("vertex_count", c_size_t), ("face_count", c_size_t), ("positions", POINTER(c_double)),
                ("faces", POINTER(c_int)), ("quality", POINTER(c_float)), ("features", POINTER(c_ubyte)),
                ("colors", POINTER(c_ubyte)), ("crease_vertex_count", c_size_t), ("crease_edge_count", c_size_t),
                ("crease_positions", POINTER(c_double)), ("crease_edges", POINTER(c_int)),
                ("crease_quality", POINTER(c_float)), ("figure_count", c_size_t), ("figures", POINTER(_Figure)),
                ("message_count", c_size_t), ("messages", POINTER(_Message))]


class Parameter(NamedTuple):
    """A parameter of the library: `kind` is one of KINDS, `low` to `high` its range, `choices` the names of its values."""

    name: str
    label: str
    help: str
    kind: str
    low: Union[bool, int, float]
    high: Union[bool, int, float]
    default: Union[bool, int, float]
    choices: Tuple[str, ...]


class _Memory:
    """Owns a result of the library."""

    def __init__(self, address: int) -> None:
        self.address = address
        self._free = library().neural_mesh_free_result

    def __del__(self) -> None:
        self._free(self.address)


class Result:
    """What a run has made: arrays that are views of the library's memory, which lives as long as any of them."""

    def __init__(self, address: int) -> None:
        self._memory = _Memory(address)
        content = _Result.from_address(address)
        vertices, faces = content.vertex_count, content.face_count
        self.vertices = self._view(content.positions, np.float64, (vertices, 3))
        self.faces = self._view(content.faces, np.int32, (faces, 3))
        self.quality = self._view(content.quality, np.float32, (vertices,))
        self.features = self._view(content.features, np.bool_, (vertices,))
        self.colors = self._view(content.colors, np.uint8, (vertices, 3))
        ends, edges = content.crease_vertex_count, content.crease_edge_count
        self.crease_vertices = self._view(content.crease_positions, np.float64, (ends, 3))
        self.crease_edges = self._view(content.crease_edges, np.int32, (edges, 2))
        self.crease_quality = self._view(content.crease_quality, np.float32, (ends,))
        self.figures: Dict[str, Any] = {
            figure.name.decode(): int(figure.value) if figure.is_count else figure.value
            for figure in content.figures[:content.figure_count]}
        messages = [(message.kind, message.text.decode()) for message in content.messages[:content.message_count]]
        self.notes: List[str] = [text for kind, text in messages if not kind]
        self.warnings: List[str] = [text for kind, text in messages if kind]

    def _view(self, pointer: Any, dtype: Any, shape: Tuple[int, ...]) -> Optional[np.ndarray]:
        """None for a null pointer."""
        if not pointer:
            return None
        count = math.prod(shape)
        bytes_of_array = (c_ubyte * (count * np.dtype(dtype).itemsize)).from_address(ctypes.addressof(pointer.contents))
        bytes_of_array.owner = self._memory  # the array refers to the bytes, and so to their owner
        return np.frombuffer(bytes_of_array, dtype).reshape(shape)


@functools.lru_cache(None)
def library() -> ctypes.CDLL:
    """Loads the library once. Raises ImportError with a sentence."""
    try:
        loaded = ctypes.CDLL(str(FILE))
    except OSError as error:
        raise ImportError(f"The library of neural-mesh cannot be loaded ({error}): install the wheel for this system, "
                          "by 'pip install --force-reinstall neural_mesh-*.whl'.") from None
    found = loaded.neural_mesh_abi()
    if found != ABI:
        raise ImportError(f"The library {FILE.name} has the interface {found}, and this neural-mesh needs {ABI}: install "
                          "it again, by 'pip install --force-reinstall neural_mesh-*.whl'.")
    for name, result, arguments in (
            ("version", c_char_p, ()), ("parameters", POINTER(_Parameter), (c_int, POINTER(c_size_t))),
            ("new", c_void_p, (c_int,)), ("free", None, (c_void_p,)), ("error", c_char_p, (c_void_p,)),
            ("set", c_int, (c_void_p, c_char_p, c_double)), ("set_points", c_int, (c_void_p, POINTER(_Array))),
            ("set_colors", c_int, (c_void_p, POINTER(_Array))), ("set_normals", c_int, (c_void_p, POINTER(_Array))),
            ("set_faces", c_int, (c_void_p, POINTER(_Array))),
            ("set_mesh", c_int, (c_void_p, POINTER(_Array), POINTER(_Array))),
            ("run", c_int, (c_void_p, _CallBack, c_void_p, POINTER(c_void_p))), ("free_result", None, (c_void_p,)),
            ("distances", c_int, (c_void_p, POINTER(_Array), c_void_p))):
        function = getattr(loaded, f"neural_mesh_{name}")
        function.restype, function.argtypes = result, arguments
    return loaded


@functools.lru_cache(None)
def parameters(kind: int) -> Dict[str, Parameter]:
    """The parameters of RECONSTRUCTION or COUNTERS by name, in the order of the filter's dialog."""
    count = c_size_t()
    rows = library().neural_mesh_parameters(kind, ctypes.byref(count))
    if not rows:
        raise MemoryError
    table = {}
    for row in rows[:count.value]:
        name, values = row.name.decode(), KINDS[row.kind]
        number = {"boolean": bool, "integer": int, "choice": int}.get(values, float)
        table[name] = Parameter(name, row.label.decode(), row.help.decode(), values, number(row.low), number(row.high),
                                number(row.value), tuple(choice.decode() for choice in row.choice[:row.choices]))
    return table


class _DelayedInterrupt:
    """Ctrl-C ends a `with` block of the main thread when it is left, not before: ctypes would lose an exception that is
    raised on the way into a function that C calls. Signals with Python's own handler for it only; others stay."""

    def __init__(self) -> None:
        self.came = False
        self._delayed: List[int] = []

    def __enter__(self) -> "_DelayedInterrupt":
        def remember(*_: Any) -> None:
            self.came = True

        if threading.current_thread() is threading.main_thread():
            self._delayed = [number for number in (signal.SIGINT, signal.SIGTERM)
                             if signal.getsignal(number) is signal.default_int_handler]
        for number in self._delayed:
            signal.signal(number, remember)
        return self

    def __exit__(self, *_: Any) -> None:
        for number in self._delayed:
            signal.signal(number, signal.default_int_handler)
        if self.came:
            raise KeyboardInterrupt


class Task:
    """What to learn. Keeps the arrays that the library reads. For one thread at a time; a context manager."""

    def __init__(self, kind: int) -> None:
        self._handle = library().neural_mesh_new(kind)
        if not self._handle:
            raise MemoryError
        self._arrays: List[np.ndarray] = []

    def __enter__(self) -> "Task":
        return self

    def __exit__(self, *_: Any) -> None:
        library().neural_mesh_free(self._handle)

    def set(self, name: str, value: float) -> None:
        """Raises ValueError with the filter's sentence."""
        self._call("set", name.encode(), value)

    def set_arrays(self, what: str, *arrays: np.ndarray) -> None:
        """Gives "points", "colors", "normals", "faces", or "mesh": positions and faces. Raises ValueError."""
        self._arrays += arrays
        self._call(f"set_{what}", *(ctypes.byref(_described(array)) for array in arrays))

    def run(self, progress: Optional[Progress]) -> Result:
        """`progress` gets the part that is done and what is being done; if it returns False, the run ends early.
        What it raises ends the run, too, and is raised again, as is KeyboardInterrupt."""
        raised: List[BaseException] = []
        stopped = []
        with _DelayedInterrupt() as interrupt:
            def call_back(_: Any, fraction: float, activity: bytes) -> int:
                try:  # without `progress`, too: Python sees signals where it runs
                    if interrupt.came or (progress is not None and progress(fraction, activity.decode()) is False):
                        stopped.append(True)
                    return int(not stopped)
                except BaseException as error:
                    raised.append(error)
                    return 0

            address = c_void_p()
            try:
                self._call("run", _CallBack(call_back), None, ctypes.byref(address))
                result = Result(address.value or 0)
            except Exception:
                if not raised and not interrupt.came:
                    raise
        if raised:
            raise raised[0]
        if result.figures["stop_reason"] == CANCELLED and not stopped:
            raise KeyboardInterrupt  # the handler of another signal has raised on the way into call_back()
        return result

    def distances(self, points: np.ndarray) -> np.ndarray:
        """Of each point from the mesh that set_arrays() was given; NaN for those that are not finite. Raises ValueError."""
        found = np.empty(len(points))
        self._call("distances", ctypes.byref(_described(points)), found.ctypes.data)
        return found

    def _call(self, name: str, *arguments: Any) -> None:
        status = getattr(library(), f"neural_mesh_{name}")(self._handle, *arguments)
        if status == OK:
            return
        sentence = library().neural_mesh_error(self._handle).decode()
        if status == NO_MEMORY:
            raise MemoryError(sentence)
        raise RuntimeError(sentence) if status == UNEXPECTED else ValueError(sentence)
