# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""`neural-mesh stream`: readers against the points that were written, the even sample, memory, the distances of all
points against pymeshlab with the whole cloud, and a sentence for each bad input."""

import importlib.util
import os
import re
import resource
import subprocess
import sys

import meshlabserver
import numpy as np
import psutil
import pytest
from conftest import ROOT, write_points

spec = importlib.util.spec_from_file_location("bench_stream", ROOT / "tests/bench/stream.py")
bench = importlib.util.module_from_spec(spec)
spec.loader.exec_module(bench)

ORIGIN = np.array([4512345.5, 5801234.25, 312.0])


@pytest.fixture(scope="module")
def site(build, tmp_path_factory):
    """The package as installed: the folder for PYTHONPATH, in this process's path, too."""
    folder = bench.install(meshlabserver.plugin_path(build, "pymeshlab-2025.7"), tmp_path_factory.mktemp("site"))
    sys.path.insert(0, str(folder))
    yield folder
    sys.path.remove(str(folder))


@pytest.fixture(scope="module")
def stream(site):
    """stream(word...) -> the finished process of the command."""
    def run(*words, **options):
        return subprocess.run([sys.executable, "-m", "neural_mesh", "stream", *map(str, words)], text=True, check=False,
                              capture_output=True, env=dict(os.environ, PYTHONPATH=str(site)), **options)
    return run


def last_line(output):
    """The results as a dictionary of numbers."""
    return {key: float(value) for key, value in (word.split("=") for word in output.splitlines()[-1].split())}


def results(done):
    assert done.returncode == 0, done.stdout + done.stderr
    return last_line(done.stdout)


def error_of(done, status):
    assert done.returncode == status and "Traceback" not in done.stderr, done.stderr
    return done.stderr.splitlines()[-1]


# Readers

POINTS = np.round(np.random.default_rng(1).normal(size=(1000, 3)), 3) + ORIGIN


def ply(path, kind, order, extra="", points=POINTS, tail=b""):
    """Vertices with a property before and one after the coordinates, after an element of other things."""
    record = np.zeros(len(points), [("q", order + "i2"), *((axis, order + kind) for axis in "xyz"), ("r", "u1")])
    record["q"], record["r"] = 7, 8
    for column, axis in enumerate("xyz"):
        record[axis] = points[:, column]
    name = {"f4": "float", "f8": "double"}[kind]
    path.write_bytes((f"ply\nformat binary_{'little' if order == '<' else 'big'}_endian 1.0\ncomment of no use\n{extra}"
                      f"element vertex {len(points)}\nproperty short q\n"
                      + "".join(f"property {name} {axis}\n" for axis in "xyz") +
                      "property uchar r\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n").encode()
                     + (b"\0" * 24 if extra else b"") + record.tobytes() + tail)


def lines(path, separator=" ", head="", tail=""):
    path.write_text(head + "".join(separator.join(map(repr, map(float, row))) + tail + "\n" for row in POINTS))


def ascii_ply(path):
    lines(path, head="ply\nformat ascii 1.0\nelement camera 1\nproperty float f\nelement vertex 1000\n"
          "property double x\nproperty double y\nproperty double z\nproperty uchar red\nelement face 1\nproperty list uchar "
          "int vertex_indices\nend_header\n3.5\n", tail=" 7")
    path.write_text(path.read_text() + "3 0 1 2\n")


def las(path):
    import laspy
    header = laspy.LasHeader(point_format=3, version="1.2")
    header.scales, header.offsets = [.001] * 3, ORIGIN
    file = laspy.LasData(header)
    file.x, file.y, file.z = POINTS.T
    file.write(str(path))


TURN = np.array([np.cos(.4), 0, 0, np.sin(.4)])  # a quaternion about z


def e57(path):
    """Two scans with poses."""
    import pye57
    angle = .8
    turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    with pye57.E57(str(path), mode="w") as file:
        for points in (POINTS[:400], POINTS[400:]):
            x, y, z = turn.T @ (points - ORIGIN).T
            file.write_scan_raw({"cartesianX": x, "cartesianY": y, "cartesianZ": z}, rotation=TURN, translation=ORIGIN)


FILES = {
    "little.ply": lambda path: ply(path, "f8", "<"),
    "big.ply": lambda path: ply(path, "f8", ">", "element camera 3\nproperty double f\n"),
    "ascii.ply": ascii_ply,
    "plain.xyz": lines,
    "heading.csv": lambda path: lines(path, ",", "a scanner\n//X,Y,Z,Intensity\n", ",.5"),
    "columns.csv": lambda path: lines(path, ";", "\"x\";y;z;id\n", ";1"),
    "count.pts": lambda path: lines(path, "\t", "1000\n", "\t12 0 0 255"),
    "ends.txt": lambda path: path.write_text("\r\n".join(" ".join(map(repr, map(float, row))) for row in POINTS)),
    "plain.las": las,
    "packed.laz": las,
    "scans.e57": e57,
}


@pytest.mark.parametrize("name", FILES)
def test_chunks_are_the_points_that_were_written(site, tmp_path, name):
    from neural_mesh import clouds
    FILES[name](tmp_path / name)
    cloud = clouds.open_cloud(tmp_path / name)
    assert cloud.count in (1000, None if cloud.path.suffix in clouds.TEXT else 1000)
    for size in (7, 300, 1000, 5000):
        chunks = list(cloud.chunks(size))
        assert all(chunk.dtype == float and len(chunk) <= size for chunk in chunks)
        assert np.abs(np.concatenate(chunks) - POINTS).max() < 1e-6  # of LAS and turned scans; others are exact
        assert cloud.done == 1


def test_lines_of_all_kinds(site, tmp_path):
    from neural_mesh import clouds
    path = tmp_path / "a.xyz"
    path.write_text("# points\n\n1 2 3\n4 5 6 7\n\n// of another scan\n8 nan 10\n11 12 1e3\n  \n")
    points = np.concatenate(list(clouds.open_cloud(path).chunks(100)))
    assert np.array_equal(points, [[1, 2, 3], [4, 5, 6], [8, np.nan, 10], [11, 12, 1000]], equal_nan=True)
    path.write_text("z,x,y\n3,1,2\n")
    assert np.array_equal(next(clouds.open_cloud(path).chunks(9)), [[1, 2, 3]])
    faces = tmp_path / "a.ply"
    faces.write_text("ply\nformat ascii 1.0\nelement vertex 1\nproperty uchar r\nproperty uchar g\nproperty uchar b\n"
                     "property float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int "
                     "vertex_indices\nend_header\n7 8 9 1 2 3\n3 0 0 0\n")
    assert np.array_equal(next(clouds.open_cloud(faces).chunks(9)), [[1, 2, 3]])
    for text, words in (("1 2 3\n4 5\n", "has the line '4 5'"), ("1 2 3\n4 5 6\n7 8 9x\n", "has the line '7 8 9x'"),
                        ("1 2 3 4\n5 6 7\n8 9 1 2 3\nword\n", "has the line 'word'")):
        path.write_text(text)
        with pytest.raises(clouds.CloudError, match=words):
            list(clouds.open_cloud(path).chunks(100))


def test_invalid_points_of_e57_are_left_out(site, tmp_path):
    import pye57
    from neural_mesh import clouds, even_sample
    with pye57.E57(str(tmp_path / "a.e57"), mode="w") as file:
        x, y, z = np.arange(30.0).reshape(3, 10)
        file.write_scan_raw({"cartesianX": x, "cartesianY": y, "cartesianZ": z,
                             "cartesianInvalidState": (x % 3 == 1).astype("u1")})
    sample = even_sample.EvenSample(100, 400, 4)
    for points in clouds.open_cloud(tmp_path / "a.e57").chunks(4):
        sample.add(points)
    assert (sample.seen, sample.skipped) == (10, 3) and (sample.take()[:, 0] == [0, 2, 3, 5, 6, 8, 9]).all()


# The sample


def sample_of(points, limit, held=4, chunk=10_000):
    from neural_mesh.even_sample import EvenSample
    sample = EvenSample(limit, held * limit, chunk)
    for first in range(0, len(points), chunk):
        sample.add(points[first:first + chunk])
    return sample.take()


@pytest.mark.parametrize("held", [1, 2, 4])
@pytest.mark.parametrize("ordered", [False, True])
def test_the_sample_does_not_depend_on_chunks(site, held, ordered):
    points = bench.surface(100_000, 1)
    if ordered:  # as a scanner sweeps
        points = points[np.argsort(points[:, 0])]
    first = sample_of(points, 4000, held, 100_000)
    assert 950 * held <= len(first) <= 4200
    for chunk in (30_000, 7777, 1000):
        assert np.array_equal(sample_of(points, 4000, held, chunk), first), chunk


def test_a_cloud_within_the_limit_is_its_own_sample(site):
    points = bench.surface(5000, 1)
    points[17, 1] = np.nan
    for limit in (4999, 5000, 9000):
        assert np.array_equal(sample_of(points, limit, chunk=600), np.delete(points, 17, 0))
    assert len(sample_of(points, 4000)) == pytest.approx(4000, rel=.05)


def sheet(dense, sparse, random):
    """Points of two unit squares, side by side."""
    points = random.random((dense + sparse, 3)) * (1, 1, .001)
    points[dense:, 0] += 1
    return random.permutation(points)


def test_the_sample_is_more_even_than_the_cloud(site):
    """Where the density of the cloud varies by 100:1, that of the sample varies by 10:1."""
    sample = sample_of(sheet(400_000, 4000, np.random.default_rng(1)), 12_000)
    assert len(sample) == pytest.approx(12_000, rel=.05)
    cells = np.histogram2d(sample[:, 0], sample[:, 1], bins=[np.linspace(0, 2, 13), np.linspace(0, 1, 7)])[0]
    dense, sparse = cells[:5].ravel(), cells[7:].ravel()  # without those along the border
    assert dense.mean() / sparse.mean() == pytest.approx(10, rel=.15)
    assert dense.std() < .15 * dense.mean() and sparse.std() < .35 * sparse.mean()  # 6 and 18 % at random


def test_outliers_do_not_gain_weight(site):
    random = np.random.default_rng(1)
    points = random.permutation(np.concatenate([bench.surface(300_000, 1), random.uniform(-4, 4, (3000, 3))]))
    far = [(np.abs(np.linalg.norm(cloud, axis=1) - 1) > .5).mean() for cloud in (points, sample_of(points, 30_000))]
    assert .5 * far[0] < far[1] < 1.5 * far[0]


# Averages


def averaged(points, limit, chunk):
    """The sample of `points` before and after it is moved to the means."""
    from neural_mesh.averages import Averages
    from neural_mesh.even_sample import EvenSample
    sample = EvenSample(limit, 4 * limit, len(points))
    sample.add(points)
    before = sample.take()
    after = before.copy()
    averages = Averages(after, sample.level)
    for first in range(0, len(points), chunk):
        averages.add(points[first:first + chunk])
    return before, after, averages.move()


def test_averages_take_the_noise_from_means_only(site):
    """On a noisy sheet: means over patches get as exact as those of all points; spread along the sheet stays."""
    random = np.random.default_rng(1)
    points = np.column_stack([random.random((1_000_000, 2)), .003 * random.normal(size=1_000_000)])
    before, after, moved = averaged(points, 40_000, 100_000)
    assert moved > .9 * len(before) and np.abs((after - before)[:, :2]).max() < .002

    def noise_of_patches(cloud):
        patch = (cloud[:, 0] * 4).astype(int) * 4 + (cloud[:, 1] * 4).astype(int)
        return np.sqrt(np.mean((np.bincount(patch, cloud[:, 2]) / np.bincount(patch))**2))

    assert noise_of_patches(before) > .8 * .003 / np.sqrt(40_000 / 16)
    assert noise_of_patches(after) < .5 * noise_of_patches(before)  # what is left is of cubes on two patches
    assert after[:, 2].std() == pytest.approx(.003, rel=.05)
    for chunk in (1_000_000, 77_777):
        assert np.array_equal(averaged(points, 40_000, chunk)[1], after)


def test_averages_keep_edges_and_thin_walls(site):
    """Points without noise stay on the faces of a box; if it is thinner than cubes are wide, nearly."""
    for size, bound in (((1, .7, .4), 1e-9), ((1, .7, .05), .003)):
        random = np.random.default_rng(1)
        points, axes = random.uniform(-1, 1, (300_000, 3)), random.integers(0, 3, 300_000)
        points[np.arange(len(points)), axes] = random.choice([-1.0, 1.0], len(points))
        before, after, moved = averaged(points * size, 10_000, 100_000)
        assert np.abs((np.abs(after / size) - 1) * size).min(axis=1).max() < bound
        assert moved > .2 * len(before)


def test_the_least_axes_are_those_of_numpy(site):
    from neural_mesh.averages import _least_axes
    factors = np.random.default_rng(1).normal(size=(1000, 3, 3))
    matrices = factors @ factors.transpose(0, 2, 1)
    matrices[:3] = np.zeros((3, 3)), np.eye(3), np.diag([3, 1, 2])
    values, axes = np.linalg.eigh(matrices)
    least, middle, found = _least_axes(matrices.transpose(1, 2, 0).copy())
    assert np.abs(least - values[:, 0]).max() < 1e-12 and np.abs(middle - values[:, 1]).max() < 1e-12
    assert np.abs((found.T * axes[:, :, 0]).sum(axis=1))[2:] == pytest.approx(1, abs=1e-9)


# The command


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


def test_the_same_bytes_whatever_the_processes(stream, tmp_path):
    cloud = write_points(tmp_path / "cloud.ply", bench.surface(100_000, 1))
    files, distances = set(), set()
    for number, words in enumerate((["threads=1"], ["threads=2"])):
        out = tmp_path / f"mesh{number}.ply"
        found = results(stream(cloud, out, "target_vertices=300", *words))
        files.add(out.read_bytes())
        distances.add((found["points_rms"], found["points_mean"], found["points_maximum"]))
    assert len(files) == len(distances) == 1


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
    "empty.las": (lambda path: path.touch(), "is empty."),
    "text.las": (lambda path: path.write_text("some text\n" * 100), "cannot be read: "),
    "short.las": (lambda path: short(path, las), "is cut short: it announces 1000 points and"),
    "short.laz": (lambda path: short(path, las), "cannot be read: |cut short"),
    "text.e57": (lambda path: path.write_text("some text\n" * 100), "cannot be read: "),
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
    (["mesh.ply", "target_vertices=1"], "choose a value from 4 to"),
    (["mesh.ply", "--memory", "much"], "argument --memory: invalid memory_size value: 'much'"),
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


def test_processes_that_measure_end_with_a_killed_command(site, tmp_path):
    cloud = tmp_path / "cloud.ply"
    bench.write_cloud(cloud, 2_000_000)
    command = psutil.Popen([sys.executable, "-m", "neural_mesh", "stream", str(cloud), str(tmp_path / "mesh.ply"),
                            "target_vertices=200"], stdout=subprocess.PIPE, text=True,
                           env=dict(os.environ, PYTHONPATH=str(site)))
    while "Learned" not in command.stdout.readline():
        assert command.poll() is None
    while len(command.children()) < 2:  # one is multiprocessing's own, which ends by itself
        assert command.poll() is None
    children = command.children()
    command.kill()
    command.communicate()
    assert not psutil.wait_procs(children, timeout=10)[1]


def test_the_folder_of_a_killed_command_is_removed_by_the_next(stream, site, small, tmp_path):
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


def test_folders_that_are_not_provably_left_stay(stream, small, tmp_path):
    for name, content in ((".neural-mesh-other", "another machine"), (".neural-mesh-empty", None)):
        (tmp_path / name).mkdir()
        if content:
            (tmp_path / name / "lock").write_text(content)
    before = hidden(tmp_path)
    results(stream(small, tmp_path / "mesh.ply", "target_vertices=100"))
    assert hidden(tmp_path) == before


def hidden(folder):
    return sorted(folder.glob(".*"))


def test_counts_are_printed_in_full(site):
    from neural_mesh.parameters import line_of
    assert line_of({"points": 20_000_000, "rms": 1 / 3}) == "points=20000000 rms=0.333333"


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
