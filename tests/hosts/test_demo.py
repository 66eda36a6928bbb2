# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""demo.py, with and without a cloud that MeshLab reads."""

import subprocess
from pathlib import Path

from check_mesh import check_mesh

DEMO = Path(__file__).with_name("demo.py")


def demo(build, *words):
    """The finished process, run by Debian's Python as in run.sh."""
    return subprocess.run(["/usr/bin/python3", str(DEMO), "--build", str(build), *map(str, words)],
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False, timeout=300)


def test_a_cloud_becomes_a_mesh_and_a_picture(build, model, tmp_path):
    done = demo(build, "--cloud", model("sphere")[0], "--vertices", 500, "--out", tmp_path / "out" / "ball.ply")
    assert done.returncode == 0, done.stdout + done.stderr
    assert check_mesh(tmp_path / "out" / "ball.ply")["vertices"] == 500
    assert (tmp_path / "out" / "ball.png").exists()
    assert "996, closed, genus 0" in done.stdout


def test_a_format_that_meshlab_cannot_read_is_reported(build, tmp_path):
    (tmp_path / "cloud.las").write_text("LASF")
    done = demo(build, "--cloud", tmp_path / "cloud.las", "--vertices", 500, "--out", tmp_path / "ball.ply")
    assert done.returncode == 1 and "made no mesh of" in done.stderr and "Traceback" not in done.stderr
