# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Importing this module makes those in accuracy/ and pictures/ importable, wherever a script of this folder is run."""

import sys
from pathlib import Path

for folder in ("accuracy", "pictures"):
    sys.path.insert(0, str(Path(__file__).resolve().parents[1] / folder))
