# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""`neural-mesh batch` over many small clouds, one in a hundred corrupt. Prints how many meshes come out, what is named,
what kills of the driver and of workers cost, the memory of a worker, and the time beside a loop over the same files.

batch.py --site SITE [--count 2000] [--out FOLDER]

SITE: a folder into which pip has installed the wheel (pip install --no-deps --target SITE dist/neural_mesh-*.whl)."""

import argparse
import collections
import os
import random
import shutil
import subprocess
import sys
import time
from pathlib import Path

import psutil

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "hosts"))

import many_clouds  # noqa: E402
from many_clouds import records  # noqa: E402

# What users write without this package, with what their results need: a loop in one process.
LOOP = """
import sys, pymeshlab, neural_mesh
from neural_mesh.parameters import settings_of
folder, out = sys.argv[1:3]
import pathlib
for cloud in sorted(pathlib.Path(folder).glob("*.ply")):
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.load_new_mesh(str(cloud))
    meshes.apply_filter(neural_mesh.FILTER, threads=1, **settings_of(sys.argv[3:]))
    meshes.save_current_mesh(f"{out}/{cloud.name}", save_vertex_quality=True)
"""
KILLS_OF_DRIVER = 2
SECONDS_BETWEEN_KILLS = (1, 8)  # of workers


class Measure:
    def __init__(self, site, folder):
        self.folder = folder
        self.environment = dict(os.environ, PYTHONPATH=str(site))
        self.random = random.Random(1)

    def start(self, clouds, out, *words):
        return subprocess.Popen([sys.executable, "-m", "neural_mesh", "batch", str(clouds), "--out", str(out), *words,
                                 *many_clouds.SETTINGS], env=self.environment, stderr=subprocess.DEVNULL)

    def run(self, clouds, out, *words):
        """(status, processor time in seconds) of a batch and its workers."""
        before = os.times()
        status = self.start(clouds, out, *words).wait()
        after = os.times()
        return status, after.children_user + after.children_system - before.children_user - before.children_system

    def kills(self, clouds, corrupt):
        out = self.folder / "killed"
        killed_workers = killed_drivers = starts = 0
        count = len(list(clouds.iterdir()))
        while True:
            driver = self.start(clouds, out)
            starts += 1
            stop_at = len(records(out)) + self.random.uniform(.2, .4) * count
            while driver.poll() is None and killed_drivers < KILLS_OF_DRIVER:
                time.sleep(self.random.uniform(*SECONDS_BETWEEN_KILLS))
                if len(records(out)) > stop_at:
                    driver.kill()
                    driver.wait()
                    killed_drivers += 1
                elif kill_a_worker(driver.pid, self.random):
                    killed_workers += 1
            status = driver.wait()
            latest = {record["output"]: record for record in records(out)}
            failed = {name for name, record in latest.items() if "error" in record}
            if status == bool(corrupt) and len(latest) == count and failed <= corrupt:
                break
        times = collections.Counter(record["output"] for record in records(out) if "result" in record)
        print(f"kills: {killed_drivers} of the driver, {killed_workers} of workers, {starts} starts; {len(times)} "
              f"meshes, {len(failed)} named, of them {len(failed & corrupt)} of {len(corrupt)} corrupt; at most "
              f"{max(times.values())} line for a mesh", flush=True)

    def memory(self, clouds):
        """Growth of a process over the second to the last but one of the clouds, all good."""
        out = self.folder / "memory"
        self.run(clouds, out, "--workers", "1", "--files-per-process", "1000000")
        peaks = [record["peak_memory"] / 2**20 for record in records(out)]
        early, late = (sorted(part)[len(part) // 2] for part in (peaks[10:60], peaks[950:1000]))
        print(f"memory of a worker: median peak {early:.2f} MB over clouds 10 to 60, {late:.2f} MB over 950 to 1000: "
              f"{100 * (late / early - 1):+.2f} %", flush=True)

    def overhead(self, clouds):
        """In processor time, which other processes disturb least, in alternating pairs."""
        ratios = []
        for turn in range(3):
            out = self.folder / f"loop{turn}"
            out.mkdir()
            before = os.times()
            subprocess.run([sys.executable, "-c", LOOP, str(clouds), str(out), *many_clouds.SETTINGS], check=True,
                           env=self.environment, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
            after = os.times()
            loop = after.children_user + after.children_system - before.children_user - before.children_system
            # A single worker would otherwise use a thread per core, which costs 5 % more processor time.
            status, batch = self.run(clouds, self.folder / f"batch{turn}", "--workers", "1", "threads=1")
            assert status == 0
            ratios.append(batch / loop)
            print(f"processor time: loop {loop:.1f} s, batch {batch:.1f} s, ratio {ratios[-1]:.3f}", flush=True)


def kill_a_worker(driver, generator):
    try:
        children = psutil.Process(driver).children()
        generator.choice(children).kill()
    except (psutil.NoSuchProcess, IndexError):
        return False
    return True


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--site", type=Path, required=True)
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--out", type=Path, default=Path("build/batch"))
    given = parser.parse_args()
    shutil.rmtree(given.out, ignore_errors=True)
    clouds = given.out / "clouds"
    corrupt = many_clouds.make(clouds, given.count)
    measure = Measure(given.site.resolve(), given.out)

    start = time.monotonic()
    status, processor = measure.run(clouds, given.out / "meshes")
    made = {path.name for path in (given.out / "meshes").glob("*.ply")}
    named = {record["output"] for record in records(given.out / "meshes") if "error" in record}
    print(f"{given.count} clouds, {len(corrupt)} corrupt: {len(made)} meshes, {len(named & corrupt)} corrupt and "
          f"{len(named - corrupt)} others named, status {status}, {time.monotonic() - start:.0f} s, processor time "
          f"{processor:.0f} s", flush=True)
    measure.kills(clouds, corrupt)
    good = given.out / "good"
    many_clouds.make(good, 1000)
    for i, name in enumerate(sorted(path.name for path in good.iterdir())):
        if name in corrupt:
            shutil.copy(good / "cloud_0000.ply", good / name)
    measure.memory(good)
    for path in sorted(good.iterdir())[200:]:
        path.unlink()
    measure.overhead(good)


if __name__ == "__main__":
    main()
