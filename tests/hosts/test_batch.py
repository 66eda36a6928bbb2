# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""`neural-mesh batch`: corrupt clouds, killed drivers and workers, limits, the manifest, dask, and wrong usage."""

import collections
import fcntl
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import many_clouds
import programs
from check_mesh import check_mesh
import numpy as np
import psutil
import pytest
from conftest import FULL, ROOT, write_points
from many_clouds import records

TIMEOUT = 120  # seconds, on a busy machine


@pytest.fixture(scope="module")
def command(installed):
    """command(WORD...): starts `neural-mesh batch WORD...`."""
    def start(*words, environment=(), **options):
        return subprocess.Popen([sys.executable, "-m", "neural_mesh", "batch", *map(str, words)], text=True,
                                stderr=subprocess.PIPE,
                                env=dict(os.environ, PYTHONPATH=str(installed), **dict(environment)), **options)
    return start


@pytest.fixture(scope="module")
def batch(command):
    """batch(WORD...): what finished() returns of the command."""
    return lambda *words, **options: finished(command(*words, **options))


def finished(process):
    """(status, what was written to standard error)."""
    _, text = process.communicate(timeout=TIMEOUT)
    assert "Traceback" not in text
    return process.returncode, text


@pytest.fixture(scope="module")
def few(tmp_path_factory):
    """A folder of five good clouds."""
    folder = tmp_path_factory.mktemp("few") / "clouds"
    many_clouds.make(folder, 5)
    return folder


def done(out):
    return [record["output"] for record in records(out) if "result" in record]


def meshes(out):
    return {path.relative_to(out).as_posix(): path.read_bytes() for path in sorted(out.rglob("*.ply"))}


def hidden(out):
    return [path for path in out.rglob(".*")]


def wait_until(condition):
    end = time.monotonic() + TIMEOUT
    while not condition():
        assert time.monotonic() < end
        time.sleep(.02)


def learners(process):
    """The processes that learn, below `process`."""
    try:
        return [child for child in process.children(recursive=True) if "neural_mesh.worker" in child.cmdline()]
    except psutil.NoSuchProcess:
        return []


# --- crashes and kills -----------------------------------------------------------------------------------------------


@FULL
def test_200_clouds_with_corrupt_ones_and_kills(command, batch, tmp_path):
    clouds, out = tmp_path / "clouds", tmp_path / "meshes"
    many_clouds.make(clouds, 200)
    for name, content in many_clouds.CORRUPT.items():
        (clouds / f"{name}.ply").write_bytes(content(np.ones((many_clouds.POINTS, 3))))
    corrupt = {f"{name}.ply" for name in many_clouds.CORRUPT}
    words = (clouds, "--out", out, "--workers", 2, "--files-per-process", 30, *many_clouds.SETTINGS)

    driver = command(*words)
    wait_until(lambda: len(done(out)) >= 40)
    children = learners(psutil.Process(driver.pid))
    driver.kill()
    driver.communicate()
    assert children
    assert not psutil.wait_procs(children, timeout=10)[1], "they end with the driver"
    before = meshes(out)

    driver = command(*words)
    process = psutil.Process(driver.pid)
    killed = 0
    while killed < 3:
        wait_until(lambda: len(learners(process)) == 2)
        time.sleep(random.Random(killed).uniform(.2, 1))
        for child in learners(process)[:1]:
            child.kill()
            killed += 1
    _, text = driver.communicate(timeout=TIMEOUT)
    assert driver.returncode == 1 and "of them done before" in text

    status, text = batch(*words)
    assert status == 1 and f"{len(corrupt)} of " in text
    latest = {record["output"]: record for record in records(out)}
    assert {name for name, record in latest.items() if "error" in record} == corrupt
    assert all(name in text for name in corrupt)
    assert latest["text.ply"]["error"] == "The file cannot be loaded: Header not found."
    assert "signal 11, SIGSEGV" in latest["truncated_header.ply"]["error"]
    assert set(meshes(out)) == {path.name for path in clouds.iterdir()} - corrupt
    assert not hidden(out)
    # Nothing was learned twice but what was in flight, which the manifest does not have.
    assert set(collections.Counter(done(out)).values()) == {1}
    assert set(before) <= set(done(out))
    named = [record for record in records(out) if "signal 9, SIGKILL" in record.get("error", "")]
    assert len(named) <= killed


def test_interrupted_it_ends_and_the_next_start_goes_on(command, batch, few, tmp_path):
    words = (few, "--out", tmp_path, "--workers", 1, *many_clouds.SETTINGS)
    driver = command(*words)
    wait_until(lambda: records(tmp_path))
    children = learners(psutil.Process(driver.pid))
    driver.send_signal(signal.SIGINT)
    _, text = driver.communicate(timeout=TIMEOUT)
    assert driver.returncode == 130 and "left. The same command goes on." in text and "Traceback" not in text
    assert children and not psutil.wait_procs(children, timeout=10)[1] and not hidden(tmp_path)
    before = len(records(tmp_path))
    status, text = batch(*words)
    assert status == 0 and f"5 clouds, {before} of them done before." in text
    assert sorted(done(tmp_path)) == sorted(meshes(tmp_path)) == sorted(path.name for path in few.iterdir())


@FULL
def test_limits_of_time_memory_and_file_size(batch, few, tmp_path):
    cloud = few / "cloud_0000.ply"
    status, text = batch(cloud, "--out", tmp_path, "--time-limit", .3, "target_vertices=60",
                         "settling_signals_per_vertex=100000")
    assert status == 1 and "cloud_0000.ply: It took longer than the limit of 0.3 seconds." in text
    big = write_points(tmp_path / "big.ply", np.random.default_rng(1).normal(size=(4_000_000, 3)))
    status, text = batch(big, cloud, "--out", tmp_path / "out", "--memory-limit", "180M", "--workers", 1,
                         *many_clouds.SETTINGS)
    assert status == 1 and "1 of 2 clouds failed" in text and "enough memory" in text, text
    # As if the disk were full.
    status, text = batch(cloud, "--out", tmp_path, *many_clouds.SETTINGS,
                         preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (3000, 3000)))
    assert status == 1 and "is there space left?" in text, text
    assert set(meshes(tmp_path / "out")) == {cloud.name} and not hidden(tmp_path) and not (tmp_path / cloud.name).exists()


# --- the manifest ----------------------------------------------------------------------------------------------------


def test_only_what_is_missing_or_changed_is_learned(build, batch, few, tmp_path):
    clouds, out = tmp_path / "clouds", tmp_path / "meshes"
    (clouds / "below").mkdir(parents=True)
    for name in ("cloud_0000.ply", "cloud_0001.ply", "below/cloud_0000.ply"):
        shutil.copy(few / Path(name).name, clouds / name)
    (clouds / "notes.md").write_text("not a cloud")

    def learned(*words):
        before = len(records(out))
        status, _ = batch(clouds, "--out", out, *(words or many_clouds.SETTINGS))
        assert status == 0
        return {record["output"] for record in records(out)[before:]}

    names = {"cloud_0000.ply", "cloud_0001.ply", "below/cloud_0000.ply"}
    assert learned() == names == set(meshes(out))
    record = records(out)[0]
    found = check_mesh(out / record["output"])
    assert found["vertices"] == record["result"]["vertices"] == 60 and found["watertight"] and found["quality"]
    assert record["parameters"] == {"target_vertices": 60, "settling_signals_per_vertex": 0}
    assert 0 < record["seconds"] < TIMEOUT and 2**20 < record["peak_memory"] < 2**30
    assert Path(record["input"]).is_absolute() and len(record["warnings"]) == record["result"]["warnings"]
    assert learned(*many_clouds.SETTINGS, "threads=2") == set()
    os.utime(clouds / "cloud_0001.ply", (1, 1))
    (out / "cloud_0000.ply").unlink()
    (out / ".cloud_0000.some-machine-123.part.ply").write_text("of a killed process")
    with (out / "manifest.jsonl").open("ab") as file:
        file.write(b'{"output": "below/cloud_0000.ply", "err')
    assert learned() == {"cloud_0000.ply", "cloud_0001.ply"} and not hidden(out)
    assert learned("target_vertices=50", "settling_signals_per_vertex=0") == names


def test_unusual_names_in_any_locale(batch, few, tmp_path):
    clouds, out = tmp_path / "two words", tmp_path / "meshes"
    clouds.mkdir()
    for name in ("\u00e9t\u00e9 [1].ply", "a=b.ply"):
        shutil.copy(few / "cloud_0000.ply", clouds / name)
    environment = {"LC_ALL": "C"}
    status, text = batch(clouds, "--out", out, *many_clouds.SETTINGS, environment=environment)
    assert status == 0, text
    assert sorted(meshes(out)) == sorted(path.name for path in clouds.iterdir())
    shutil.copy(few / "cloud_0000.ply", os.fsencode(clouds) + b"/\xff.ply")
    status, text = batch(clouds, "--out", out, *many_clouds.SETTINGS, environment=environment)
    assert status == 2 and "whose name is not UTF-8: rename it." in text, text


def test_a_result_that_fails_later_is_removed(batch, few, tmp_path):
    cloud = shutil.copy(few / "cloud_0000.ply", tmp_path)
    assert batch(cloud, "--out", tmp_path / "out", *many_clouds.SETTINGS)[0] == 0
    Path(cloud).write_bytes(b"")
    status, text = batch(cloud, "--out", tmp_path / "out", *many_clouds.SETTINGS)
    assert status == 1 and "cloud_0000.ply: The file cannot be loaded: " in text
    assert not meshes(tmp_path / "out")


# --- workers and dask ------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def alone(batch, few, tmp_path_factory):
    """The meshes of one worker."""
    out = tmp_path_factory.mktemp("alone")
    assert batch(few, "--out", out, "--workers", 1, *many_clouds.SETTINGS)[0] == 0
    return meshes(out)


def test_the_same_bytes_with_any_number_of_workers_and_by_the_other_command(installed, batch, few, alone, tmp_path):
    assert batch(few, "--out", tmp_path, "--workers", 3, "--files-per-process", 2, *many_clouds.SETTINGS)[0] == 0
    assert meshes(tmp_path) == alone
    programs.python(installed, "-m", "neural_mesh", few / "cloud_0003.ply", tmp_path / "one.ply", *many_clouds.SETTINGS)
    assert (tmp_path / "one.ply").read_bytes() == alone["cloud_0003.ply"]


@FULL
def test_dask_with_two_workers_one_of_them_killed(command, few, alone, tmp_path):
    driver = command(few, "--out", tmp_path, "--engine", "dask", "--workers", 2, *many_clouds.SETTINGS)
    process = psutil.Process(driver.pid)
    wait_until(lambda: records(tmp_path) and learners(process))
    learners(process)[0].parent().kill()
    _, text = driver.communicate(timeout=TIMEOUT)
    assert driver.returncode == 0, text
    assert meshes(tmp_path) == alone
    assert sorted(done(tmp_path)) == sorted(alone)


@FULL
def test_the_slurm_job_starts_a_cluster(installed, few, alone, tmp_path):
    """With a shell line as a stand-in for Slurm: srun gives a task one core, unless it is told otherwise itself."""
    folder = tmp_path / "bin"
    folder.mkdir()
    for name, line in (("srun", '[ "$1" = --cpus-per-task=2 ] && shift && exec "$@"'), ("neural-mesh", f'exec {sys.executable} -m neural_mesh "$@"')):
        (folder / name).write_text(f"#!/bin/sh\n{line}\n")
        (folder / name).chmod(0o755)
    environment = dict(os.environ, PYTHONPATH=str(installed), SLURM_CPUS_PER_TASK="2", SLURM_JOB_ID="7",
                       PATH=f"{folder}:{Path(sys.executable).parent}:{os.environ['PATH']}")
    job = programs.run("bash", ROOT / "filter_neuralmesh/python/batch.slurm", few, tmp_path / "out", *many_clouds.SETTINGS,
                       env=environment, timeout=TIMEOUT, cwd=tmp_path, stderr=subprocess.STDOUT)
    assert job.returncode == 0, job.stdout
    assert meshes(tmp_path / "out") == alone


# --- wrong usage -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("words, sentence", [
    ("{few} --out {out} vertices=5", "There is no parameter vertices."),
    ("{few} --out {out} crease_lines=true", "writes the mesh only: leave crease_lines out."),
    ("{few} --out {out} --address localhost:1", "--address is for --engine dask."),
    ("{few} --out {out} --engine dask --workers 2 --address localhost:1", "--workers is for this machine"),
    ("{few} --out {file}/below", "Results cannot be written to {file}/below: Not a directory."),
    ("{few} --out {few}", "would replace the input"),
    ("{few} {other} --out {out}", "would become cloud_0000.ply: rename one"),
    ("{few}/nothing*.ply --out {out}", "There is no file or folder {few}/nothing*.ply."),
    ("{notes} --out {out}", "notes.md: pymeshlab cannot load files of the kind '.md'."),
    ("{linked} --out {out}", "gone.ply cannot be read: No such file or directory."),
    ("{empty} --out {out}", "There are no clouds in {empty}."),
    ("target_vertices=50 --out {out}", "There is no input"),
    ("{few} --out {busy}", "Another batch is writing to {busy}/manifest.jsonl."),
])
def test_wrong_usage_is_one_sentence_before_any_work(batch, few, tmp_path, words, sentence):
    places = {name: tmp_path / name for name in ("out", "other", "empty", "busy", "linked")}
    places.update(few=few, notes=tmp_path / "notes.md", file=tmp_path / "notes.md")
    for name in ("other", "empty", "busy", "linked"):
        places[name].mkdir()
    (places["linked"] / "gone.ply").symlink_to(tmp_path / "nowhere.ply")
    shutil.copy(few / "cloud_0000.ply", places["other"])
    places["notes"].write_text("not a cloud")
    with (places["busy"] / "manifest.jsonl").open("w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        status, text = batch(*words.format(**places).split())
    assert status == 2 and sentence.format(**places) in text, text
    assert not places["out"].exists()


def test_what_the_disk_lacks_is_known_before_any_work(installed, few, tmp_path):
    code = ("import shutil, sys\nshutil.disk_usage = lambda path: shutil._ntuple_diskusage(10**9, 10**9, 3000)\n"
            "from neural_mesh.__main__ import main\nsys.exit(main(sys.argv[1:]))")
    made = programs.python(installed, "-c", code, "batch", few, "--out", tmp_path / "out", *many_clouds.SETTINGS)
    assert made.returncode == 2 and made.stderr.startswith("neural-mesh: The meshes need 1.86e-05 GB"), made.stderr
    assert len(made.stderr.splitlines()) == 1 and not meshes(tmp_path / "out")
