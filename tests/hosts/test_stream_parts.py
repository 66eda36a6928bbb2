# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The parts of `neural-mesh stream`: readers against the points that were written, and the even sample."""

import numpy as np
import pytest
from stream_clouds import FILES, POINTS, bench


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
