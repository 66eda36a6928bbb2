# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The counters of a given mesh in all hosts: the same values or the same error message, and nothing else changes."""

import features
import input_hosts
import inputs
import meshlabserver
import models
import numpy as np
import pytest
import shapes
from conftest import FULL, in_hosts, write_points
from input_hosts import state

COUNTED = inputs.counted_inputs()
ELSEWHERE = ("empty layer", "by the counter", "selection not asked for", "deleted vertices", "quads",
             "texture and attributes", "fins", "georeferenced")
COUNTS = ("vertices", "signals", "outliers", "feature_vertices", "warnings", "stop_reason")
MEASURES = ("mean_counter", "seconds")


@pytest.mark.parametrize("name, host", in_hosts(COUNTED, ELSEWHERE))
def test_the_same_values_or_error_message(build, server, pymeshlab, first_of, tmp_path, name, host):
    layer = COUNTED[name]
    found = input_hosts.try_out(build, server, pymeshlab, host, layer, tmp_path)
    assert found.unchanged, "more than quality and selection has changed"
    if layer.refused:
        assert layer.refused in found.sentence and found.sentence.endswith("."), found.sentence or "there are counters"
        assert found.sentence == first_of.setdefault(name, found.sentence)
        return
    assert not found.sentence, found.sentence
    first = first_of.setdefault(name, found)
    assert np.array_equal(found.quality, first.quality) and np.array_equal(found.selected, first.selected)
    assert [found.report[key] for key in COUNTS] == [first.report[key] for key in COUNTS]
    check(layer, found)


def check(layer, found):
    used = np.zeros(len(layer.points), dtype=bool)
    used[[corner for corners in layer.triangles() for corner in corners]] = True
    used = used[~layer.deleted]
    assert len(found.quality) == len(used) and found.report["vertices"] == used.sum()
    assert (found.quality[~used] == 0).all() and (found.quality[used] > 0).mean() > .99
    assert found.quality[used].mean() == pytest.approx(found.report["mean_counter"], rel=1e-4)
    assert found.report["signals"] == max(60_000, 60 * used.sum()) and found.report["stop_reason"] == 0
    if layer.parameters.get("select_features"):
        assert found.selected.sum() == found.report["feature_vertices"]
    else:
        assert np.array_equal(found.selected, layer.selected_points[~layer.deleted])


def test_the_dictionary_is_full_and_repeats(meshes, model):
    meshes.load_new_mesh(str(model("crossed-cylinders")[1]))
    reports, values = [], []
    for threads in (1, 2, 0):
        reports.append(meshes.apply_filter(inputs.COUNTERS, threads=threads))
        values.append(meshes.current_mesh().vertex_scalar_array().copy())
    assert set(reports[0]) == {*COUNTS, *MEASURES}
    assert all(type(reports[0][key]) is int for key in COUNTS) and all(type(reports[0][key]) is float for key in MEASURES)
    assert np.array_equal(values[0], values[1]) and np.array_equal(values[0], values[2])
    meshes.apply_filter(inputs.COUNTERS, random_seed=2)
    assert not np.array_equal(meshes.current_mesh().vertex_scalar_array(), values[0]), "the seed has no effect"


def test_signals_come_from_the_layer_that_is_named(pymeshlab, meshes):
    meshes.add_mesh(pymeshlab.Mesh(inputs.ball(20000) * [1.0, 1.0, .95]))
    meshes.add_mesh(pymeshlab.Mesh(*shapes.sphere(subdivisions=4)))
    before = state(meshes)
    values = []
    for layer in (0, 1, None):
        meshes.apply_filter(inputs.COUNTERS, **({} if layer is None else {"signal_layer": layer}))
        values.append(meshes.current_mesh().vertex_scalar_array().copy())
        assert input_hosts.without_values(state(meshes)) == input_hosts.without_values(before)
    assert state(meshes)[0][0] == before[0][0], "the signal layer has changed"
    assert not np.array_equal(values[0], values[1])
    assert np.array_equal(values[1], values[2]), "by default the signals come from the mesh itself"
    with pytest.raises(pymeshlab.PyMeshLabException, match="The layer to draw signals from does not exist"):
        meshes.apply_filter(inputs.COUNTERS, signal_layer=7)


def test_signals_come_from_the_layer_that_a_script_names(build, server, tmp_path):
    cloud = write_points(tmp_path / "cloud.ply", inputs.ball(20000) * [1.0, 1.0, .95])
    mesh = write_points(tmp_path / "mesh.ply", *shapes.sphere(subdivisions=4))
    saved = []
    for layer in (0, 1):
        script = meshlabserver.write_script(build, tmp_path / "s.mlx", inputs.COUNTERS, signal_layer=layer)
        out = tmp_path / f"{layer}.ply"
        code, text = meshlabserver.run(server, "-i", cloud, mesh, "-o", out, "-m", "vq", "-s", script)
        assert code == 0 and meshlabserver.figures(text)["vertices"] == 2562, text
        saved.append(out.read_bytes())
    assert saved[0] != saved[1]


@FULL
@pytest.mark.parametrize("name", ["l-block", "crossed-cylinders"])
def test_creases_of_a_noisy_mesh_are_found_better_than_by_any_curvature(pymeshlab, name):
    """At the default threshold, against the best threshold of each measure of the mesh, found with the truth."""
    surface = models.load_model(name)

    def curves(noise, signals):
        mesh = features.counted(*features.noisy_mesh(surface, 2000, noise), signals)
        truth = features.truth_of(mesh, surface)
        return {measure: features.f1_curve(values, truth) for measure, values in features.measures_of(mesh)}

    assert curves(0, None)["crease measure"][features.DEFAULT] > .9
    for signals in (models.make_cloud(*surface, 50_000, .6), None):
        found = curves(.6, signals)
        ours = found.pop("crease measure")[features.DEFAULT]
        del found["normal counter"]
        assert ours > .8 and ours > .1 + max(max(curve) for curve in found.values())
