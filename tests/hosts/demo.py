#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Makes a neural mesh of a cloud, and a picture of it: `./run.sh demo` after the build."""

import argparse
import subprocess
import sys
from pathlib import Path

import meshlabserver

BUNNY = Path("/usr/share/glmark2/models/bunny.obj")
BUNNY_POINTS = Path("out/cloud/bunny_points.ply")
PICTURE = Path(__file__).resolve().parents[1] / "experiments" / "pictures" / "paint.py"


def parsed():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", default="build", help="the build folder")
    parser.add_argument("--cloud", type=Path, help="any file that MeshLab 2020.09 reads (default: the bunny's points)")
    parser.add_argument("--vertices", type=int, default=10000)
    parser.add_argument("--out", type=Path, help="default: out/NAME_neural_mesh.ply")
    arguments = parser.parse_args()
    if arguments.out is None:
        arguments.out = Path("out") / f"{arguments.cloud.stem if arguments.cloud else 'bunny'}_neural_mesh.ply"
    if arguments.cloud and not arguments.cloud.exists():
        sys.exit(f"There is no file {arguments.cloud}: name a point cloud or a mesh that MeshLab can open.")
    if arguments.out.suffix.lower() != ".ply":
        sys.exit(f"{arguments.out} does not end in .ply, the format that keeps quality and colour.")
    return arguments


def bunny_points():
    """Writes the points of the bunny in Debian's glmark2-data as a cloud. The file itself fails an assertion in
    MeshLab 2020.09's reader."""
    lines = BUNNY.read_text().splitlines()
    points = [line.split(maxsplit=1)[1] for line in lines if line.startswith("v ")]
    header = ["ply", "format ascii 1.0", f"element vertex {len(points)}",
              *(f"property float {axis}" for axis in "xyz"), "end_header"]
    BUNNY_POINTS.parent.mkdir(parents=True, exist_ok=True)
    BUNNY_POINTS.write_text("\n".join(header + points) + "\n")
    return BUNNY_POINTS


def draw(mesh):
    """Makes a picture of the mesh, in the same folder."""
    picture = mesh.with_suffix(".png")
    subprocess.run([sys.executable, str(PICTURE), str(mesh), str(picture)], check=True)
    return picture


def main():
    arguments = parsed()
    build = Path(arguments.build)
    arguments.out.parent.mkdir(parents=True, exist_ok=True)
    folder = meshlabserver.make_folder(build / "meshlabserver", meshlabserver.plugin_path(build))
    cloud = arguments.cloud or bunny_points()
    script = meshlabserver.write_script(build, build / "demo.mlx", target_vertices=arguments.vertices)
    print(f"== Learning {cloud} in meshlabserver: {arguments.vertices} vertices", flush=True)
    try:
        report = meshlabserver.reconstruct(folder, cloud.resolve(), script.resolve(), arguments.out.resolve(),
                                         timeout=None)
    except meshlabserver.ServerError as error:
        sys.exit(f"{error}\nmeshlabserver made no mesh of {cloud}; its output is above.")
    closed = f"{report['boundary_loops']} boundary loops" if report["boundary_loops"] else "closed"
    print(f"{'vertices':12}{report['vertices']}\n{'faces':12}{report['faces']}, {closed}, genus {report['genus']}\n"
          f"{'signals':12}{report['signals']}\n{'seconds':12}{report['seconds']:.2f}\n"
          f"{'RMS error':12}{report['rms_error']:.4f} % of the diagonal from the points to the mesh")
    print(f"{'mesh':12}{arguments.out}\n{'picture':12}{draw(arguments.out)}")


if __name__ == "__main__":
    main()
