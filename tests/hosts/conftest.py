# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Fixtures of the host tests: the build folder, hosts with our plugin, clouds, and the table of parameters."""

import os
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
for folder in (".", "bench", "hosts"):
    sys.path.insert(0, str(ROOT / "tests" / folder))
for folder in ("accuracy", "paper", "pictures"):
    sys.path.insert(0, str(ROOT / "tests" / "experiments" / folder))

# Set before any OpenMP is loaded: threads that wait in a busy loop make Poisson five times slower on a busy machine.
os.environ.setdefault("OMP_WAIT_POLICY", "passive")

import input_hosts  # noqa: E402
import meshlabserver  # noqa: E402
import models  # noqa: E402
import programs  # noqa: E402
import python_site  # noqa: E402

PYTHON_NAME = input_hosts.PYTHON_NAME
CLOUD_POINTS = 20_000


# What `./run.sh test full` runs besides; a whole file says `pytestmark = pytest.mark.full`.
FULL = pytest.mark.full
ALL_TIERS = "NEURALMESH_FULL" in os.environ


def pytest_configure(config):
    config.addinivalue_line("markers", "full: in the second tier of tests only, see tests/README.md")


def pytest_collection_modifyitems(config, items):
    if not ALL_TIERS:
        later = [item for item in items if item.get_closest_marker("full")]
        config.hook.pytest_deselected(items=later)
        items[:] = [item for item in items if item not in later]


def in_hosts(names, few):
    """(name, host) for parametrize: all in pymeshlab, a few in meshlabserver."""
    return [*((name, input_hosts.PYMESHLAB) for name in names), *((name, input_hosts.SERVER) for name in few)]


def write_points(path, points, faces=()):
    """Writes a PLY in single precision, so that float and double hosts read the same numbers."""
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points)}",
              *(f"property float {axis}" for axis in "xyz"), f"element face {len(faces)}",
              "property list uchar int vertex_indices", "end_header", ""]
    corners = np.empty(len(faces), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    if len(faces):
        corners["count"] = 3
        corners["corners"] = faces
    Path(path).write_bytes("\n".join(header).encode() + np.asarray(points, dtype="<f4").reshape(-1, 3).tobytes()
                           + corners.tobytes())
    return Path(path)


@pytest.fixture(scope="module")
def first_of():
    """What a file keeps of the first host, by input."""
    return {}


@pytest.fixture(scope="session")
def build():
    folder = Path(os.environ.get("NEURALMESH_BUILD") or ROOT / "build")
    assert (folder / "tests" / "parameter_table").exists(), f"{folder} is not built; './run.sh test' builds it."
    return folder


@pytest.fixture(scope="session")
def server(build, tmp_path_factory):
    """A folder with meshlabserver 2020.09 and our plugin."""
    return meshlabserver.make_folder(tmp_path_factory.mktemp("server") / "meshlab", meshlabserver.plugin_path(build))


@pytest.fixture(scope="session")
def pymeshlab(build):
    """The module pymeshlab with our plugin loaded."""
    import pymeshlab as module
    module.load_plugin(str(meshlabserver.plugin_path(build, "pymeshlab-2025.7")))
    return module


def make_packages(build, out, **environment):
    """`package.py`, as run.sh calls it, but without libraries for other systems. Returns what it printed."""
    return programs.output_of("/usr/bin/python3", ROOT / "packaging/package.py", "--plugins", build / "plugins",
                              "--libraries", out / "none", "--out", out, env=dict(os.environ, **environment))


def the_file(folder, pattern):
    found = list(folder.glob(pattern))
    assert len(found) == 1, f"{pattern}: {found}"
    return found[0]


@pytest.fixture(scope="session")
def dist(build, tmp_path_factory):
    """The folder of all packages."""
    folder = tmp_path_factory.mktemp("packages") / "dist"
    print(make_packages(build, folder, SOURCE_DATE_EPOCH="1700000000"))
    return folder


@pytest.fixture(scope="session")
def installed(dist, tmp_path_factory):
    """The folder into which pip has installed the wheel, to be searched beside this environment's pymeshlab."""
    folder = tmp_path_factory.mktemp("site")
    programs.output_of(sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-index", "--target", folder,
                       the_file(dist, "*.whl"))
    return folder


@pytest.fixture
def meshes(pymeshlab):
    """A new MeshSet."""
    return input_hosts.new_mesh_set(pymeshlab)


@pytest.fixture(scope="session")
def model(tmp_path_factory):
    """model(name) -> (cloud file, surface file) of a model, both in single precision."""
    folder = tmp_path_factory.mktemp("models")

    def files(name):
        cloud, surface = folder / f"{name}_cloud.ply", folder / f"{name}.ply"
        if not cloud.exists():
            vertices, faces = models.load_model(name)
            write_points(surface, vertices, faces)
            write_points(cloud, models.make_cloud(vertices, faces, CLOUD_POINTS))
        return cloud, surface

    return files


NAN = float("nan")
CORNERS = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]]


def parameters(build, filter_name=PYTHON_NAME):
    """A filter's table of parameters: a list of (id, type, low, high, default)."""
    return [(row["id"], row["type"], float(row["low"]), float(row["high"]), row["default"])
            for row in meshlabserver.parameters(build, filter_name)]


def out_of_range(build, filter_name=PYTHON_NAME):
    """(id, value) with a value below and one above the range of each number, and NaN for real ones."""
    cases = []
    for name, kind, low, high, _ in parameters(build, filter_name):
        if kind == "RichInt":
            cases.append((name, int(low) - 1))
            if high < 2**31 - 1:
                cases.append((name, int(high) + 1))
        elif kind == "RichFloat":
            cases += [(name, low - 1), (name, high * 2 + 1), (name, NAN)]
        elif kind == "RichAbsPerc":
            cases += [(name, high * 2), (name, NAN)]
    return cases


@pytest.fixture(scope="module")
def site(build, tmp_path_factory):
    """The Python package as installed: the folder for PYTHONPATH, in this process's path, too."""
    folder = python_site.make(tmp_path_factory.mktemp("site"), meshlabserver.plugin_path(build, "pymeshlab-2025.7"))
    sys.path.insert(0, str(folder))
    yield folder
    sys.path.remove(str(folder))


@pytest.fixture(scope="module")
def library(site, pymeshlab):
    """The module neural_mesh beside pymeshlab, whose warnings are not shown."""
    import neural_mesh
    warnings.simplefilter("ignore", neural_mesh.NeuralMeshWarning)
    return neural_mesh
