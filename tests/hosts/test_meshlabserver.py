# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""MeshLab 2020.09: sentences for bad input, the layer's matrix, the untouched input layer."""

import meshlabserver
import numpy as np
import pytest
from conftest import BAD_CLOUDS, out_of_range, write_points

FAILED = 255


def assert_refused(code, text, words):
    """The filter failed with a sentence in the log, and nothing worse happened."""
    assert code == FAILED, text
    assert "Problem with filter: Surface Reconstruction: Neural Mesh" in text
    lines = [line for line in text.splitlines() if words in line and not line.startswith("LOG")]
    assert len(lines) == 1, text
    assert lines[0].rstrip().endswith(".")
    assert "aborted" not in text.lower() and "assertion" not in text.lower()


@pytest.mark.parametrize("name", BAD_CLOUDS)
def test_a_cloud_that_cannot_be_learned_is_refused(build, server, tmp_path, name):
    points, words = BAD_CLOUDS[name]
    cloud = write_points(tmp_path / "cloud.ply", points)
    script = meshlabserver.write_script(build, tmp_path / "s.mlx", target_vertices=100)
    code, text = meshlabserver.run(server, "-i", cloud, "-o", tmp_path / "out.ply", "-s", script)
    assert_refused(code, text, words)
    assert not (tmp_path / "out.ply").exists()


def test_no_layer_at_all_is_refused(build, server, tmp_path):
    script = meshlabserver.write_script(build, tmp_path / "s.mlx", target_vertices=100)
    assert_refused(*meshlabserver.run(server, "-s", script), "no current layer")


def test_every_parameter_out_of_range_is_refused(build, server, model, tmp_path):
    cloud, _ = model("sphere")
    cases = out_of_range(build)
    assert len(cases) > 20
    for name, value in cases:
        script = meshlabserver.write_script(build, tmp_path / "s.mlx", **{name: value})
        code, text = meshlabserver.run(server, "-i", cloud, "-o", tmp_path / "out.ply", "-s", script)
        assert_refused(code, text, f"The parameter {name} ")
    script = meshlabserver.write_script(build, tmp_path / "s.mlx", utility_counter=7)
    assert_refused(*meshlabserver.run(server, "-i", cloud, "-s", script), "The parameter utility_counter ")


def test_selected_only_without_a_selection_is_refused(build, server, model, tmp_path):
    for source, kind in zip(model("sphere"), ("vertices", "faces")):
        script = meshlabserver.write_script(build, tmp_path / "s.mlx", selected_only=True)
        code, text = meshlabserver.run(server, "-i", source, "-s", script)
        assert_refused(code, text, f"Only the selected {kind}")


PROJECT = """<!DOCTYPE MeshLabDocument>
<MeshLabProject>
 <MeshGroup>
  <MLMesh label="cloud" filename="{file}" visible="1">
   <MLMatrix44>
{matrix}
   </MLMatrix44>
  </MLMesh>
 </MeshGroup>
 <RasterGroup/>
</MeshLabProject>
"""


def test_the_matrix_of_the_layer_is_applied_and_the_input_stays(build, server, model, pymeshlab, tmp_path):
    cloud, _ = model("filleted-cube")
    matrix = np.array([[0, -2, 0, 100], [2, 0, 0, -50], [0, 0, 3, 7], [0, 0, 0, 1]], dtype=float)
    rows = "\n".join(" ".join(f"{x:g}" for x in row) + " " for row in matrix)
    copy = tmp_path / "cloud.ply"
    copy.write_bytes(cloud.read_bytes())
    (tmp_path / "project.mlp").write_text(PROJECT.format(file=copy, matrix=rows))
    script = meshlabserver.write_script(build, tmp_path / "s.mlx", target_vertices=1000)
    code, text = meshlabserver.run(server, "-p", tmp_path / "project.mlp", "-o", tmp_path / "out.ply", "-m", "vq",
                                   "-o", tmp_path / "input.ply", "-l", "0", "-s", script)
    assert code == 0, text

    meshes = pymeshlab.MeshSet(verbose=False)
    for file in (copy, tmp_path / "out.ply", tmp_path / "input.ply"):
        meshes.load_new_mesh(str(file))
    given, learned, kept = (meshes.mesh(i).vertex_matrix() for i in range(3))
    assert (given == kept).all(), "the input layer has changed"
    world = given @ matrix[:3, :3].T + matrix[:3, 3]
    write_points(tmp_path / "world.ply", world)
    found = meshlabserver.check_mesh(build, tmp_path / "out.ply", tmp_path / "world.ply")
    assert len(learned) == found["vertices"] == 1000 and found["watertight"]
    assert found["rms_to_mesh"] < 0.5
    assert (np.abs(learned.max(0) - world.max(0)) < 0.1).all() and (np.abs(learned.min(0) - world.min(0)) < 0.1).all()


def test_large_coordinates_survive(build, server, model, pymeshlab, tmp_path):
    """A cloud a thousand of its own sizes away: the core centres in double, so only the file's floats limit it."""
    cloud, _ = model("sphere")
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.load_new_mesh(str(cloud))
    far = write_points(tmp_path / "far.ply", meshes.current_mesh().vertex_matrix() + [2000, -3000, 1000])
    script = meshlabserver.write_script(build, tmp_path / "s.mlx", target_vertices=1000)
    meshlabserver.reconstruct(server, far, script, tmp_path / "out.ply")
    found = meshlabserver.check_mesh(build, tmp_path / "out.ply", far)
    assert found["vertices"] == 1000 and found["watertight"] and found["rms_to_mesh"] < 0.5
