# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""One cloud in every format that `neural-mesh stream` reads."""

import importlib.util

import numpy as np
from conftest import ROOT

spec = importlib.util.spec_from_file_location("bench_stream", ROOT / "tests/bench/stream.py")
bench = importlib.util.module_from_spec(spec)
spec.loader.exec_module(bench)

ORIGIN = np.array([4512345.5, 5801234.25, 312.0])
POINTS = np.round(np.random.default_rng(1).normal(size=(1000, 3)), 3) + ORIGIN


def ply(path, kind, order, extra="", points=POINTS, tail=b""):
    """Vertices with a property before and one after the coordinates, after an element of other things."""
    record = np.zeros(len(points), [("q", order + "i2"), *((axis, order + kind) for axis in "xyz"), ("r", "u1")])
    record["q"], record["r"] = 7, 8
    for column, axis in enumerate("xyz"):
        record[axis] = points[:, column]
    name = {"f4": "float", "f8": "double"}[kind]
    path.write_bytes((f"ply\nformat binary_{'little' if order == '<' else 'big'}_endian 1.0\ncomment of no use\n{extra}"
                      f"element vertex {len(points)}\nproperty short q\n"
                      + "".join(f"property {name} {axis}\n" for axis in "xyz") +
                      "property uchar r\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n").encode()
                     + (b"\0" * 24 if extra else b"") + record.tobytes() + tail)


def lines(path, separator=" ", head="", tail=""):
    path.write_text(head + "".join(separator.join(map(repr, map(float, row))) + tail + "\n" for row in POINTS))


def ascii_ply(path):
    lines(path, head="ply\nformat ascii 1.0\nelement camera 1\nproperty float f\nelement vertex 1000\n"
          "property double x\nproperty double y\nproperty double z\nproperty uchar red\nelement face 1\nproperty list uchar "
          "int vertex_indices\nend_header\n3.5\n", tail=" 7")
    path.write_text(path.read_text() + "3 0 1 2\n")


def las(path):
    import laspy
    header = laspy.LasHeader(point_format=3, version="1.2")
    header.scales, header.offsets = [.001] * 3, ORIGIN
    file = laspy.LasData(header)
    file.x, file.y, file.z = POINTS.T
    file.write(str(path))


TURN = np.array([np.cos(.4), 0, 0, np.sin(.4)])  # a quaternion about z


def e57(path):
    """Two scans with poses."""
    import pye57
    angle = .8
    turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    with pye57.E57(str(path), mode="w") as file:
        for points in (POINTS[:400], POINTS[400:]):
            x, y, z = turn.T @ (points - ORIGIN).T
            file.write_scan_raw({"cartesianX": x, "cartesianY": y, "cartesianZ": z}, rotation=TURN, translation=ORIGIN)


FILES = {
    "little.ply": lambda path: ply(path, "f8", "<"),
    "big.ply": lambda path: ply(path, "f8", ">", "element camera 3\nproperty double f\n"),
    "ascii.ply": ascii_ply,
    "plain.xyz": lines,
    "heading.csv": lambda path: lines(path, ",", "a scanner\n//X,Y,Z,Intensity\n", ",.5"),
    "columns.csv": lambda path: lines(path, ";", "\"x\";y;z;id\n", ";1"),
    "count.pts": lambda path: lines(path, "\t", "1000\n", "\t12 0 0 255"),
    "ends.txt": lambda path: path.write_text("\r\n".join(" ".join(map(repr, map(float, row))) for row in POINTS)),
    "plain.las": las,
    "packed.laz": las,
    "scans.e57": e57,
}
