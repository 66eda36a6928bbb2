#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Common methods in pymeshlab that make a mesh of N vertices from a cloud, and the neural mesh.

Each runs in a separate process, so that peak memory is measured per method and a crash is reported as a result:

    peers.py METHOD CLOUD.ply FOLDER vertices=500,2000,10000 [plugin=LIBRARY.so] [key=value...]

writes FOLDER/N.ply for every N and prints one JSON object {N: {seconds, cpu_seconds, peak_mb}}. Reading and writing
files is not timed.
"""

import argparse
import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pymeshlab

TOLERANCE = 0.01  # of the number of vertices


class PeerError(RuntimeError):
    """A method gave no mesh; the message says why."""


def reconstruct_poisson(meshes, _count, **settings):
    """Compute Normals and Screened Poisson of depth 8, all else MeshLab's defaults but for settings."""
    meshes.compute_normal_for_point_clouds()
    meshes.generate_surface_reconstruction_screened_poisson(depth=8, **settings)


def reconstruct_poisson_smooth(meshes, _count, **settings):
    """The same, tuned for noise: normals from 30 neighbours, 10 samples per node, small components removed."""
    meshes.compute_normal_for_point_clouds(k=30)
    meshes.generate_surface_reconstruction_screened_poisson(depth=8, samplespernode=10, **settings)
    meshes.meshing_remove_connected_component_by_diameter(mincomponentdiag=pymeshlab.PercentageValue(5))


def poisson_of_normals(meshes, **settings):
    """Screened Poisson from the normals there are, without components below a quarter of the diagonal."""
    meshes.generate_surface_reconstruction_screened_poisson(**settings)
    meshes.meshing_remove_connected_component_by_diameter(mincomponentdiag=pymeshlab.PercentageValue(25))


def reconstruct_poisson_tuned(meshes, _count, **settings):
    """The tuned chain with one pair of depth and samplespernode, for a cloud whose normals point to the right side.

    Normals from 30 neighbours are part of its time. They are thrown away: no filter turns them as the truth does.
    """
    meshes.generate_copy_of_current_mesh()
    meshes.compute_normal_for_point_clouds(k=30)
    meshes.delete_current_mesh()
    meshes.set_current_mesh(0)
    poisson_of_normals(meshes, **settings)


def reconstruct_ball_pivoting(meshes, count):
    """Poisson-disk thinning to four times the vertices, normals, Ball Pivoting, small holes closed.

    Without thinning, Ball Pivoting takes minutes on a random cloud and leaves thousands of holes.
    """
    meshes.generate_sampling_poisson_disk(samplenum=4 * count, subsample=True)
    meshes.compute_normal_for_point_clouds()
    meshes.generate_surface_reconstruction_ball_pivoting()
    meshes.meshing_repair_non_manifold_edges()
    meshes.meshing_close_holes(maxholesize=100)
    # Rebuilt from its arrays, as by saving and loading: with the flags that Ball Pivoting leaves, Quadric Edge
    # Collapse often collapses nothing.
    mesh = meshes.current_mesh()
    meshes.add_mesh(pymeshlab.Mesh(mesh.vertex_matrix(), mesh.face_matrix()))


# name: (reconstruction, whether it depends on the number of vertices). The last needs a cloud with normals.
PEERS = {
    "poisson": (reconstruct_poisson, False),
    "poisson-smooth": (reconstruct_poisson_smooth, False),
    "ball-pivoting": (reconstruct_ball_pivoting, True),
    "poisson-tuned": (reconstruct_poisson_tuned, False),
}


class Clock:
    """Wall time and processor time since its construction, in seconds."""

    def __init__(self):
        self.wall, self.cpu = time.perf_counter(), time.process_time()

    def read(self):
        return time.perf_counter() - self.wall, time.process_time() - self.cpu


def decimated(meshes, count):
    """Quadric Edge Collapse of the current mesh, in a new layer, to count vertices within 1 %.

    The filter counts faces, so the faces to ask for follow from the Euler characteristic. Where the collapse itself
    changes that, it collapses further, or starts again with more faces if there are too few vertices. Only the
    work that led to the result is timed.
    """
    source = meshes.current_mesh_id()
    meshes.generate_copy_of_current_mesh()
    # Points that no face uses would be counted here, but the collapse removes them.
    meshes.meshing_remove_unreferenced_vertices()
    seconds = (0.0, 0.0)
    if meshes.current_mesh().vertex_number() <= count:
        return seconds
    for _ in range(6):
        mesh = meshes.current_mesh()
        wanted = mesh.face_number() + 2 * (count - mesh.vertex_number())
        clock = Clock()
        meshes.meshing_decimation_quadric_edge_collapse(targetfacenum=max(4, wanted))
        seconds = tuple(a + b for a, b in zip(seconds, clock.read()))
        missing = count - meshes.current_mesh().vertex_number()
        if abs(missing) <= TOLERANCE * count:
            break
        if missing > 0:
            larger = meshes.current_mesh().face_number() + 3 * missing
            meshes.delete_current_mesh()
            meshes.set_current_mesh(source)
            meshes.generate_copy_of_current_mesh()
            meshes.meshing_remove_unreferenced_vertices()
            clock = Clock()
            meshes.meshing_decimation_quadric_edge_collapse(targetfacenum=larger)
            seconds = clock.read()
            if abs(meshes.current_mesh().vertex_number() - count) <= TOLERANCE * count:
                break
    return seconds


def _peak_mb():
    """Peak memory of this process. getrusage() would include the parent's before exec."""
    return int(re.search(r"VmHWM:\s*(\d+)", Path("/proc/self/status").read_text()).group(1)) / 1024


def run_peer(name, cloud, folder, counts, settings):
    """A method of PEERS. settings: parameters of Screened Poisson and values as text."""
    reconstruct, by_count = PEERS[name]
    settings = {key: _typed(value) for key, value in settings.items()}
    meshes = pymeshlab.MeshSet(verbose=False)
    before = _peak_mb()
    meshes.load_new_mesh(str(cloud))
    full, results = None, {}
    for count in sorted(counts):
        if full is None or by_count:
            meshes.set_current_mesh(0)
            clock = Clock()
            reconstruct(meshes, count, **settings)
            base, full = clock.read(), meshes.current_mesh_id()
            if meshes.current_mesh().face_number() == 0:
                raise PeerError(f"The method {name} gave no faces for {cloud}.")
        meshes.set_current_mesh(full)
        extra = decimated(meshes, count)
        meshes.save_current_mesh(str(folder / f"{count}.ply"), save_vertex_normal=False, save_vertex_color=False)
        meshes.delete_current_mesh()
        results[count] = {"seconds": base[0] + extra[0], "cpu_seconds": base[1] + extra[1],
                          "peak_mb": _peak_mb() - before}
    return results


def run_plugin(cloud, folder, counts, plugin, settings):
    """The neural mesh, through the filter. settings: parameter ids and values as text."""
    pymeshlab.load_plugin(plugin)
    results = {}
    for count in counts:
        meshes = pymeshlab.MeshSet(verbose=False)
        before = _peak_mb()
        meshes.load_new_mesh(str(cloud))
        clock = Clock()
        report = meshes.apply_filter("generate_surface_reconstruction_neural_mesh", target_vertices=count,
                                     **{key: _typed(value) for key, value in settings.items()})
        seconds, cpu = clock.read()
        meshes.save_current_mesh(str(folder / f"{count}.ply"), save_vertex_quality=True, save_vertex_color=False)
        results[count] = {"seconds": seconds, "cpu_seconds": cpu, "peak_mb": _peak_mb() - before, "report": report}
    return results


def _typed(text):
    if text.lower() in ("true", "false"):
        return text.lower() == "true"
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            pass
    return text


def run(method, cloud, folder, counts, plugin=None, command=None, settings=None, timeout=300, environment=None):
    """Runs one method on the file cloud for all counts, in other processes. Returns {count: times and memory}.

    method: a name of PEERS, or "neural" with a plugin, or any with a command, which is called with CLOUD OUT
    target_vertices=N and prints its times as JSON. settings: parameters of ours or of Screened Poisson. environment: more
    variables of the processes. Raises PeerError if a process fails or takes longer than timeout seconds.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    if command:
        return {n: json.loads(_output_of([*command, str(cloud), str(folder / f"{n}.ply"), f"target_vertices={n}"], timeout))
                for n in counts}
    extra = [f"{key}={value}" for key, value in (settings or {}).items()]
    words = [sys.executable, str(Path(__file__).resolve()), method, str(cloud), str(folder)]
    # A peer's runs share one reconstruction; ours share nothing, so each has a process.
    jobs = [[n] for n in counts] if plugin else [counts]
    results = {}
    for job in jobs:
        more = [f"plugin={plugin}", *extra] if plugin else extra
        output = _output_of([*words, "vertices=" + ",".join(map(str, job)), *more], timeout, environment)
        results.update((int(n), figures) for n, figures in json.loads(output.strip().splitlines()[-1]).items())
    return results


def _output_of(words, timeout, environment=None):
    """What a process prints, which is ended with those that it started after the timeout."""
    with subprocess.Popen(words, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True,
                          env={**os.environ, **(environment or {})}) as process:
        try:
            output, errors = process.communicate(timeout=timeout)
        except BaseException as error:
            os.killpg(process.pid, signal.SIGKILL)
            if isinstance(error, subprocess.TimeoutExpired):
                raise PeerError(f"{' '.join(words[:3])} took longer than {timeout} seconds.") from None
            raise
    if process.returncode != 0:
        raise PeerError(f"{' '.join(words[:3])} ended with code {process.returncode}: "
                        f"{(errors.strip() or output.strip())[-500:]}")
    return output


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("method", choices=[*PEERS, "neural"])
    parser.add_argument("cloud")
    parser.add_argument("folder", type=Path)
    parser.add_argument("settings", nargs="+", metavar="key=value",
                        help="vertices=..., plugin=..., parameters of the method")
    options = parser.parse_args(arguments)
    settings = dict(word.split("=", 1) for word in options.settings)
    counts = [int(n) for n in settings.pop("vertices").split(",")]
    plugin = settings.pop("plugin", None)
    if options.method == "neural":
        results = run_plugin(options.cloud, options.folder, counts, plugin, settings)
    else:
        results = run_peer(options.method, options.cloud, options.folder, counts, settings)
    print(json.dumps(results))


if __name__ == "__main__":
    main(sys.argv[1:])
