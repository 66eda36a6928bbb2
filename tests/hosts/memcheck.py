#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The plugin in meshlabserver 2020.09 under valgrind's memcheck, on a small cloud:

    /usr/bin/python3 tests/hosts/memcheck.py [--build DIR]

Prints each error and leak whose stack passes through the plugin, and ends with 1 if there is one. Errors of the host,
Qt and the OpenGL driver alone are only counted. Takes half a minute on an idle machine. Needs the Debian packages
valgrind and xvfb.
"""

import argparse
import math
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import meshlabserver

ROOT = Path(__file__).resolve().parents[2]
PLUGIN = "libfilter_neuralmesh.so"


TARGET = 50


def write_cloud(path, count=25 * TARGET):
    """Writes points on a sphere as a text file. A closed surface with this many points per vertex runs all of the
    filter: a sheet would be learned without smoothing, fewer points without vertices beyond the target."""
    points = []
    for i in range(count):
        z, turn = 1 - (2 * i + 1) / count, 2.399963229728653 * i
        rim = math.sqrt(1 - z * z)
        points.append((rim * math.cos(turn), rim * math.sin(turn), z))
    path.write_text("\n".join(["ply", "format ascii 1.0", f"element vertex {len(points)}", "property float x",
                               "property float y", "property float z", "end_header",
                               *(f"{x} {y} {z}" for x, y, z in points)]) + "\n")
    return path


def checked_run(build, folder, report, **parameters):
    """Runs the filter under memcheck; returns what meshlabserver printed."""
    server = meshlabserver.make_folder(folder / "meshlab", meshlabserver.plugin_path(build))
    script = meshlabserver.write_script(build, folder / "script.mlx", **parameters)
    # The other software drivers compile shaders at run time, which takes minutes under memcheck.
    variables = dict(meshlabserver.environment(server), DISPLAY=meshlabserver.display(), GALLIUM_DRIVER="softpipe")
    command = ["valgrind", "--tool=memcheck", "--leak-check=full", "--show-leak-kinds=definite", "--num-callers=40",
               "--xml=yes", f"--xml-file={report}", str(server / "meshlabserver"),
               "-i", str(write_cloud(folder / "cloud.ply")), "-o", str(folder / "out.ply"), "-m", "vq", "vc", "-s", str(script)]
    done = subprocess.run(command, env=variables, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          errors="replace", check=False)
    if "stop_reason=" not in done.stdout or not (folder / "out.ply").exists():
        raise meshlabserver.ServerError(f"meshlabserver ended with code {done.returncode}:\n{done.stdout[-3000:]}")
    return done.stdout


def stack_of(error):
    """(file of the object, function) of each frame of the error's first stack, from the innermost."""
    return [(Path(frame.findtext("obj") or "").name, frame.findtext("fn") or "?") for frame in error.find("stack")]


def judge(report):
    """(errors whose stack passes through the plugin, as text; number of all errors)"""
    errors = ElementTree.parse(report).getroot().findall("error")
    ours = []
    for error in errors:
        stack = stack_of(error)
        if any(name == PLUGIN for name, _ in stack):
            what = error.findtext("what") or error.findtext("xwhat/text") or error.findtext("kind")
            ours.append("\n    ".join([what, *(f"{function} ({name})" for name, function in stack)]))
    return ours, len(errors)


# The defaults, and the options that they do not use.
VARIANTS = ({}, {"start_mesh": 1, "feature_measure": 1, "select_by": 0, "select_features": True})


def check(build, parameters):
    """Runs the filter once. Returns (a line about the run, errors whose stack passes through the plugin)."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.xml"
        text = checked_run(build, Path(folder), report, target_vertices=TARGET, settling_signals_per_vertex=0, threads=2,
                           **parameters)
        ours, all_errors = judge(report)
    figures = meshlabserver.figures(text)
    if figures["warnings"] != 0:
        raise meshlabserver.ServerError(f"The filter has warned about the cloud:\n{text[-3000:]}")
    return (f"{figures['vertices']} vertices after {figures['signals']} signals: {len(ours)} errors in the plugin, "
            f"{all_errors - len(ours)} elsewhere"), ours


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=ROOT / "build")
    build = parser.parse_args().build.resolve()
    found = 0
    for parameters in VARIANTS:
        line, errors = check(build, parameters)
        print("\n".join([line, *errors]), flush=True)
        found += len(errors)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
