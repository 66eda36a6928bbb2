# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The distances of points from a mesh, in the library, against a loop over all faces in double precision."""

import numpy as np
import pytest
from library_clouds import directions, grid

CORNERS, FACES = grid(12)
# Near the faces, beyond their boundary, and so far away that the nearest face is not clear in single precision.
POINTS = np.concatenate([CORNERS.mean(axis=0) + reach * directions(200, 3) for reach in (.05, .5, 3, 1e3, 1e5, 1e12)])
FAR_AWAY = np.array([451234., 5801234., 312.])


def to_segments(points, ends, others):
    along = others - ends
    squares = np.maximum((along * along).sum(axis=-1), 1e-300)
    part = np.clip(((points - ends) * along).sum(axis=-1) / squares, 0, 1)
    return np.linalg.norm(points - ends - part[..., None] * along, axis=-1)


def slowly(corners, faces, points):
    """The distances from the nearest of all faces, each of which is its plane's part between its edges."""
    a, b, c = (corners[faces[:, k]] for k in range(3))
    points = points[:, None]
    edges = ((a, b), (b, c), (c, a))
    least = np.minimum.reduce([to_segments(points, *edge) for edge in edges])
    normal = np.cross(b - a, c - a)
    area = np.linalg.norm(normal, axis=1)
    normal /= np.maximum(area, 1e-300)[:, None]
    above = np.logical_and.reduce([(np.cross(to - start, points - start) * normal).sum(axis=2) > 0 for start, to in edges])
    height = np.abs(((points - a) * normal).sum(axis=2))
    return np.where(above & (area > 0), height, least).min(axis=1)


@pytest.fixture
def distances(site):
    """distances(points, corners, faces, threads) -> an array."""
    from neural_mesh.library import COUNTERS, Task

    def measure(points, corners=CORNERS, faces=FACES, threads=1):
        with Task(COUNTERS) as task:
            task.set("threads", threads)
            task.set_arrays("mesh", corners, faces)
            return task.distances(points)
    return measure


@pytest.mark.parametrize("place, unit", [(0, 1), (FAR_AWAY, 1), (0, 1e30), (-1e-9, 1e-12)])
def test_distances_are_those_of_all_faces(distances, place, unit):
    found = distances(POINTS * unit + place, CORNERS * unit + place)
    rounding = 1e-15 * np.abs(place).max()
    assert np.allclose(found, slowly(CORNERS, FACES, POINTS) * unit, rtol=2e-7, atol=1e-9 * unit + 4 * rounding)


def test_faces_may_be_any_triangles(distances):
    """Faces that cross, a face given twice, one without area, and a vertex that is not used and not finite."""
    random = np.random.default_rng(5)
    corners = np.vstack([random.random((30, 3)), [[np.nan, 0, np.inf]]])
    faces = np.vstack([random.integers(0, 30, (20, 3)), [[0, 1, 2], [0, 1, 2], [7, 7, 7], [3, 4, 4]]])
    assert np.allclose(distances(POINTS, corners, faces), slowly(corners, faces, POINTS), rtol=2e-7, atol=1e-9)


def test_points_of_many_blocks_in_any_layout(distances):
    """The library takes 524,288 points at a time."""
    points = np.tile(POINTS, (450, 1))
    alone = distances(points)
    assert np.array_equal(alone, np.tile(distances(POINTS), 450))
    assert np.array_equal(alone, distances(np.asfortranarray(points)[:, ::-1][:, ::-1], threads=3))
    assert np.array_equal(distances(POINTS.astype("f4")), distances(POINTS.astype("f4").astype(float)))


def test_points_that_are_not_finite_have_no_distance(distances):
    points = POINTS[:100].copy()
    points[::10, 1] = np.nan
    points[5, 2], points[6, 0] = np.inf, -np.inf
    found = distances(points)
    lost = ~np.isfinite(points).all(axis=1)
    assert lost.sum() == 12 and np.isnan(found[lost]).all() and np.array_equal(found[~lost], distances(points[~lost]))
    assert len(distances(points[:0])) == 0


def test_another_mesh_gives_other_distances(site):
    from neural_mesh.library import COUNTERS, Task
    with Task(COUNTERS) as task:
        for place in (0, 5):
            task.set_arrays("mesh", CORNERS + place, FACES)
            assert np.allclose(task.distances(CORNERS[:5] + place + (0, 0, 100)), 100, rtol=.1)


@pytest.mark.parametrize("corners, faces, sentence", [
    (CORNERS, FACES[:0], "The mesh has no faces to measure distances from."),
    (CORNERS, FACES + 5, "Face "),
    (np.where(CORNERS == CORNERS.max(), np.nan, CORNERS), FACES, "of the given mesh has coordinates that are not finite"),
    (CORNERS * 0, FACES, "The mesh is too large or too small for double precision: scale it first."),
    (CORNERS * 1e200, FACES, "The mesh is too large or too small"),
])
def test_a_mesh_that_cannot_be_measured_is_a_sentence(distances, corners, faces, sentence):
    with pytest.raises(ValueError, match=sentence):
        distances(POINTS, corners, faces)
