# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Sizes of memory and files, as options of the command and in its sentences."""

import re
import shutil
from pathlib import Path

from neural_mesh.parameters import WrongUsage

UNITS = {"K": 1, "M": 2, "G": 3, "T": 4}


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
