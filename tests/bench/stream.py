#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""`neural-mesh stream` on a cloud made on the spot: memory, seconds, and the error beside learning all points.

    stream.py --plugin LIBRARY.so [--points 20] [--vertices 10000] [--format ply|las|laz|xyz] [--memory 2GB]
              [--all 10] [--seed 1] [--folder DIR] [--out FILE.json]

--points: millions. Prints what the command prints, the largest memory of all its processes together, and its seconds.
With --all another cloud of so many million points of the same surface and noise is learned whole, and the RMS distances
of a million further points to both meshes are compared, with noise and without.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import numpy as np
import psutil

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "hosts"))

import python_site  # noqa: E402

NOISE = .001  # of the radius: .03 % of the diagonal
CHUNK = 1_000_000
ORIGIN, RADIUS = np.array([451234.0, 5801234.0, 312.0]), 100.0  # of LAS files: metres, as in UTM


def surface(count, seed, noise=NOISE):
    """Points of a ball with bumps, even over directions, with noise along them."""
    random = np.random.default_rng(seed)
    directions = random.normal(size=(count, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    x, y, z = directions.T
    radius = 1 + .1 * np.sin(5 * x) * np.sin(4 * y + 1) * np.sin(6 * z) + noise * random.normal(size=count)
    return directions * radius[:, None]


def parts(count, seed):
    for first in range(0, count, CHUNK):
        yield surface(min(CHUNK, count - first), (seed, first))


def write_cloud(path, count, seed=1):
    """A file of so many points, by its ending: PLY of floats, LAS or LAZ of format 0, lines of text."""
    if path.suffix in (".las", ".laz"):
        import laspy
        header = laspy.LasHeader(point_format=0, version="1.2")
        header.scales, header.offsets = [.0001] * 3, ORIGIN
        with laspy.open(str(path), mode="w", header=header) as file:
            for points in parts(count, seed):
                record = laspy.ScaleAwarePointRecord.zeros(len(points), header=header)
                record.x, record.y, record.z = (points * RADIUS + ORIGIN).T
                file.write_points(record)
        return
    with path.open("wb") as file:
        if path.suffix == ".ply":
            header = ["ply", "format binary_little_endian 1.0", f"element vertex {count}",
                      *(f"property float {axis}" for axis in "xyz"), "end_header", ""]
            file.write("\n".join(header).encode())
        for points in parts(count, seed):
            if path.suffix == ".ply":
                points.astype("<f4").tofile(file)
            else:
                np.savetxt(file, points, "%.7g")


def memory_of_group(group):
    """Bytes in memory of all processes of a process group together.

    A page that several of them share counts once: each has its part of it (pss). Sums of resident sets count it in
    each, so that a process that has just forked seems twice its size.
    """
    total = 0
    for process in psutil.process_iter():
        try:
            if os.getpgid(process.pid) == group:
                total += process.memory_full_info().pss
        except (psutil.NoSuchProcess, ProcessLookupError):  # it has ended
            pass
    return total


def run_watched(command, environment):
    """Runs the command in a process group of its own. Returns (output, seconds, largest memory of the group)."""
    started = time.monotonic()
    child = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment, start_new_session=True)
    peak, done = [0], threading.Event()

    def watch():
        while not done.wait(.05):
            peak[0] = max(peak[0], memory_of_group(child.pid))

    watcher = threading.Thread(target=watch)
    watcher.start()
    output = child.communicate()[0]
    done.set()
    watcher.join()
    if child.returncode:
        raise SystemExit(f"{command} ended with {child.returncode}")
    return output, time.monotonic() - started, peak[0]


def compare(folder, streamed, is_las, options):
    """RMS distances of the same million points to the streamed mesh and to that of all points, in radii."""
    import neural_mesh
    import pymeshlab
    whole = folder / "all.ply"
    write_cloud(whole, int(options.all * 1e6), options.seed + 100)
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.load_new_mesh(str(whole))
    meshes.apply_filter(neural_mesh.FILTER, target_vertices=options.vertices)
    rows = {}
    for name, noise in (("points", NOISE), ("points without noise", 0)):
        points = surface(CHUNK, options.seed + 200, noise)
        rows[name] = []
        for mesh in (streamed, None):
            if mesh:
                meshes.load_new_mesh(str(mesh))
                if is_las:
                    meshes.add_mesh(pymeshlab.Mesh((meshes.current_mesh().vertex_matrix() - ORIGIN) / RADIUS,
                                                   meshes.current_mesh().face_matrix()))
            else:
                meshes.set_current_mesh(1)
            surface_id = meshes.current_mesh_id()
            meshes.add_mesh(pymeshlab.Mesh(points))
            rows[name].append(meshes.get_hausdorff_distance(
                sampledmesh=meshes.current_mesh_id(), targetmesh=surface_id, samplevert=True, samplenum=CHUNK,
                maxdist=pymeshlab.PureValue(10))["RMS"])
        print(f"  RMS of {name}: streamed {rows[name][0]:.6f}, learned from all of {options.all:g} million "
              f"{rows[name][1]:.6f}, {100 * (rows[name][0] / rows[name][1] - 1):+.2f} %")
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--plugin", required=True)
    parser.add_argument("--points", type=float, default=20, help="millions")
    parser.add_argument("--vertices", type=int, default=10000)
    parser.add_argument("--format", default="ply", choices=("ply", "las", "laz", "xyz"))
    parser.add_argument("--memory", default="2GB")
    parser.add_argument("--all", type=float, help="millions")
    parser.add_argument("--seed", type=int, default=1, help="of the cloud's noise and directions")
    parser.add_argument("--folder", type=Path, help="where the clouds are made; default: the system's temporary folder")
    parser.add_argument("--out", type=Path)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(dir=options.folder) as name:
        folder = Path(name)
        sys.path.insert(0, str(python_site.make(folder / "site", options.plugin)))
        cloud, mesh = folder / f"cloud.{options.format}", folder / "mesh.ply"
        started = time.monotonic()
        write_cloud(cloud, int(options.points * 1e6), options.seed)
        print(f"{options.points:g} million points, {cloud.stat().st_size / 1e9:.1f} GB, made in "
              f"{time.monotonic() - started:.0f} s; {options.vertices:,} vertices", flush=True)
        output, seconds, memory = run_watched(
            [sys.executable, "-m", "neural_mesh", "stream", str(cloud), str(mesh), "--memory", options.memory,
             f"target_vertices={options.vertices}"], dict(os.environ, PYTHONPATH=sys.path[0]))
        print("  " + output.strip().replace(str(folder) + "/", "").replace("\n", "\n  "))
        print(f"  {seconds:.1f} s in all; largest memory of all processes {memory / 1e9:.2f} GB", flush=True)
        table = {"seconds": seconds, "memory": memory, "output": output}
        cloud.unlink()
        if options.all:
            table["rms"] = compare(folder, mesh, options.format in ("las", "laz"), options)
    if options.out:
        options.out.write_text(json.dumps(table, indent=1) + "\n")


if __name__ == "__main__":
    main()
