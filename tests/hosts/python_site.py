# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""A folder to be searched for modules, with the Python package and its plugin, as the wheel installs them, without making
all packages."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[2] / "filter_neuralmesh/python/neural_mesh"


def make(folder, plugin):
    """Returns the folder."""
    folder = Path(folder)
    shutil.copytree(PACKAGE, folder / "neural_mesh", ignore=shutil.ignore_patterns("__pycache__"), dirs_exist_ok=True)
    shutil.copy(plugin, folder / "neural_mesh")
    (folder / "neural_mesh-0.dist-info").mkdir(exist_ok=True)
    (folder / "neural_mesh-0.dist-info/METADATA").write_text("Metadata-Version: 2.1\nName: neural-mesh\nVersion: 0\n")
    return folder


def run(site, *words, **options):
    """Runs Python with the modules of `site`."""
    return subprocess.run([sys.executable, *map(str, words)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          check=False, env=dict(os.environ, PYTHONPATH=str(site)), **options)
