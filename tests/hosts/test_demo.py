# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""demo.py with clouds of formats that vcglib alone can and cannot read."""

import subprocess
from pathlib import Path

import meshlabserver
import models
import pytest
from conftest import few_of

DEMO = Path(__file__).with_name("demo.py")


def demo(build, *words):
    """The finished process, run by Debian's Python as in run.sh."""
    return subprocess.run(["/usr/bin/python3", str(DEMO), "--build", str(build), *map(str, words)],
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False, timeout=300)


@pytest.fixture(scope="module")
def points():
    return models.make_cloud(*models.load_model("sphere"), 3000)


@pytest.fixture(params=few_of(["ply", "xyz"], ["ply"]))
def cloud(request, points, tmp_path):
    path = tmp_path / f"ball.{request.param}"
    if request.param == "ply":
        models.save_ply(path, points)
    else:
        path.write_text("".join(f"{x:.6f} {y:.6f} {z:.6f}\n" for x, y, z in points))
    return path


def test_a_cloud_in_any_format_of_meshlab_becomes_a_mesh(build, cloud, tmp_path):
    done = demo(build, "--cloud", cloud, "--vertices", 500, "--out", tmp_path / "out" / "ball.ply")
    assert done.returncode == 0, done.stdout + done.stderr
    assert meshlabserver.check_mesh(build, tmp_path / "out" / "ball.ply")["vertices"] == 500
    assert (tmp_path / "out" / "ball.png").exists()
    assert "996, closed, genus 0" in done.stdout
    assert ("% back" if cloud.suffix == ".ply" else "the distance back is not measured") in done.stdout


def test_a_format_that_meshlab_cannot_read_is_reported(build, tmp_path):
    (tmp_path / "cloud.las").write_text("LASF")
    done = demo(build, "--cloud", tmp_path / "cloud.las", "--vertices", 500, "--out", tmp_path / "ball.ply")
    assert done.returncode == 1 and "made no mesh of" in done.stderr and "Traceback" not in done.stderr
