# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""`neural-mesh stream` as a command: memory, the distances of all points against pymeshlab with the whole cloud, and a
sentence for each bad input. test_stream_parts.py has its readers and its sample."""

import os
import re
import resource
import socket
import subprocess
import sys

import numpy as np
import programs
import pytest
from conftest import FULL, write_points
from stream_clouds import FILES, ORIGIN, POINTS, ascii_ply, bench, e57, las, ply


@pytest.fixture(scope="module")
def stream(site):
    """stream(word...) -> the finished process of the command."""
    return lambda *words, **options: programs.python(site, "-m", "neural_mesh", "stream", *words, **options)


def last_line(output):
    """The results as a dictionary of numbers."""
    return {key: float(value) for key, value in (word.split("=") for word in output.splitlines()[-1].split())}


def results(done):
    assert done.returncode == 0, done.stdout + done.stderr
    return last_line(done.stdout)


def error_of(done, status):
    assert done.returncode == status and "Traceback" not in done.stderr, done.stderr
    return done.stderr.splitlines()[-1]


@FULL
def test_memory_stays_within_the_option_and_distances_are_those_of_the_whole_cloud(pymeshlab, meshes, site, tmp_path):
    cloud, mesh = tmp_path / "cloud.ply", tmp_path / "mesh.ply"
    bench.write_cloud(cloud, 1_000_000)
    output, _, memory = bench.run_watched([sys.executable, "-m", "neural_mesh", "stream", str(cloud), str(mesh),
                                           "--memory", "300MB", "target_vertices=1500"],
                                          dict(os.environ, PYTHONPATH=str(site)))
    announced = re.match(r"This will take up to ([\d.]+) GB of the 0.3 GB allowed: a sample of about 150,000", output)
    assert memory / 1e9 <= float(announced[1]) <= .3
    found = last_line(output)
    meshes.load_new_mesh(str(mesh))
    meshes.load_new_mesh(str(cloud))
    expected = meshes.get_hausdorff_distance(sampledmesh=1, targetmesh=0, samplevert=True, samplenum=1_000_000,
                                             maxdist=pymeshlab.PureValue(10))
    assert found["points"] == expected["n_samples"] == 1_000_000 and found["vertices"] == 1500
    assert found["points_rms"] == pytest.approx(expected["RMS"], rel=1e-5)
    assert found["points_mean"] == pytest.approx(expected["mean"], rel=1e-5)
    assert found["points_maximum"] == pytest.approx(expected["max"], rel=1e-5)
    assert found["diagonal"] == pytest.approx(meshes.current_mesh().bounding_box().diagonal(), rel=1e-5)


def test_the_same_bytes_whatever_the_threads(stream, tmp_path):
    cloud = write_points(tmp_path / "cloud.ply", bench.surface(100_000, 1))
    files, distances = set(), set()
    for number, words in enumerate((["threads=1"], ["threads=2"])):
        out = tmp_path / f"mesh{number}.ply"
        found = results(stream(cloud, out, "target_vertices=300", *words))
        files.add(out.read_bytes())
        distances.add((found["points_rms"], found["points_mean"], found["points_maximum"]))
    assert len(files) == len(distances) == 1


@FULL
def test_large_coordinates_are_kept(meshes, stream, tmp_path):
    """Learned at UTM coordinates as at the origin; the mesh has the coordinates of the cloud."""
    points = bench.surface(40_000, 1) * 10
    ply(tmp_path / "here.ply", "f8", "<", points=points)
    ply(tmp_path / "there.ply", "f8", "<", points=points + ORIGIN)
    here = results(stream(tmp_path / "here.ply", tmp_path / "a.ply", "target_vertices=400"))
    for ending in ("ply", "obj", "off"):
        there = results(stream(tmp_path / "there.ply", tmp_path / f"b.{ending}", "target_vertices=400"))
        meshes.load_new_mesh(str(tmp_path / f"b.{ending}"))
        vertices = meshes.current_mesh().vertex_matrix() - ORIGIN
        assert np.abs(vertices).max() < 12 and np.abs(vertices.mean(axis=0)).max() < 1
        assert there["points_rms"] == pytest.approx(here["points_rms"], rel=.05) and there["points_rms"] < .05


def test_points_that_are_not_finite_are_counted(stream, tmp_path):
    points = bench.surface(5000, 1)
    points[::10, 2] = np.nan
    points[5:7, 0] = np.inf, -np.inf
    done = stream(write_points(tmp_path / "cloud.ply", points), tmp_path / "mesh.ply", "target_vertices=200")
    assert results(done)["skipped"] == 502 and results(done)["points"] == 5000
    assert "502 of them are left out: they are not finite." in done.stdout
    assert "all 4,498 points" in done.stdout and not done.stderr


# Bad input


def short(path, writer, size=None):
    writer(path)
    content = path.read_bytes()
    path.write_bytes(content[:size or len(content) // 2])


BAD = {
    "nowhere.ply": (None, "cannot be read: No such file or directory."),
    "empty.ply": (lambda path: path.touch(), "is empty."),
    "none.ply": (lambda path: ply(path, "f8", "<", points=POINTS[:0]), "holds no points."),
    "text.ply": (lambda path: path.write_text("some text\n" * 100), "is not a PLY file."),
    "header.ply": (lambda path: short(path, lambda p: ply(p, "f8", "<"), 60), "is cut short in its header."),
    "short.ply": (lambda path: short(path, lambda p: ply(p, "f8", "<")), "is cut short: it announces 1000 points and"),
    "lists.ply": (lambda path: path.write_text("ply\nformat ascii 1.0\nelement vertex 9\nproperty list uchar int x\n"
                                               "end_header\n"), "has lists in or before its vertices"),
    "flat.ply": (lambda path: path.write_text("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                                              "property float y\nend_header\n1 2\n"), "vertices without x, y and z."),
    "word.ply": (lambda path: path.write_text("ply\nformat ascii 1.0\nelement vertex many\nend_header\n"),
                 "has the header line 'element vertex many', which is not PLY."),
    "short_ascii.ply": (lambda path: short(path, ascii_ply), "cut short|has the line"),
    "nan.ply": (lambda path: ply(path, "f8", "<", points=POINTS * np.nan), "holds no point with finite coordinates."),
    "words.xyz": (lambda path: path.write_text("no points\n" * 200), "has no line that begins with three numbers."),
    "bytes.xyz": (lambda path: path.write_bytes(b"1 2 3\n" + bytes(200_000)), "more than 65536 bytes.|the line"),
    "text.las": (lambda path: path.write_text("some text\n" * 100), "cannot be read: "),
    "short.las": (lambda path: short(path, las), "is cut short: it announces 1000 points and"),
    "short.e57": (lambda path: short(path, e57), "cannot be read: "),
    "cloud.abc": (lambda path: path.write_text("1 2 3\n"), "has no ending that stream reads: .ply, .xyz"),
    "few.xyz": (lambda path: path.write_text("1 2 3\n4 5 6\n"), "points"),
}


@pytest.mark.parametrize("name", BAD)
def test_a_bad_cloud_is_one_sentence_and_no_file(stream, tmp_path, name):
    writer, words = BAD[name]
    folder = tmp_path / "out"
    folder.mkdir()
    if writer:
        writer(tmp_path / name)
    sentence = error_of(stream(tmp_path / name, folder / "mesh.ply", "target_vertices=100"), 1)
    assert sentence.startswith("neural-mesh: ") and sentence.endswith(".") and re.search(words, sentence), sentence
    assert not list(folder.iterdir())


@pytest.fixture
def small(tmp_path):
    return write_points(tmp_path / "small.ply", bench.surface(3000, 1))


@pytest.mark.parametrize("words, sentence", [
    (["mesh.stl"], "mesh.stl cannot be written: stream writes .ply, .obj, .off, which keep coordinates"),
    (["nowhere/mesh.ply"], "Nothing can be written into the folder nowhere: No such file or directory."),
    (["/proc/mesh.ply"], "Nothing can be written into the folder /proc: "),
    (["small.ply"], "The mesh small.ply would replace its cloud: give another name."),
    (["folder.ply"], "folder.ply is a folder: give the name of a file."),
    (["mesh.ply", "vertices=5"], "There is no parameter vertices."),
    (["mesh.ply", "--memory", "100MB"], "10,000 vertices need "),
    (["mesh.ply", "--memory", "1GB", "target_vertices=1000000"], "1,000,000 vertices need "),
])
def test_a_wrong_request_is_one_sentence_before_any_work(stream, small, tmp_path, words, sentence):
    (tmp_path / "folder.ply").mkdir()
    before = sorted(tmp_path.iterdir())
    done = stream(small, *words, cwd=tmp_path)
    assert sentence in error_of(done, 2) and done.stdout == ""
    assert sorted(tmp_path.iterdir()) == before


def test_memory_that_is_named_as_needed_is_enough(stream, small, tmp_path):
    asked = error_of(stream(small, tmp_path / "mesh.ply", "--memory", "100MB", "target_vertices=400"), 2)
    enough = re.search(r"need ([\d.]+ GB)", asked)[1].replace(" ", "")
    assert results(stream(small, tmp_path / "mesh.ply", "--memory", enough, "target_vertices=400"))["vertices"] == 400


@FULL
def test_what_a_killed_command_left_is_removed_by_the_next(stream, site, small, tmp_path):
    mesh, cloud = tmp_path / "mesh.ply", tmp_path / "cloud.ply"
    bench.write_cloud(cloud, 300_000)
    with subprocess.Popen([sys.executable, "-m", "neural_mesh", "stream", str(cloud), str(mesh), "target_vertices=3000"],
                          stdout=subprocess.PIPE, text=True, env=dict(os.environ, PYTHONPATH=str(site))) as command:
        while "Read" not in command.stdout.readline():
            assert command.poll() is None
        running = hidden(tmp_path)
        assert len(running) == 1
        results(stream(small, tmp_path / "other.ply", "target_vertices=100"))
        assert hidden(tmp_path) == running and command.poll() is None
        command.kill()
    assert hidden(tmp_path) == running
    results(stream(small, mesh, "target_vertices=100"))
    assert hidden(tmp_path) == []


def test_what_is_not_provably_left_stays(stream, small, tmp_path):
    for name in (".mesh.another-machine-1.part.ply", f".mesh.{socket.gethostname().replace('.', '-')}-1.part.ply"):
        (tmp_path / name).touch()
    before = hidden(tmp_path)
    results(stream(small, tmp_path / "mesh.ply", "target_vertices=100"))
    assert hidden(tmp_path) == before


def hidden(folder):
    return sorted(folder.glob(".*"))


@FULL
def test_a_full_disk_leaves_the_old_file(stream, small, tmp_path):
    """A limit on the size of files stands for a full disk."""
    out = tmp_path / "mesh.ply"
    out.write_text("the old one")
    before = sorted(tmp_path.iterdir())
    for limit in (50_000, 80_000, 91_000):  # too little for the sample, for the mesh, for the mesh's last bytes
        done = stream(small, out, "target_vertices=1480",
                      preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
        sentence = error_of(done, 1)
        assert ("cannot be written" in sentence or "could not be written" in sentence) and "None" not in sentence
        assert out.read_text() == "the old one" and sorted(tmp_path.iterdir()) == before


@pytest.mark.parametrize("name, words", [("a.las", "needs the package laspy: run pip install 'neural-mesh[las]'."),
                                         ("a.e57", "needs the package pye57: run pip install 'neural-mesh[e57]'.")])
def test_a_missing_package_is_named(site, monkeypatch, tmp_path, name, words):
    from neural_mesh import clouds
    FILES["plain.las" if name == "a.las" else "scans.e57"](tmp_path / name)
    monkeypatch.setitem(sys.modules, "laspy", None)
    monkeypatch.setitem(sys.modules, "pye57", None)
    with pytest.raises(clouds.CloudError, match=re.escape(words)):
        clouds.open_cloud(tmp_path / name)
