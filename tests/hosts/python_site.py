# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""A folder to be searched for modules, with the Python package, its plugin and its library, as the wheel installs them,
without making all packages."""

import shutil
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[2] / "filter_neuralmesh/python/neural_mesh"
LIBRARY = "c_api/libneural_mesh.so"  # in the build folder


def make(folder, plugin):
    """Returns the folder. `plugin`: the file in a build folder, which has the library, too."""
    folder = Path(folder)
    shutil.copytree(PACKAGE, folder / "neural_mesh", ignore=shutil.ignore_patterns("__pycache__"), dirs_exist_ok=True)
    for file in (Path(plugin), Path(plugin).resolve().parents[2] / LIBRARY):
        shutil.copy(file, folder / "neural_mesh")
    (folder / "neural_mesh-0.dist-info").mkdir(exist_ok=True)
    (folder / "neural_mesh-0.dist-info/METADATA").write_text("Metadata-Version: 2.1\nName: neural-mesh\nVersion: 0\n")
    return folder
