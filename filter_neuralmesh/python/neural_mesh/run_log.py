# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""What a run of a filter tells besides its results: log(), and its warnings as Python warnings."""

import ctypes
import functools
import os
import sys
import warnings
from pathlib import Path
from typing import Any, Callable, Dict, Iterable, List, NamedTuple, Optional

_messages: Optional[Callable[[], bytes]] = None  # of the plugin; None: it has no such function


class NeuralMeshWarning(UserWarning):
    """A sentence of the log that is a reason to look at the result.

    warnings.simplefilter("ignore", neural_mesh.NeuralMeshWarning) silences them; "error" raises them, after the run."""


class Message(NamedTuple):
    """A sentence of the log."""

    kind: str  # "warning", "note", or "error": that of the exception
    text: str


class Log(List[Message]):
    """The messages of a run in their order. print() shows one a line."""

    @property
    def warnings(self) -> List[str]:
        return [text for kind, text in self if kind == "warning"]

    @property
    def notes(self) -> List[str]:
        return [text for kind, text in self if kind == "note"]

    def __str__(self) -> str:
        return "\n".join(f"{kind}: {text}" for kind, text in self)


def log() -> Log:
    """What the last run of a filter of Neural Mesh in this thread told, whatever MeshSet it was and whether that is
    verbose. Empty before the first run.

    log().warnings and log().notes are lists of sentences. After a run that raised, the log holds its sentence."""
    if _messages is None:
        raise RuntimeError("The plugin of Neural Mesh that was loaded before 'import neural_mesh' keeps no messages: "
                           "leave its load_plugin() out.")
    lines = _messages().decode("utf-8", "replace").splitlines()
    return Log(Message(*line.split("\t", 1)) for line in lines)


def loaded_file(name: str) -> Optional[Path]:
    """The library of that name which this process has loaded from wherever."""
    for line in Path("/proc/self/maps").read_text().splitlines():
        path = Path(line[line.find("/"):]) if "/" in line else Path()
        if path.name == name:
            return path
    return None


def read_messages_of(plugin: Optional[Path]) -> None:
    """`plugin`: the file that is loaded, if it is known."""
    global _messages
    function = None
    if plugin is not None:
        library = ctypes.CDLL(str(plugin), mode=os.RTLD_NOW | os.RTLD_NOLOAD)
        function = getattr(library, "neural_mesh_messages", None)
        if function is not None:
            function.restype = ctypes.c_char_p
    _messages = function


def _warn() -> None:
    """Gives the warnings of the run the place of the call, outside of pymeshlab. A registry of its own lets each run
    warn, also one of many in a loop."""
    frame = sys._getframe(2)
    while frame.f_globals.get("__name__", "").split(".")[0] == "pymeshlab" and frame.f_back:
        frame = frame.f_back
    registry: Dict[Any, Any] = {}
    for text in log().warnings:
        warnings.warn_explicit(text, NeuralMeshWarning, frame.f_code.co_filename, frame.f_lineno,
                               frame.f_globals.get("__name__"), registry)


def warn_after(names: Iterable[str], mesh_set: Any) -> None:
    """Lets apply_filter() of the class `mesh_set`, which the methods of the filters call, give the warnings of the
    filters `names`. Other filters run as before. `mesh_set.apply_filter.__wrapped__` is what it was."""
    if hasattr(mesh_set.apply_filter, "gives_neural_mesh_warnings"):
        return
    ours, wrapped = frozenset(names), mesh_set.apply_filter

    @functools.wraps(wrapped)
    def apply_filter(*arguments: Any, **parameters: Any) -> Any:
        result = wrapped(*arguments, **parameters)
        name = parameters.get("filter_name", arguments[1] if len(arguments) > 1 else None)
        if name in ours and _messages is not None:
            _warn()
        return result

    apply_filter.gives_neural_mesh_warnings = True  # type: ignore[attr-defined]
    mesh_set.apply_filter = apply_filter
