# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Parameters of the filter as words `name=value` of a command, and sizes of memory and files: read, and checked before any
work."""

import re
import shutil
from pathlib import Path
from typing import Any, Dict, Iterable, List, Tuple, Union

import numpy as np

from neural_mesh.library import RECONSTRUCTION, Task
from neural_mesh.reconstruction import parameter_list, set_parameters

Value = Union[bool, int, float, str]
Settings = Dict[str, Value]  # as in JSON; a percentage is a text such as "5%"

SETTING = re.compile(r"[A-Za-z_]\w*=")
UNITS = {"K": 1, "M": 2, "G": 3, "T": 4}


class WrongUsage(Exception):
    """A sentence about the command that was given. Nothing has been done."""


def value_of(text: str) -> Value:
    """A parameter's value: true or false, an integer, a number, else the text."""
    if text.lower() in ("true", "false"):
        return text.lower() == "true"
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            pass
    return text


def settings_of(words: Iterable[str]) -> Settings:
    """The settings in words `name=value`. Throws WrongUsage for other words."""
    settings: Settings = {}
    for word in words:
        name, equals, value = word.partition("=")
        if not equals:
            raise WrongUsage(f"'{word}' is not of the form name=value, such as target_vertices=5000.")
        if name in settings:
            raise WrongUsage(f"The parameter {name} is given twice.")
        settings[name] = value_of(value)
    return settings


def files_and_settings(words: Iterable[str]) -> Tuple[List[str], Settings]:
    """Separates files from words `name=value`. A file with such a name may be given as ./name=value."""
    words = list(words)
    return [word for word in words if not SETTING.match(word)], settings_of(filter(SETTING.match, words))


def line_of(result: Dict[str, Any]) -> str:
    """The results of a run as words name=value: counts in full, other numbers with six digits."""
    return " ".join(f"{name}={value if isinstance(value, int) else f'{value:.6g}'}"
                    for name, value in sorted(result.items()))


def check(settings: Settings) -> Dict[str, Any]:
    """Throws WrongUsage if there is no such parameter or it does not accept a value. Returns the values of all
    parameters."""
    table = parameter_list()
    with Task(RECONSTRUCTION) as task:
        try:
            set_parameters(task, table, settings, np.zeros((1, 3)))
        except ValueError as error:
            raise WrongUsage(str(error)) from None
    if settings.get("crease_lines") is True:
        raise WrongUsage("With crease_lines the filter makes a second layer, and this command writes the mesh only: "
                         "leave crease_lines out.")
    return {**{name: parameter.default for name, parameter in table.items()}, **settings}


def memory_size(text: str) -> int:
    """Bytes of a size as GNU's programs take it: 4G and 4GiB are 4 * 1024**3, 4GB is 4 * 1000**3. Throws ValueError."""
    found = re.fullmatch(r"(\d+(?:\.\d+)?)(?:([KMGT])(I?B)?)?", text.strip().upper())
    number = float(found[1]) * (1000 if found[3] == "B" else 1024) ** UNITS.get(found[2], 0) if found else 0
    if number < 1:
        raise ValueError(text)
    return int(number)


def gigabytes(size: float) -> str:
    return f"{size / 1e9:.3g} GB"


def check_space(folder: Path, needed: float, what: str) -> None:
    """Throws WrongUsage if the disk of the folder has not so many bytes left. `what` needs them, as in "The meshes"."""
    free = shutil.disk_usage(folder).free
    if free < needed:
        raise WrongUsage(f"{what} need {gigabytes(needed)}, and {gigabytes(free)} are free in {folder}.")
