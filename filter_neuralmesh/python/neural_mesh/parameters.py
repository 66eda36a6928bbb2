# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Parameters of the filter as words `name=value` of a command: read, checked before any work, given to pymeshlab."""

import re
from typing import Any, Dict, Iterable, List, Tuple, Union

import numpy
import pymeshlab

from neural_mesh import FILTER

Value = Union[bool, int, float, str]
Settings = Dict[str, Value]  # as in JSON; a percentage is a text such as "5%"

SETTING = re.compile(r"[A-Za-z_]\w*=")
LENGTHS = ("target_error", "close_holes_up_to")  # world units, or with a % of the diagonal


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


def for_pymeshlab(settings: Settings) -> Dict[str, Any]:
    """The keyword arguments of the filter. Throws WrongUsage if a length or percentage is none."""
    arguments: Dict[str, Any] = dict(settings)
    for name in LENGTHS:
        if name in settings:
            text = str(settings[name])
            try:
                kind = pymeshlab.PercentageValue if text.endswith("%") else pymeshlab.PureValue
                arguments[name] = kind(float(text.rstrip("%")))
            except (ValueError, pymeshlab.InvalidPercentageException):
                raise WrongUsage(f"The parameter {name} is '{text}': give a length, such as {name}=0.5, or a "
                                 f"percentage of the diagonal from 0 to 100, such as {name}=5%.") from None
    return arguments


def sentence_of(error: Exception) -> str:
    """What is wrong, without pymeshlab's line about the filter that failed."""
    return str(error).rpartition("\nDetails: ")[2].strip() or type(error).__name__


def line_of(result: Dict[str, Any]) -> str:
    """The results of the filter as words name=value: counts in full, other numbers with six digits."""
    return " ".join(f"{name}={value if isinstance(value, int) else f'{value:.6g}'}" for name, value in result.items())


def check(settings: Settings, meshes: pymeshlab.MeshSet) -> Dict[str, Any]:
    """Throws WrongUsage if the filter has no such parameter or does not accept a value. Returns the values of all
    parameters. Needs an empty MeshSet, and leaves it empty."""
    def refusal(arguments: Dict[str, Any]) -> str:
        try:
            meshes.apply_filter(FILTER, **arguments)
        except pymeshlab.PyMeshLabException as error:
            return sentence_of(error)
        return ""

    # The filter looks at the parameters first. A layer of one point is refused after that.
    meshes.add_mesh(pymeshlab.Mesh(numpy.zeros((1, 3))))
    try:
        accepted = refusal({})
        defaults = meshes.filter_parameter_values(FILTER)
        _check_names_and_types(settings, defaults)
        sentence = accepted
        for name, argument in for_pymeshlab(settings).items():
            try:
                sentence = refusal({name: argument})
            except pymeshlab.InvalidEnumException as error:
                sentence = f"{str(error).strip(' ;')}."
            except (RuntimeError, TypeError):  # of pybind11: it cannot convert the value
                sentence = "give a whole number of at most nine digits."
            if sentence != accepted:
                raise WrongUsage(sentence if name in sentence else f"The parameter {name} is '{argument}': {sentence}")
        sentence = refusal(for_pymeshlab(settings))
        if sentence != accepted:
            raise WrongUsage(sentence)
        if settings.get("crease_lines") is True:
            raise WrongUsage("With crease_lines the filter makes a second layer, and this command writes the mesh only: "
                             "leave crease_lines out.")
        return {**defaults, **settings}
    finally:
        meshes.clear()


def _check_names_and_types(settings: Settings, defaults: Dict[str, Any]) -> None:
    for name, value in settings.items():
        if name not in defaults:
            raise WrongUsage(f"There is no parameter {name}. The parameters are {', '.join(defaults)}.")
        default = defaults[name]
        wanted = ""
        if isinstance(default, bool):
            wanted = "" if isinstance(value, bool) else "true or false"
        elif isinstance(default, float) and name not in LENGTHS:
            wanted = "a number" if isinstance(value, (bool, str)) else ""
        elif isinstance(default, int):  # or the name of a choice
            wanted = "a whole number" if isinstance(value, (bool, float)) else ""
        if wanted:
            raise WrongUsage(f"The parameter {name} is '{value}': give {wanted}.")
