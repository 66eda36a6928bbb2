# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The core as a shared library: neural_mesh.reconstruct() and counters() give the bytes of the filter; arrays of all
kinds, progress, errors, threads. test_library_files.py has the files of a mesh, test_library_in_c.py has C."""

import functools
import re
from concurrent.futures import ThreadPoolExecutor

import inputs
import library_clouds
import numpy as np
import programs
import pytest
from conftest import PYTHON_NAME, parameters

BALL = library_clouds.directions(2000, 1)
FEW = BALL[:500]
FAST = {"target_vertices": 40, "settling_signals_per_vertex": 0}
COUNTERS_NAME = inputs.COUNTERS


def equal(one, other):
    return all((a is None and b is None) or (a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes())
               for a, b in zip(library_clouds.arrays_of(one), library_clouds.arrays_of(other)))


# --- the same as the filter ------------------------------------------------------------------------------------------


def layer_of(pymeshlab, points, colors=None, normals=None, faces=(), **_):
    arrays = {} if colors is None else {"v_color_matrix": np.column_stack([colors / 255, np.ones(len(colors))])}
    if normals is not None:
        arrays["v_normals_matrix"] = np.asarray(normals, dtype=float)
    return pymeshlab.Mesh(np.asarray(points, dtype=float), np.asarray(faces, dtype=np.int32).reshape(-1, 3), **arrays)


def filter_arguments(pymeshlab, points, **given):
    values = {name: value for name, value in given.items() if name not in ("colors", "normals", "faces")}
    if "close_holes_up_to" in values:
        values["close_holes_up_to"] = pymeshlab.PureValue(values["close_holes_up_to"])
    return values


@pytest.fixture(scope="module")
def learned(library):
    """learned(name) -> what reconstruct() takes, and the mesh that it gives."""
    @functools.lru_cache(None)
    def learn(name):
        given = library_clouds.clouds()[name]
        return given, library.reconstruct(**given)
    return learn


@pytest.mark.parametrize("name", library_clouds.clouds())
def test_the_same_bytes_as_recorded(learned, name):
    assert library_clouds.sum_of(library_clouds.arrays_of(learned(name)[1])) == library_clouds.recorded()[name]


@pytest.mark.parametrize("name", ["creases of floats", "open with normals", "uneven, far away"])
def test_the_same_bytes_as_the_filter(learned, pymeshlab, meshes, name):
    given, mesh = learned(name)
    meshes.add_mesh(layer_of(pymeshlab, **given))
    figures = meshes.apply_filter(PYTHON_NAME, select_features=True, **filter_arguments(pymeshlab, **given))
    assert {**mesh.report, "seconds": 0} == {**figures, "seconds": 0}
    layer = meshes.current_mesh()
    assert np.array_equal(layer.vertex_matrix(), mesh.vertices) and np.array_equal(layer.face_matrix(), mesh.faces)
    assert np.array_equal(layer.vertex_scalar_array(), mesh.quality)
    assert np.array_equal(layer.vertex_selection_array(), mesh.features)
    if "colors" in given and mesh.colors is not None:  # pymeshlab gives each layer made of arrays white points
        assert np.array_equal(np.rint(layer.vertex_color_matrix()[:, :3] * 255), mesh.colors)
    assert (mesh.creases is None) == ("crease_lines" not in given)
    if mesh.creases is not None:
        meshes.set_current_mesh(meshes.mesh_number() - 1)
        lines = meshes.current_mesh()
        assert np.array_equal(lines.vertex_matrix(), mesh.creases.vertices)
        assert np.array_equal(lines.edge_matrix(), mesh.creases.edges)
        assert np.array_equal(lines.vertex_scalar_array(), mesh.creases.quality)


def test_percentages_and_names_are_those_of_the_filter(library, pymeshlab, meshes):
    mesh = library.reconstruct(BALL, close_holes_up_to="3.7%", surface="Open", target_vertices=60)
    meshes.add_mesh(pymeshlab.Mesh(BALL))
    meshes.apply_filter(PYTHON_NAME, close_holes_up_to=pymeshlab.PercentageValue(3.7), surface="Open", target_vertices=60)
    assert np.array_equal(mesh.vertices, meshes.current_mesh().vertex_matrix())


@pytest.mark.parametrize("with_points", [True, False])
def test_counters_are_those_of_the_filter(library, pymeshlab, meshes, with_points):
    mesh = library.reconstruct(BALL, **FAST)
    meshes.add_mesh(pymeshlab.Mesh(BALL))
    meshes.add_mesh(pymeshlab.Mesh(mesh.vertices, mesh.faces))
    figures = meshes.apply_filter(COUNTERS_NAME, signal_layer=0 if with_points else 1, feature_measure=1,
                                  select_features=True)
    counted = library.counters(mesh, BALL if with_points else None, feature_measure="Crease measure")
    assert np.array_equal(counted.quality, meshes.current_mesh().vertex_scalar_array())
    assert np.array_equal(counted.features, meshes.current_mesh().vertex_selection_array())
    assert {**counted.report, "seconds": 0} == {**figures, "seconds": 0}
    assert counted.vertices is mesh.vertices and np.shares_memory(counted.faces, mesh.faces)


def test_learning_starts_from_a_given_mesh(library, pymeshlab, meshes):
    start = library.reconstruct(BALL, **FAST)
    mesh = library.reconstruct(BALL, start=start, target_vertices=90)
    meshes.add_mesh(pymeshlab.Mesh(start.vertices, start.faces))
    meshes.add_mesh(pymeshlab.Mesh(BALL))
    meshes.apply_filter(PYTHON_NAME, start_mesh=2, start_layer=0, target_vertices=90)
    assert np.array_equal(mesh.vertices, meshes.current_mesh().vertex_matrix())


def test_parameters_are_those_of_the_filters(library, build):
    for what, name in (("reconstruct", PYTHON_NAME), ("counters", COUNTERS_NAME)):
        of_filter = {row[0]: row for row in parameters(build, name) if row[1] != "RichMesh"}
        of_filter.pop("selected_only", None)  # of layers
        found = library.parameter_list(what)
        assert list(found) == list(of_filter)
        for name, row in of_filter.items():
            assert (found[name].low, found[name].high) == (row[2], row[3]), name
            assert found[name].help.endswith(".") and bool(found[name].choices) == (found[name].kind == "choice")


# --- arrays ----------------------------------------------------------------------------------------------------------


def test_arrays_of_any_layout_are_read_where_they_are(library):
    expected = library.reconstruct(FEW, **FAST)
    records = np.zeros(len(FEW), [("id", "u1"), ("x", "f8"), ("y", "f8"), ("z", "f8")])  # at odd addresses
    for column, axis in enumerate("xyz"):
        records[axis] = FEW[:, column]
    wide = np.zeros((len(FEW) * 2, 5))
    wide[::2, 3:0:-1] = FEW
    fixed = FEW.copy()
    fixed.flags.writeable = False
    for points in (np.asfortranarray(FEW), wide[::2, 3:0:-1], fixed, FEW.tolist(), FEW.astype(">f8"),
                   FEW[::-1][::-1], np.lib.stride_tricks.as_strided(records["x"], FEW.shape, (25, 8))):
        assert equal(library.reconstruct(points, **FAST), expected)
    assert np.array_equal(library.reconstruct((FEW * 100).astype(int), **FAST).vertices,
                          library.reconstruct((FEW * 100).astype(int).astype(float), **FAST).vertices)


def test_colours_are_bytes_or_parts_of_one(library):
    paint = library_clouds.paint(FEW)
    expected = library.reconstruct(FEW, colors=paint, **FAST)
    for colors in (paint / 255, np.column_stack([paint, paint[:, 0]]), (paint / 255).astype("f4")):
        assert equal(library.reconstruct(FEW, colors=colors, **FAST), expected)


def test_results_live_as_long_as_their_arrays(library):
    vertices = library.reconstruct(FEW, **FAST).vertices
    before = vertices.copy()
    for _ in range(2):
        library.reconstruct(FEW, **FAST)
    assert np.array_equal(vertices, before)


BAD = [
    (dict(vertices=5), "There is no parameter vertices. The parameters are target_vertices, "),
    (dict(start_layer=0), "There is no parameter start_layer."),
    (dict(target_vertices=1), "(Target vertices) is 1: choose a value from 4 to 20000000."),
    (dict(target_vertices=2.5), "(Target vertices) is 2.5: give a whole number from 4 to 20000000."),
    (dict(target_vertices=99999999999), "is 99999999999: give a whole number from 4 to 20000000."),
    (dict(target_vertices="many"), "is 'many': give a number."),
    (dict(target_vertices=True), "is True: give a number."),
    (dict(learning_rate=float("nan")), "(Learning rate) is nan: choose a value from 0.001 to 1."),
    (dict(fit_to_points=2), "(Fit to points) is 2: give a whole number from 0 to 1."),
    (dict(fit_to_points="yes"), "is 'yes': give True or False."),
    (dict(surface="Shut"), "is 'Shut': give 'Automatic' or 'Closed' or 'Open'."),
    (dict(surface=7), "(Surface) is 7: choose a value from 0 to 2."),
    (dict(close_holes_up_to="500%"), "a percentage of the diagonal from 0 to 100"),
    (dict(start_mesh=2), "start from a given mesh (start_mesh), but none is given."),
    (dict(points=BALL[:, :2]), "points have the shape (2000, 2): give an array of shape (n, 3)."),
    (dict(points=BALL[:0]), "no points to learn"),
    (dict(points=BALL[[0, 1, 1]]), "only 2 distinct points: a surface needs at least 4."),
    (dict(points=np.where(np.arange(6000).reshape(-1, 3) == 7, np.nan, BALL)),
     "1 of the 2000 points have coordinates that are not finite (NaN or infinite): remove them."),
    (dict(points=[["a", "b", "c"]]), "points are no numbers"),
    (dict(colors=library_clouds.paint(BALL)[:5]), "There are 5 colours for 2000 points: give one for each."),
    (dict(colors=BALL + 7), "colors are neither uint8 from 0 to 255 nor floats from 0 to 1"),
    (dict(colors=BALL[:, 0]), "colors have the shape (2000,): give an array of shape (n, 3) or (n, 4)."),
    (dict(normals=BALL[:5]), "There are 5 normals for 2000 points: give one for each."),
    (dict(faces=[[0, 1, 2000]]), "Face 0 has the corner 2000, but corners are numbers from 0 of 2000 points"),
    (dict(faces=[[0, 1, -1]]), "Face 0 has the corner -1"),
    (dict(faces=[[0, 1, .5]]), "faces have the shape (1, 3) and the type float64: give whole numbers"),
    (dict(start=5), "start is no mesh: give an object with vertices and faces, or a pair of arrays."),
    (dict(start=(BALL, [[0, 1, 2], [0, 1, 2]])), "."),
]


@pytest.mark.parametrize("given, sentence", BAD)
def test_bad_input_raises_a_sentence(library, given, sentence):
    with pytest.raises(ValueError) as caught:
        library.reconstruct(**{"points": BALL, **given})
    assert sentence in str(caught.value) and str(caught.value).endswith(".")


def test_counters_of_a_mesh_that_is_none_raise_a_sentence(library):
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, np.nan]])
    for faces, sentence in (([[0, 1, 3]], "Vertex 3 of the given mesh has coordinates that are not finite"),
                            ([[0, 1, 2], [0, 1, 2]], "."), (np.zeros((0, 3), int), "."), ([[0, 1, 9]], "corner 9")):
        with pytest.raises(ValueError, match=re.escape(sentence)):
            library.counters((corners, faces))


# --- progress, Ctrl-C, threads ---------------------------------------------------------------------------------------


def test_progress_is_told_and_can_stop(library):
    told = []
    library.reconstruct(BALL, progress=lambda part, activity: told.append((part, activity)), **FAST)
    parts = [part for part, _ in told]
    assert parts == sorted(parts) and 0 <= parts[0] and parts[-1] <= 1 and any("Learning" in words for _, words in told)
    mesh = library.reconstruct(BALL, target_vertices=500, progress=lambda part, _: part < .5)
    assert mesh.report["stop_reason"] == 2 and 4 <= len(mesh.vertices) < 500
    assert mesh.faces.max() < len(mesh.vertices)


def test_what_progress_raises_comes_out(library):
    def refuse(part, _):
        if part > .3:
            raise LookupError("enough")
    with pytest.raises(LookupError, match="enough"):
        library.reconstruct(BALL, progress=refuse, **FAST)


CTRL_C = """
import neural_mesh, numpy, os, signal, threading, time
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell may have told children to ignore it
points = numpy.random.default_rng(1).normal(size=(100_000, 3))
points /= numpy.linalg.norm(points, axis=1)[:, None]
def interrupt():
    global sent
    sent = time.monotonic()
    os.kill(os.getpid(), signal.SIGINT)
threading.Timer(.8, interrupt).start()
try:
    neural_mesh.reconstruct(points, target_vertices=1_000_000)
    raise SystemExit("not interrupted")
except KeyboardInterrupt:
    assert time.monotonic() - sent < 1, time.monotonic() - sent
"""


def test_ctrl_c_ends_a_run_within_a_second(site):
    done = programs.python(site, "-c", CTRL_C, timeout=30)
    assert done.returncode == 0, done.stderr


def test_two_threads_at_once_give_the_bytes_of_one(library):
    clouds = [BALL[:1000], library_clouds.box(1000, 1)]

    def learn(points):
        return library.reconstruct(points, target_vertices=100)

    alone = [learn(points) for points in clouds]
    with ThreadPoolExecutor(2) as pool:
        assert all(map(equal, alone, pool.map(learn, clouds)))
