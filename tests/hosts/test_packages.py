# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The packages of `./run.sh package`: what they contain, the symbol versions they need, the same bytes whenever they are
made, and the wheel in use. installs.py installs them in bare systems."""

import hashlib
import io
import os
import re
import sys
import tarfile
import zipfile
from pathlib import Path

import meshlabserver
from check_mesh import check_mesh
import pytest
from conftest import FULL, make_packages, the_file
from programs import output_of, python, run

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "packaging"))

import package as packaging  # noqa: E402

MODULE = ROOT / "filter_neuralmesh/python/neural_mesh"
PLUGIN = "libfilter_neuralmesh.so"
NAME = "meshlab-plugin-neuralmesh"


def test_all_packages_are_made_and_named_by_one_version(dist):
    version = packaging.project_version()
    assert sorted(path.name for path in dist.iterdir()) == sorted([
        "SHA256SUMS", f"{NAME}_{version}-1~deb12u1_amd64.deb", f"{NAME}_{version}-1~deb13u1_amd64.deb",
        f"neural-mesh-{version}-meshlab-2022.02-float-linux-x86_64.tar.gz",
        f"neural-mesh-{version}-meshlab-2025.07-float-linux-x86_64.tar.gz",
        the_file(dist, f"neural_mesh-{version}-py3-none-manylinux_*_x86_64.whl").name])


def test_checksums_are_of_the_files(dist):
    lines = (dist / "SHA256SUMS").read_text().splitlines()
    assert len(lines) == 5
    for line in lines:
        digest, name = line.split("  ")
        assert digest == hashlib.sha256((dist / name).read_bytes()).hexdigest()


@FULL
def test_the_same_plugins_give_the_same_packages(build, dist, tmp_path):
    for date, same in (("1700000000", True), ("1700000002", False)):
        make_packages(build, tmp_path / date, SOURCE_DATE_EPOCH=date, TZ="Asia/Tokyo", LC_ALL="C")
        assert ((tmp_path / date / "SHA256SUMS").read_text() == (dist / "SHA256SUMS").read_text()) is same


def test_plugins_need_nothing_newer_than_their_host(build, tmp_path):
    for host, limits in packaging.HOST_VERSIONS.items():
        needed = packaging.needed_versions(packaging.stripped(build / "plugins" / host / PLUGIN, host, tmp_path))
        assert set(needed) == {"GLIBC", "GLIBCXX", "CXXABI"} and not packaging.too_new(host, needed), (host, limits)


def test_a_plugin_that_skips_stages_is_refused(tmp_path):
    plugin = meshlabserver.plugin_path(tmp_path, "meshlab-2022.02")
    plugin.parent.mkdir(parents=True)
    plugin.write_bytes(b"NEURALMESH_SKIP")
    with pytest.raises(packaging.PackagingError, match="is for development"):
        packaging.stripped(plugin, "meshlab-2022.02", tmp_path / "out")


def test_a_newer_version_than_the_hosts_is_found():
    assert packaging.too_new("meshlab-2022.02", {"GLIBC": "2.31", "GLIBCXX": "3.4.28"}) == []
    assert packaging.too_new("meshlab-2022.02", {"GLIBC": "2.4", "GLIBCXX": "3.4.29"}) == ["GLIBCXX_3.4.29"]
    # The interpreter is a large program of GCC, or at least of the C library.
    assert packaging.number(packaging.needed_versions(os.path.realpath("/usr/bin/python3"))["GLIBC"]) > (2, 3)


def test_what_the_archives_contain(build, dist):
    for release in ("2022.02", "2025.07"):
        path = the_file(dist, f"*meshlab-{release}*.tar.gz")
        folder = path.name.removesuffix(".tar.gz")
        with tarfile.open(path) as archive:
            assert archive.getnames() == [f"{folder}/LICENSE", f"{folder}/README.txt", f"{folder}/{PLUGIN}"]
            readme = archive.extractfile(f"{folder}/README.txt").read().decode()
            plugin = archive.extractfile(f"{folder}/{PLUGIN}").read()
        assert len(readme.splitlines()) == 3 and release in readme and "Load Plugins" in readme
        assert same_code(plugin, meshlabserver.plugin_path(build, f"meshlab-{release}").read_bytes())


def same_code(stripped, built):
    """Whether the two have the same build id, which is a checksum of all that is loaded."""
    build_id = re.compile(rb"\x04\x00\x00\x00\x14\x00\x00\x00\x03\x00\x00\x00GNU\x00(.{20})", re.DOTALL)
    return build_id.search(stripped)[1] == build_id.search(built)[1]


def test_what_the_debian_packages_contain(dist):
    common = {f"usr/lib/x86_64-linux-gnu/meshlab/plugins/{PLUGIN}",
              *(f"usr/share/doc/{NAME}/{file}" for file in ("changelog.Debian.gz", "changelog.gz", "copyright"))}
    scripts = {f"usr/share/doc/{NAME}/examples/{path.name}" for path in (ROOT / "filter_neuralmesh/scripts").iterdir()}
    for suffix, meshlab, files in (("deb12u1", "2020.09", common | scripts), ("deb13u1", "2022.02", common)):
        path = the_file(dist, f"*{suffix}_amd64.deb")
        content = output_of("dpkg-deb", "--fsys-tarfile", path, text=False)
        with tarfile.open(fileobj=io.BytesIO(content)) as archive:
            found = [entry for entry in archive if entry.isfile()]
        assert {entry.name.removeprefix("./") for entry in found} == files
        assert all((entry.uid, entry.gid, entry.mode) == (0, 0, 0o644) for entry in found)
        control = output_of("dpkg-deb", "--info", path, "control")
        assert f"meshlab (>= {meshlab})" in control and f"Version: {packaging.project_version()}-1~{suffix}" in control


def test_what_the_wheel_contains(dist):
    version = packaging.project_version()
    with zipfile.ZipFile(the_file(dist, "*.whl")) as archive:
        assert archive.testzip() is None
        info = f"neural_mesh-{version}.dist-info"
        assert set(archive.namelist()) == {
            *(f"neural_mesh/{path.name}" for path in MODULE.iterdir() if path.is_file()), f"neural_mesh/{PLUGIN}",
            f"neural_mesh/{packaging.LIBRARY}",
            *(f"{info}/{file}" for file in ("METADATA", "WHEEL", "RECORD", "entry_points.txt", "licenses/LICENSE"))}
        assert {"neural_mesh/__init__.py", "neural_mesh/__main__.py", "neural_mesh/py.typed"} <= set(archive.namelist())
        metadata = archive.read(f"{info}/METADATA").decode()
    assert {line.split()[1] for line in metadata.splitlines() if line.startswith("Provides-Extra: ")} == {
        "pymeshlab", "dask", "las", "e57"}
    assert f"Version: {version}" in metadata and 'Requires-Dist: pymeshlab ==2025.7.*; extra == "pymeshlab"' in metadata


USE = """
import neural_mesh, pymeshlab, sys
method = pymeshlab.MeshSet.generate_surface_reconstruction_neural_mesh
assert "exactly `target_vertices` vertices" in method.__doc__
assert method.__name__ == "generate_surface_reconstruction_neural_mesh"
ms = pymeshlab.MeshSet()
ms.load_new_mesh(sys.argv[1])
result = ms.generate_surface_reconstruction_neural_mesh(target_vertices=300)
assert result["vertices"] == ms.current_mesh().vertex_number() == 300
ms.save_current_mesh(sys.argv[2], save_vertex_quality=True)
assert "scalar" in pymeshlab.MeshSet.compute_scalar_by_neural_normal_counter_per_vertex.__doc__
assert ms.compute_scalar_by_neural_normal_counter_per_vertex(signal_layer=0)["vertices"] == 300
"""
PLAIN = """
import pymeshlab, sys
pymeshlab.load_plugin(sys.argv[3])
ms = pymeshlab.MeshSet()
ms.load_new_mesh(sys.argv[1])
ms.apply_filter("generate_surface_reconstruction_neural_mesh", target_vertices=300)
ms.save_current_mesh(sys.argv[2], save_vertex_quality=True)
"""


def test_importing_the_wheel_adds_a_method_that_gives_the_same_bytes(build, installed, model, tmp_path):
    cloud, _ = model("sphere")
    done = python(installed, "-c", USE, cloud, tmp_path / "mesh.ply")
    assert done.returncode == 0, done.stderr
    plugin = meshlabserver.plugin_path(build, "pymeshlab-2025.7")
    done = python(installed, "-c", PLAIN, cloud, tmp_path / "plain.ply", plugin)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "mesh.ply").read_bytes() == (tmp_path / "plain.ply").read_bytes()


def test_the_command_makes_a_mesh(build, installed, model, tmp_path):
    done = python(installed, installed / "bin/neural-mesh", model("sphere")[0], tmp_path / "mesh.ply",
                  "target_vertices=200", "select_features=true")
    assert done.returncode == 0 and "vertices=200 " in done.stdout, done.stderr
    found = check_mesh(tmp_path / "mesh.ply")
    assert found["vertices"] == 200 and found["watertight"] and found["oriented"]


@pytest.mark.parametrize("words, status, sentence", [
    (["nowhere.ply", "mesh.ply"], 1, "nowhere.ply"),
    (["{cloud}"], 2, "required: mesh"),
    (["{cloud}", "mesh.ply", "5000"], 2, "neural-mesh: '5000' is not of the form name=value"),
    (["{cloud}", "mesh.ply", "target_vertices=many"], 2, "(Target vertices) is 'many': give a number."),
    (["{cloud}", "mesh.ply", "target_vertices=99999999999"], 2, "is 99999999999: give a whole number from 4 to"),
    (["{cloud}", "mesh.ply", "target_vertices=5", "target_vertices=6"], 2, "target_vertices is given twice."),
    (["{cloud}", "mesh.ply", "close_holes_up_to=wide"], 2, "(Close holes up to) is 'wide': give a length, or a percentage"),
    (["{cloud}", "mesh.ply", "close_holes_up_to=500%"], 2, "from 0 to 100 such as '5%'."),
])
def test_the_command_says_what_is_wrong(installed, model, words, status, sentence):
    words = [word.format(cloud=model("sphere")[0]) for word in words]
    done = python(installed, "-m", "neural_mesh", *words)
    assert done.returncode == status and sentence in done.stderr and "Traceback" not in done.stderr, done.stderr


@pytest.mark.parametrize("words", [["close_holes_up_to=5%"], ["close_holes_up_to=0.5", "surface=Open"]])
def test_the_command_takes_lengths_percentages_and_names(installed, model, tmp_path, words):
    done = python(installed, "-m", "neural_mesh", model("sphere")[0], tmp_path / "mesh.obj", "target_vertices=200",
                  *words)
    assert done.returncode == 0 and "vertices=200 " in done.stdout, done.stderr


@pytest.mark.parametrize("other, words", [("2023.12", "pymeshlab 2023.12 is installed"),
                                          (None, "no pymeshlab is installed")])
def test_beside_another_pymeshlab_or_none_there_is_no_filter_but_the_library(installed, model, tmp_path, other, words):
    """A stand-in for an installed pymeshlab: the folder that names its release."""
    if other:
        (tmp_path / f"pymeshlab-{other}.dist-info").mkdir()
        (tmp_path / f"pymeshlab-{other}.dist-info/METADATA").write_text(f"Name: pymeshlab\nVersion: {other}\n")

    def done_by(*command):
        return run("/usr/bin/python3", *command, env=dict(os.environ, PYTHONPATH=f"{tmp_path}:{installed}"))

    imported = done_by("-c", "import neural_mesh, numpy\n"
                       "points = numpy.random.default_rng(1).normal(size=(500, 3))\n"
                       "points /= numpy.linalg.norm(points, axis=1)[:, None]\n"
                       "print(len(neural_mesh.reconstruct(points, target_vertices=20).vertices))")
    assert imported.returncode == 0 and imported.stdout == "20\n", imported.stderr
    # Who has a pymeshlab may look for the filters in it.
    warning = f"NeuralMeshWarning: The filters of neural-mesh {packaging.project_version()} are built for pymeshlab 2025.7"
    assert (warning in imported.stderr) == bool(other)
    # As a command: a sentence, where pymeshlab is needed.
    (tmp_path / "a.stl").write_text("solid")
    done = done_by("-m", "neural_mesh", tmp_path / "a.stl", "b.ply")
    assert done.returncode == 1 and len(done.stderr.splitlines()) == 1, done.stderr
    assert "no ending that is read without pymeshlab" in done.stderr and words in done.stderr
    if not other:
        done = done_by("-m", "neural_mesh", model("sphere")[0], tmp_path / "mesh.ply", "target_vertices=20")
        assert done.returncode == 0 and "vertices=20 " in done.stdout and not done.stderr, done.stderr
