# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The shared library from C: its example, wrong calls, and what it exports."""

import ctypes
import re

import library_clouds
import programs
from check_mesh import check_mesh
from python_site import LIBRARY

BALL = library_clouds.directions(2000, 1)


def example_in_c(build, *words, points):
    text = "".join(" ".join(map(repr, map(float, point))) + "\n" for point in points)
    return programs.run(build / "tests/c_example", *words, input=text)


def test_the_example_in_c_makes_a_mesh(build, tmp_path):
    done = example_in_c(build, "150", points=BALL)
    assert done.returncode == 0 and "vertices=150 faces=296 " in done.stderr, done.stderr
    (tmp_path / "mesh.obj").write_text(done.stdout)
    found = check_mesh(tmp_path / "mesh.obj")
    assert found["vertices"] == 150 and found["watertight"] and found["oriented"]


def test_the_example_in_c_shows_the_sentence_of_an_error(build):
    done = example_in_c(build, "150", points=BALL[:3])
    assert done.returncode == 1 and done.stderr.splitlines()[-1].endswith("a surface needs at least 4.")
    done = example_in_c(build, "1", points=BALL)
    assert done.returncode == 1 and "is 1: choose a value from 4 to" in done.stderr


def test_wrong_calls_have_a_status_and_a_sentence(library):
    """Of C, which the Python package never makes."""
    from neural_mesh.library import _Array, _CallBack
    from neural_mesh.library import library as loaded
    c, no_progress, wrong_call = loaded(), _CallBack(), 4
    assert re.fullmatch(rb"\d+\.\d+\.\d+", c.neural_mesh_version()) and c.neural_mesh_error(None) == b"There is no task."
    assert c.neural_mesh_new(7) is None and not c.neural_mesh_parameters(7, ctypes.c_size_t())
    assert c.neural_mesh_set(None, b"surface", 1) == c.neural_mesh_run(None, no_progress, None, None) == wrong_call
    c.neural_mesh_free(None)
    c.neural_mesh_free_result(None)
    task = c.neural_mesh_new(0)
    for call, words in ((lambda: c.neural_mesh_set(task, None, 1), b"name of the parameter is missing."),
                        (lambda: c.neural_mesh_set_points(task, _Array(None, 3, 1, 24, 8)), b"has rows, but no data."),
                        (lambda: c.neural_mesh_set_points(task, _Array(None, 0, 2, 24, 8)), b"is none of those allowed."),
                        (lambda: c.neural_mesh_run(task, no_progress, None, None), b"no place for the result."),
                        (lambda: c.neural_mesh_distances(task, _Array(None, 0, 3, 24, 8), None), b"none of those allowed."),
                        (lambda: c.neural_mesh_distances(task, None, None), b"no place for the distances.")):
        assert call() == wrong_call and c.neural_mesh_error(task).endswith(words)
    assert c.neural_mesh_set(task, b"surface", 1) == 0 and c.neural_mesh_error(task) == b""
    c.neural_mesh_free(task)


def test_only_functions_of_the_header_are_exported(build):
    names = programs.output_of("nm", "-D", "--defined-only", build / LIBRARY)
    exported = set(re.findall(r" T (\w+)@@NEURAL_MESH_1$", names, re.MULTILINE))
    header = (library_clouds.RECORD.parents[2] / "vcg_core/c_api/neural_mesh.h").read_text()
    assert exported == set(re.findall(r"^NEURAL_MESH_API .*?\b(neural_mesh_\w+)\(", header, re.MULTILINE))
    assert len(names.splitlines()) == len(exported) + 1  # and the version's name
