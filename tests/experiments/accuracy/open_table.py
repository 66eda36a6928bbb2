#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The table of surfaces with boundary: boundaries, topology and distances.

    open_table.py --plugin LIBRARY.so [--data FOLDER] [--models NAME,...] [--kinds plane,three,sphere,whole,views 1,...,half]
                  [--counts N,...] [--seeds N] [--noise PERCENT,...]

For the kind half, models are files of scans. 200,000 points are drawn from a cut model. Boundary distances are means between
points on the boundary edges, in mean edges (those of an even mesh of the same area and number of faces). Spurious and missing
area is farther than a mean edge from the other surface. Every run is kept in OUT/open_table.jsonl and taken from there again.
"""

import itertools
import sys
from pathlib import Path

import models
import open_surfaces
import peers
from compare_accuracy import Kept, note, numbers, parsed, parser, table


def parse(arguments):
    options = parser(__doc__)
    options.add_argument("--kinds", type=numbers(str), default=list(open_surfaces.CUTS))
    options.add_argument("--counts", type=numbers(int), default=[500, 2000, 10000])
    options.add_argument("--noise", type=numbers(float), default=[0.0])
    options.add_argument("--seeds", type=int, default=1)
    return parsed(options, arguments)


def row_of(options, case, cloud, count, seed):
    try:
        peers.run("neural", cloud, cloud.parent, [count], plugin=options.plugin, timeout=options.timeout,
                  settings={**options.settings, "random_seed": seed})
        return open_surfaces.measure(*models.load_mesh(cloud.with_name(f"{count}.ply")), case)
    except (peers.PeerError, models.ModelError, ValueError) as error:
        return {"error": str(error)}


def all_rows(options):
    """The rows asked for."""
    kept, rows = Kept("open_table", options), []
    for noise, name, kind in itertools.product(options.noise, options.models, options.kinds):
        made = []
        cloud = options.out / "work" / f"open-{Path(name).stem}-{kind.replace(' ', '')}-{noise}" / "cloud.ply"

        def run(count, seed):
            if not made:
                made.append(open_surfaces.case_of(name, kind, noise, options.data))
                cloud.parent.mkdir(parents=True, exist_ok=True)
                models.save_ply(cloud, made[0].cloud)
            return row_of(options, made[0], cloud, count, seed)

        for count, seed in itertools.product(options.counts, range(1, options.seeds + 1)):
            key = {"model": name, "kind": kind, "noise": noise, "count": count, "seed": seed}
            row = kept.row(lambda: run(count, seed), **key, **options.settings)
            if row is not None:
                rows.append({**key, **row})
                note(rows[-1])
        cloud.unlink(missing_ok=True)
    return rows


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
                  and row["self_intersecting_faces"] == 0 for row in own),
            share((row["loops"], row["chi"]) == (row["true_loops"], row["true_chi"]) for row in known),
            share(max(row["to"], row["from"]) <= 1 for row in bounded),
            share(.9 <= row["length"] <= 1.2 for row in bounded),
            share(max(row["spurious"], row["missing"]) <= .5 for row in known),
            share(row["backward"] <= 2 * row["forward"] for row in known)])
    return table(["kind", "noise", "vertices", "sound", "topology right", "boundary <= 1 edge", "length .9 to 1.2",
                  "area <= .5 %", "backward <= 2 x forward"], lines)


if __name__ == "__main__":
    try:
        print(summary(all_rows(parse(None))))
    except models.ModelError as error:
        sys.exit(str(error))
