#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The table of surfaces with boundary: boundaries, topology and distances.

    open_table.py LEARN [--data FOLDER] [--models NAME,...] [--kinds plane,three,sphere,whole,views 1,...,half]
                  [--counts N,...] [--seeds N] [--noise PERCENT,...]

LEARN is the program build/tests/learn; for the kind half, models are files of scans. 200,000 points are drawn from a cut
model. Boundary distances are means between points on the boundary edges, in mean edges (those
of an even mesh of the same area and number of faces); "to" is from the true boundary, "from" to it. Spurious and missing
area is farther than a mean edge from the other surface. RMS distances are % of the diagonal of the true surface.

Every row is kept in OUT/open_table.json, by the checksum of LEARN, and taken from there again.
"""

import argparse
import functools
import hashlib
import itertools
import json
import subprocess
import sys
from pathlib import Path

import pymeshlab
from scipy.spatial import cKDTree

import models
import open_surfaces
import peers
from accuracy_table import TABLE_MODELS
from compare_accuracy import numbers, table


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--data")
    parser.add_argument("--models", type=numbers(str), default=list(TABLE_MODELS))
    parser.add_argument("--kinds", type=numbers(str), default=list(open_surfaces.CUTS))
    parser.add_argument("--counts", type=numbers(int), default=[500, 2000, 10000])
    parser.add_argument("--noise", type=numbers(float), default=[0.0])
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="a parameter of ours")
    parser.add_argument("--out", type=Path, default=Path("build/experiments"))
    return parser.parse_args(arguments)


def ours(options, cloud, count, seed):
    out = cloud.with_name("ours.ply")
    done = subprocess.run([options.program, cloud, out, f"target_vertices={count}", f"random_seed={seed}",
                           *options.set], check=False, capture_output=True, text=True)
    if done.returncode != 0:
        raise peers.PeerError(done.stderr.strip()[-300:])
    return models.load_mesh(out), json.loads(done.stdout)["seconds"]


@functools.lru_cache(maxsize=1)
def trimmed_poisson(cloud):
    """Screened Poisson without the faces farther than four spacings from the points; the same for all counts."""
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.load_new_mesh(str(cloud))
    points = cKDTree(meshes.current_mesh().vertex_matrix())
    peers.reconstruct_poisson(meshes, 0)
    vertices, faces = meshes.current_mesh().vertex_matrix(), meshes.current_mesh().face_matrix()
    spacing = open_surfaces.spacing_of(points, points.data[::50])
    return vertices, faces[points.query(vertices[faces].mean(1))[0] < 4 * spacing]


def in_pymeshlab(method, cloud, count):
    """Ball Pivoting, or trimmed Poisson, reduced."""
    clock = peers.Clock()
    meshes = pymeshlab.MeshSet(verbose=False)
    if method == "pivoting":
        meshes.load_new_mesh(str(cloud))
        peers.reconstruct_ball_pivoting(meshes, count)
    else:
        meshes.add_mesh(pymeshlab.Mesh(*trimmed_poisson(cloud)))
    meshes.meshing_decimation_quadric_edge_collapse(targetfacenum=2 * count, preserveboundary=True)
    meshes.meshing_remove_unreferenced_vertices()
    mesh = meshes.current_mesh()
    return (mesh.vertex_matrix(), mesh.face_matrix()), clock.read()[0]


def row_of(options, cloud, case, count, seed):
    try:
        mesh, seconds = ours(options, cloud, count, seed)
        return {**open_surfaces.measure(*mesh, case), "seconds": seconds}
    except (peers.PeerError, models.ModelError, ValueError) as error:
        return {"error": str(error)}


def all_rows(options, kept, keep):
    """The rows asked for, those in kept taken from there."""
    build = hashlib.sha256(Path(options.program).read_bytes() + " ".join(options.set).encode()).hexdigest()[:12]
    rows = []
    for noise in options.noise:
        for name in options.models:
            for kind in options.kinds:
                case, cloud = None, options.out / "work" / f"open-{Path(name).stem}-{kind.replace(' ', '')}-{noise}.ply"
                for count, seed in itertools.product(options.counts, range(1, options.seeds + 1)):
                    key = "|".join(map(str, (name, kind, noise, count, seed, build)))
                    if key not in kept:
                        if case is None:
                            case = open_surfaces.case_of(name, kind, noise, options.data)
                            cloud.parent.mkdir(parents=True, exist_ok=True)
                            models.save_ply(cloud, case.cloud)
                        keep(key, {"model": Path(name).stem, "kind": kind, "noise": noise,
                                   "count": count, **row_of(options, cloud, case, count, seed)})
                        print(line(kept[key]), file=sys.stderr, flush=True)
                    rows.append(kept[key])
                cloud.unlink(missing_ok=True)
    return rows


def line(row):
    """One run, for whoever waits."""
    name = [row["model"], row["kind"], f"{row['noise']:g} %", row["count"]]
    if "error" in row:
        return " | ".join(map(str, [*name, row["error"][:60]]))
    true_loops, true_chi = row.get("true_loops", "?"), row.get("true_chi", "?")
    boundary = f"{row['to']:.2f} / {row['from']:.2f}" if "to" in row else "-"
    figures = [boundary, f"{row['length']:.2f}" if "length" in row else "-", f"{row['loops']} of {true_loops}",
            f"{row['chi']} of {true_chi}", f"{row['spurious']:.2f} / {row['missing']:.2f}",
            f"{row['forward']:.4f} / {row['backward']:.4f}", row["cut"], f"{row['seconds']:.1f}"]
    return " | ".join(map(str, [*name, *figures]))


def share(flags):
    flags = list(flags)
    return f"{sum(flags)} of {len(flags)}"


def summary(rows):
    """By kind, noise and number of vertices: how many runs are within the goals."""
    lines = []
    for kind, noise, count in dict.fromkeys((row["kind"], row["noise"], row["count"]) for row in rows):
        own = [row for row in rows if (row["kind"], row["noise"], row["count"]) == (kind, noise, count)]
        good = [row for row in own if "error" not in row]
        known = [row for row in good if "true_loops" in row]
        bounded = [row for row in known if "to" in row]
        lines.append([
            kind, f"{noise:g} %", count,
            share("error" not in row and row["vertices"] == count and row["manifold"] and row["oriented"]
                  and row["cut"] == 0 for row in own),
            share((row["loops"], row["chi"]) == (row["true_loops"], row["true_chi"]) for row in known),
            share(max(row["to"], row["from"]) <= 1 for row in bounded),
            share(.9 <= row["length"] <= 1.2 for row in bounded),
            share(max(row["spurious"], row["missing"]) <= .5 for row in known),
            share(row["backward"] <= 2 * row["forward"] for row in known)])
    return table(["kind", "noise", "vertices", "sound", "topology right", "boundary <= 1 edge", "length .9 to 1.2",
                  "area <= .5 %", "backward <= 2 x forward"], lines)


def main(arguments=None):
    options = parse(arguments)
    path = options.out / "open_table.json"
    kept = json.loads(path.read_text()) if path.exists() else {}

    def keep(key, row):
        kept[key] = row
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(kept))

    try:
        rows = all_rows(options, kept, keep)
    except models.ModelError as error:
        sys.exit(str(error))
    print(summary(rows))


if __name__ == "__main__":
    main()
