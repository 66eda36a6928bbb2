# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The measuring tools of the experiments, on surfaces of known error. The test `accuracy` compares meshes with the peers'."""

import numpy as np
import pytest

import evaluate
import models
import peers
import shapes

pytestmark = pytest.mark.full

SAMPLES = 30_000


# --- the tools ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", models.CODE_MODELS)
def test_models_made_in_code_have_the_topology_they_claim(name):
    vertices, faces = models.load_model(name)
    found = evaluate.evaluate(vertices, faces, evaluate.Truth(vertices, faces, 1000))
    model = models.MODELS[name]
    assert found["manifold"] and found["boundary_edges"] == 0
    assert (found["genus"], found["components"]) == (model.genus, model.components)
    corners = vertices[faces]
    volume = np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
    assert volume > 0, "the faces look inwards"


def test_measures_on_concentric_spheres():
    truth = evaluate.Truth(*shapes.sphere(1.0), 20_000)
    found = evaluate.evaluate(*shapes.sphere(1.01), truth)
    expected = 100 * 0.01 / (2 * np.sqrt(3))  # % of the diagonal
    for measure in ("forward_rms", "forward_max", "backward_rms", "backward_max"):
        assert found[measure] == pytest.approx(expected, rel=0.02), measure
    assert found["normal_error"] < 1 and not found["inside_out"]
    assert found["self_intersecting_faces"] == 0
    assert found == evaluate.evaluate(*shapes.sphere(1.01), truth), "the same mesh gives other figures"


def test_measures_see_a_web_a_hole_and_a_wrong_side():
    vertices, faces = shapes.torus()
    truth = evaluate.Truth(vertices, faces, 20_000)
    disc = np.array([[0.0, 0, 0], [0.6, 0, 0], [0, 0.6, 0], [-0.6, 0, 0], [0, -0.6, 0]])
    web = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]]) + len(vertices)
    webbed = evaluate.evaluate(np.vstack([vertices, disc]), np.vstack([faces, web]), truth)
    assert webbed["forward_max"] < 0.01
    assert webbed["backward_max"] == pytest.approx(100 * 0.65 / truth.diagonal, rel=0.05)
    holed = evaluate.evaluate(vertices, faces[len(faces) // 8:], truth)
    assert holed["boundary_edges"] > 0 and holed["forward_max"] > 100 * holed["backward_max"]
    assert evaluate.evaluate(vertices, faces[:, ::-1], truth)["inside_out"]


def test_clouds_are_uniform_noisy_as_asked_and_repeatable():
    vertices, faces = shapes.sphere(1.0)
    cloud = models.make_cloud(vertices, faces, SAMPLES, noise=0.5, seed=3)
    assert (cloud == models.make_cloud(vertices, faces, SAMPLES, noise=0.5, seed=3)).all()
    assert not (cloud == models.make_cloud(vertices, faces, SAMPLES, noise=0.5, seed=4)).any()
    off = np.linalg.norm(cloud, axis=1) - 1
    assert off.std() == pytest.approx(0.005 * 2 * np.sqrt(3), rel=0.03)
    # A sphere's area above height z is proportional to 1 - z (Archimedes).
    clean = models.make_cloud(vertices, faces, SAMPLES, seed=5)
    assert np.mean(clean[:, 2] > 0.5) == pytest.approx(0.25, abs=0.01)


def test_a_peer_that_crashes_is_reported_with_a_sentence(tmp_path):
    with pytest.raises(peers.PeerError, match="ended with code"):
        peers.run("poisson", tmp_path / "there_is_none.ply", tmp_path, [500])
