# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""What the Python package tells of a run besides its results: neural_mesh.log(), and warnings of Python."""

import inputs
import meshlabserver
import programs
import pytest
from conftest import PYTHON_NAME, write_points


@pytest.fixture(scope="module")
def sheet(tmp_path_factory):
    """A cloud that is learned with warnings."""
    return write_points(tmp_path_factory.mktemp("clouds") / "sheet.ply", inputs.square())


@pytest.fixture(scope="module")
def ball(tmp_path_factory):
    """A cloud that is learned without warnings."""
    return write_points(tmp_path_factory.mktemp("clouds") / "ball.ply", inputs.ball())


def run(site, tmp_path, script, *words):
    """The standard output of a script."""
    (tmp_path / "script.py").write_text(script)
    done = programs.python(site, tmp_path / "script.py", *words)
    assert done.returncode == 0, done.stderr
    return done.stdout


BEGIN = """
import neural_mesh, pymeshlab, sys, warnings

def meshes_with(cloud, verbose=False):
    meshes = pymeshlab.MeshSet(verbose=verbose)
    meshes.load_new_mesh(cloud)
    return meshes

def caught_by(run):
    with warnings.catch_warnings(record=True) as caught:
        run()
    return caught
"""
AS_A_SCRIPT = BEGIN + f"""
assert neural_mesh.log() == [] and str(neural_mesh.log()) == ""
results = []
meshes = meshes_with(sys.argv[1])
by_method = caught_by(lambda: results.append(
    meshes.generate_surface_reconstruction_neural_mesh(target_vertices=100)))
log = neural_mesh.log()
assert len(log.warnings) == results[0]["warnings"] > 0
assert all(text.endswith(".") for text in log.warnings + log.notes)
assert log.notes[0].startswith("Neural Mesh: 100 vertices") and {{kind for kind, text in log}} == {{"note", "warning"}}
assert str(log).splitlines()[-1] == "warning: " + log.warnings[-1]

meshes.set_current_mesh(0)
by_name = [caught_by(lambda: meshes.apply_filter({PYTHON_NAME!r}, target_vertices=100)) for _ in range(2)]
lines = open(__file__).read().splitlines()
for caught, call in ((by_method, "meshes.generate"), (by_name[0], "meshes.apply"), (by_name[1], "meshes.apply")):
    assert [str(one.message) for one in caught] == log.warnings
    assert {{one.category for one in caught}} == {{neural_mesh.NeuralMeshWarning}}
    assert all(one.filename == __file__ and call in lines[one.lineno - 1] for one in caught)

log = neural_mesh.log()
assert not caught_by(meshes.get_geometric_measures) and neural_mesh.log() == log  # a filter of others
quiet = meshes_with(sys.argv[2])
assert not caught_by(lambda: quiet.generate_surface_reconstruction_neural_mesh(target_vertices=100))
assert not neural_mesh.log().warnings and "confidence" in neural_mesh.log().notes[1]
assert not caught_by(quiet.compute_scalar_by_neural_normal_counter_per_vertex)
assert [text.split(":")[0] for text in neural_mesh.log().notes] == ["Neural Normal Counter"]

try:
    quiet.generate_surface_reconstruction_neural_mesh(target_vertices=1)
    assert False
except pymeshlab.PyMeshLabException as error:
    assert [kind for kind, text in neural_mesh.log()] == ["error"]
    assert neural_mesh.log()[0].text in str(error)
quiet.clear()
for method in (pymeshlab.MeshSet.generate_surface_reconstruction_neural_mesh,
               pymeshlab.MeshSet.compute_scalar_by_neural_normal_counter_per_vertex):
    assert "neural_mesh.log()" in method.__doc__
print("whole")
"""


def test_a_script_reads_the_messages_and_gets_the_warnings(site, sheet, ball, tmp_path):
    assert run(site, tmp_path, AS_A_SCRIPT, sheet, ball) == "whole\n"


AS_PRINTED = BEGIN + """
warnings.simplefilter("ignore", neural_mesh.NeuralMeshWarning)
meshes_with(sys.argv[1], True).generate_surface_reconstruction_neural_mesh(target_vertices=100)
print(neural_mesh.log(), file=open(sys.argv[2], "w"))
"""


def test_the_messages_are_those_that_a_verbose_mesh_set_prints(site, sheet, tmp_path):
    (tmp_path / "script.py").write_text(AS_PRINTED)
    done = programs.python(site, tmp_path / "script.py", sheet, tmp_path / "log")
    printed = done.stdout + done.stderr
    messages = [line.split(": ", 1) for line in (tmp_path / "log").read_text().splitlines()]
    assert done.returncode == 0 and "NeuralMeshWarning" not in printed
    assert {kind for kind, text in messages} == {"note", "warning"}
    lines = [line.strip() for line in printed.splitlines()]
    for kind, text in messages:
        assert f"LOG: {'1' if kind == 'warning' else '2'} {text}" in lines  # the host's numbers
    assert sum(line.startswith("LOG: 1 ") for line in lines) == sum(kind == "warning" for kind, text in messages)


IN_THREADS = BEGIN + """
from concurrent.futures import ThreadPoolExecutor
from threading import Barrier
together, found = Barrier(2, timeout=60), {}

def learn(meshes, vertices):
    for _ in range(3):
        together.wait()
        result = meshes.generate_surface_reconstruction_neural_mesh(target_vertices=vertices)
        together.wait()
        found.setdefault(vertices, []).append((result["warnings"], neural_mesh.log()))
        meshes.set_current_mesh(0)

warnings.simplefilter("ignore", neural_mesh.NeuralMeshWarning)
# MeshLab opens a file from the current folder, which it changes for the whole process: not in two threads at once.
sets = [meshes_with(cloud) for cloud in sys.argv[1:]]
with ThreadPoolExecutor(2) as pool:
    list(pool.map(learn, sets, (100, 110)))
for vertices, runs in found.items():
    assert len(runs) == 3 and all((warned > 0) == (vertices == 100) for warned, log in runs)
    assert all(len(log.warnings) == warned and f" {vertices} vertices" in log.notes[0] for warned, log in runs)
assert neural_mesh.log() == []
print("whole")
"""


def test_each_thread_has_the_messages_of_its_own_run(site, sheet, ball, tmp_path):
    assert run(site, tmp_path, IN_THREADS, sheet, ball) == "whole\n"


PLUGIN_FIRST = "import pymeshlab, sys\npymeshlab.load_plugin(sys.argv[2])" + BEGIN + """
import importlib
importlib.reload(neural_mesh)
meshes = meshes_with(sys.argv[1])
assert len(caught_by(lambda: meshes.generate_surface_reconstruction_neural_mesh(target_vertices=100))) > 0
assert neural_mesh.log().warnings
assert not hasattr(pymeshlab.MeshSet.apply_filter.__wrapped__, "__wrapped__")
warnings.simplefilter("error", neural_mesh.NeuralMeshWarning)
try:
    meshes.generate_surface_reconstruction_neural_mesh(target_vertices=100)
    assert False
except neural_mesh.NeuralMeshWarning as warning:
    assert str(warning) == neural_mesh.log().warnings[0]
assert meshes.mesh_number() == 3  # the warning came after the run
print("whole")
"""


def test_it_reads_a_plugin_that_was_loaded_before(build, site, sheet, tmp_path):
    plugin = meshlabserver.plugin_path(build, "pymeshlab-2025.7")
    assert run(site, tmp_path, PLUGIN_FIRST, sheet, plugin) == "whole\n"


def test_the_command_says_warnings_as_sentences(site, sheet, tmp_path):
    done = programs.python(site, "-m", "neural_mesh", sheet, tmp_path / "mesh.ply", "target_vertices=100")
    said = done.stderr.splitlines()
    assert done.returncode == 0 and said and all(line.startswith("neural-mesh: ") and line.endswith(".") for line in said)
    assert done.stdout.endswith(f" warnings={len(said)}\n")
