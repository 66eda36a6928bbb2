#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Error over time, on one thread: the neural mesh and common methods on the same clouds, at several sizes each.

    error_over_time.py --plugin LIBRARY.so --cgal build/tests/cgal_peers [--data DATA --models bunny,kitten]
                       [--plot FILE.png] [--out FILE.json]

A table at equal size says little to those who need a certain accuracy: a quick method may need many more vertices.
This one compares at equal error: for each mesh of a peer, the seconds that ours takes to be as accurate. They are
interpolated on the lower envelope of our own points, linearly in the logarithms of both. An error outside of it has a
"-": it is "finer" than that of our best mesh, or "coarser" than that of our fastest.

The error is the sum of both RMS directions against the true surface, in % of its diagonal. Times are the medians of
--repeats runs, without files, one run at a time. What a user could not know is given to the peers for nothing: the
tuned chain has normals that the truth has turned, and of nine pairs of depth and samples per node that with the least
error, or ("for time to error", by the first run of each) that which does best against ours; Alpha Wrap has the alpha
that leads to the number of vertices.
"""

import argparse
import json
import os
import sys
import tempfile
from pathlib import Path

os.environ["OMP_NUM_THREADS"] = "1"  # before any OpenMP is loaded

import numpy as np  # noqa: E402

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "experiments" / "accuracy"))
import compare_accuracy  # noqa: E402
import models  # noqa: E402
import peers  # noqa: E402
from scipy.spatial import cKDTree  # noqa: E402
from compare_accuracy import geometric_mean, note, numbers, table, topology_right  # noqa: E402

import pymeshlab  # noqa: E402

# Title, colour (those of Okabe and Ito, which colour-blind people tell apart), marker and line of each method.
METHODS = {
    "neural": ("Neural Mesh", "#000000", "o", "-"),
    "poisson": ("Screened Poisson, plain chain", "#E69F00", "s", "-"),
    "poisson-tuned": ("Screened Poisson, tuned for error", "#D55E00", "D", "-"),
    "poisson-quick": ("Screened Poisson, tuned for time to error", "#D55E00", "d", "--"),
    "advancing-front": ("Advancing Front + edge collapse", "#009E73", "^", "-"),
    "alpha-wrap": ("Alpha Wrap", "#CC79A7", "v", "-"),
    "ball-pivoting": ("Ball Pivoting", "#0072B2", "P", "-"),
}
CGAL = ("advancing-front", "alpha-wrap")
# The choice among the tuned chain's runs that compared() adds; nothing runs for it.
CHOSEN = "poisson-quick"
DEPTHS, SAMPLES_PER_NODE = (7, 8, 9), (1.5, 5, 15)  # of Screened Poisson, tuned
CLOCKS = {"wall": "seconds", "processor": "cpu_seconds"}


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--plugin", required=True, help="pymeshlab's libfilter_neuralmesh.so")
    parser.add_argument("--cgal", help="the program cgal_peers; with it CGAL is measured as well")
    parser.add_argument("--data", default=os.environ.get("NEURAL_MESH_DATA"), help="data folder")
    parser.add_argument("--models", type=numbers(str), default=["crossed-cylinders", "linked-tori"],
                        help="names of models.py (default: made in code)")
    parser.add_argument("--vertices", type=numbers(int), default=[500, 2000, 10000], help="of the peers' meshes")
    parser.add_argument("--ours", type=numbers(int), default=[100, 200, 500, 1000, 2000, 5000, 10000, 20000],
                        help="vertices of ours")
    parser.add_argument("--samples", type=int, default=100_000, help="points of the clouds")
    parser.add_argument("--noise", type=float, default=0, help="%% of the diagonal")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--timeout", type=float, default=600, help="seconds for the meshes of one process")
    parser.add_argument("--clock", choices=list(CLOCKS), default="wall",
                        help="that of the tables and the picture; processor time depends less on other load")
    parser.add_argument("--plot", type=Path, help="picture to write")
    parser.add_argument("--out", type=Path, help="rows to write, as JSON")
    options = parser.parse_args(arguments)
    options.cloud_seed = 1
    return options


def turned_normals(points, truth):
    """Normals of the points from 30 neighbours, pointing to the side that those of the truth point to."""
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(points))
    meshes.compute_normal_for_point_clouds(k=30)
    normals = meshes.current_mesh().vertex_normal_matrix()
    _, nearest = cKDTree(truth.points).query(points)
    wrong = np.einsum("ij,ij->i", normals, truth.normals[nearest]) < 0
    return np.where(wrong[:, None], -normals, normals)


class TurnedCase(compare_accuracy.Case):
    """The same cloud with normals that point to the side that those of the true surface point to."""

    def cloud(self):
        plain = super().cloud()
        path = plain.with_name("turned.ply")
        if not path.exists():
            meshes = pymeshlab.MeshSet(verbose=False)
            meshes.load_new_mesh(str(plain))
            points = meshes.current_mesh().vertex_matrix()
            meshes.add_mesh(pymeshlab.Mesh(points, v_normals_matrix=turned_normals(points, self.truth())))
            meshes.save_current_mesh(str(path), save_vertex_normal=True, save_vertex_color=False)
        return path


def how(method, settings, options):
    """The arguments of peers.run() that start a method on one thread. CGAL and Ball Pivoting have no other."""
    if method in CGAL:
        return {"command": [options.cgal, method], "timeout": options.timeout}
    ours = {"plugin": options.plugin} if method == "neural" else {}
    one_thread = {} if method == "ball-pivoting" else {"threads": 1}
    return {**ours, "settings": {**settings, **one_thread}, "timeout": options.timeout}


def measured(case, method, counts, options, settings=None):
    """The rows of one run of each size."""
    settings = settings or {}
    return [{**row, "settings": settings} for row in case.rows(method, counts, **how(method, settings, options))]


def best_of_nine(case, counts, options):
    """For each size the row of the pair of parameters with the least error, with all nine as its "choices"."""
    rows = [row for depth in DEPTHS for samples in SAMPLES_PER_NODE
            for row in measured(case, "poisson-tuned", counts, options, {"depth": depth, "samplespernode": samples})]
    best = []
    for n in counts:
        choices = [row for row in rows if row["target"] == n]
        row = min(choices, key=lambda row: row.get("sum_rms", np.inf))
        best.append({**row, "choices": [{key: choice.get(key) for key in ("settings", *CLOCKS.values(), "sum_rms")}
                                        for choice in choices]})
    return best


def repeated(case, rows, options):
    """The rows with the medians of all repeats as their times. The meshes are the same each time."""
    done = [row for row in rows if "error" not in row]
    for settings in {json.dumps(row["settings"]): row["settings"] for row in done}.values():
        group = [row for row in done if row["settings"] == settings]
        method, counts = group[0]["method"], [row["target"] for row in group]
        runs = [{row["target"]: row for row in group}]
        for _ in range(options.repeats - 1):
            runs.append(peers.run(method, case.cloud(), case.folder / method, counts, **how(method, settings, options)))
        medians = {n: {key: float(np.median([run[n][key] for run in runs])) for key in CLOCKS.values()} for n in counts}
        for row in group:
            row.update(medians[row["target"]])
    return rows


def all_rows(options):
    rows = []
    methods = [method for method in METHODS if method != CHOSEN and (options.cgal or method not in CGAL)]
    with tempfile.TemporaryDirectory() as folder:
        where = argparse.Namespace(**{**vars(options), "out": Path(folder)})
        for name in options.models:
            for method in methods:
                if method == "poisson-tuned":
                    case = TurnedCase(name, options.noise, where)
                    found = best_of_nine(case, options.vertices, options)
                else:
                    case = compare_accuracy.Case(name, options.noise, where)
                    found = measured(case, method, options.ours if method == "neural" else options.vertices, options)
                rows += repeated(case, found, options)
                note(f"{name}, {method}: done")
                if options.out:
                    options.out.write_text(json.dumps({"clock": options.clock, "repeats": options.repeats,
                                                       "rows": rows}, indent=1) + "\n")
    return rows


def lower_envelope(points):
    """The (seconds, error) that are more accurate than all faster ones, fastest first."""
    best = []
    for seconds, error in sorted(points):
        if not best or error < best[-1][1]:
            best.append((seconds, error))
    return best


def seconds_to_reach(error, points):
    """The seconds at which the lower envelope of (seconds, error) has an error, interpolated in the logarithms of both;
    or the word for an error that lies outside of it."""
    seconds, errors = zip(*lower_envelope(points))
    if error < errors[-1]:
        return "finer"
    if error > errors[0]:
        return "coarser"
    return float(np.exp(np.interp(np.log(error), np.log(errors[::-1]), np.log(seconds[::-1]))))


def compared(rows, clock):
    """The rows with our seconds to the error of each, and its seconds over ours; after each of the tuned chain one
    for the choice that does best by that."""
    done = []
    for row in rows:
        ours = [(own[clock], own["sum_rms"]) for own in rows
                if own["method"] == "neural" and own["model"] == row["model"] and "error" not in own]
        done.append(row if "error" in row or not ours else with_ratio(row, ours, clock))
        known = {key: row[key] for key in ("model", "target")}
        tried = [with_ratio({**known, **choice, "method": CHOSEN}, ours, clock) for choice in row.get("choices", [])
                 if ours and choice["sum_rms"]]
        if tried:
            done.append(min(tried, key=lambda choice: (choice["ratio"] is None, choice["ratio"] or choice[clock])))
    return done


def with_ratio(row, ours, clock):
    reached = row[clock] if row["method"] == "neural" else seconds_to_reach(row["sum_rms"], ours)
    return {**row, "ours_seconds": reached, "ratio": row[clock] / reached if isinstance(reached, float) else None}


def every_row(rows, clock):
    lines = []
    for row in rows:
        start = [row["model"], METHODS[row["method"]][0], f"{row['target']:,}"]
        if "ratio" not in row:
            lines.append([*start, "failed: " + row.get("error", "ours")[:60], "", "", ""])
        elif row["ratio"] is None:
            lines.append([*start, f"{row[clock]:.2f}", f"{row['sum_rms']:.4f}", f"- ({row['ours_seconds']})", "-"])
        else:
            lines.append([*start, f"{row[clock]:.2f}", f"{row['sum_rms']:.4f}", f"{row['ours_seconds']:.2f}",
                          f"{row['ratio']:.1f}"])
    return table(["cloud", "method", "vertices", "s", "error, %", "ours to this error, s", "times ours"], lines)


def sound(row):
    """Whether the mesh has the genus, components and boundaries of the true surface."""
    return topology_right(row) and row["boundary_loops"] == models.MODELS[row["model"]].boundary_loops


def shown(rows):
    return [method for method in METHODS if any(row["method"] == method for row in rows)]


def summary(rows, clock, counts):
    """Geometric means over the clouds, a method in each line and a size in each column."""
    def of(method):
        return [row for row in rows if row["method"] == method and row["target"] in counts]

    def cell(method, count):
        found = [row for row in of(method) if row["target"] == count and "ratio" in row]
        if not found:
            return "-"
        ratios = [row["ratio"] for row in found if row["ratio"]]
        some = f" ({len(ratios)} of {len(found)})" if 0 < len(ratios) < len(found) else ""
        outside = "- (" + ", ".join(sorted({row["ours_seconds"] for row in found if not row["ratio"]})) + ")"
        return (f"{geometric_mean([row[clock] for row in found]):.2f} / "
                f"{geometric_mean([row['sum_rms'] for row in found]):.4f} / "
                + (f"{geometric_mean(ratios):.1f}{some}" if ratios else outside))

    def topology(method):
        known = [row for row in of(method) if "genus" in row]
        return f"{sum(map(sound, known))} of {len(known)}" if known else "-"

    return table(["s / error, % / times ours to this error", *(f"{n:,} vertices" for n in counts), "topology right"],
                 [[METHODS[method][0], *(cell(method, n) for n in counts), topology(method)]
                  for method in shown(rows)])


def draw_method(panel, method, rows, clock):
    """A curve over the sizes, which stand beside ours."""
    from matplotlib.patheffects import withStroke
    title, color, marker, line = METHODS[method]
    ours = method == "neural"
    panel.plot([row[clock] for row in rows], [row["sum_rms"] for row in rows], color=color, marker=marker, label=title,
               linestyle=line, linewidth=2.6 if ours else 1.4, markersize=6, zorder=3 if ours else 2)
    for row in rows if ours else []:
        panel.annotate(f"{row['target']:,}", (row[clock], row["sum_rms"]), (-6, -2), ha="right", va="top",
                       textcoords="offset points", fontsize=7, zorder=4,
                       path_effects=[withStroke(linewidth=2.5, foreground="white")])


def plot(rows, clock, path):
    """One panel for each cloud, one curve for each method."""
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot, ticker
    names = list(dict.fromkeys(row["model"] for row in rows))
    figure, panels = pyplot.subplots(1, len(names), figsize=(max(9, 1 + 4 * len(names)), 5.4), squeeze=False,
                                     sharex=True, sharey=True)
    for panel, name in zip(panels[0], names):
        for method in shown(rows):
            draw_method(panel, method, [row for row in rows if (row["model"], row["method"]) == (name, method)
                                        and "error" not in row], clock)
        panel.set(xscale="log", yscale="log", title=name,
                  xlabel="seconds on one thread" + (", of the processor" if clock == CLOCKS["processor"] else ""))
        panel.grid(which="major", linewidth=.5)
        panel.grid(which="minor", linewidth=.15)
        for axis in (panel.xaxis, panel.yaxis):
            axis.set_major_formatter(ticker.StrMethodFormatter("{x:g}"))
    panels[0][0].set_ylabel("error: forward + backward RMS,\n% of the diagonal")
    figure.legend(*panels[0][0].get_legend_handles_labels(), loc="lower center", ncols=3, frameon=False,
                  title="the lower left is better: a smaller error in less time")
    figure.tight_layout(rect=(0, .2, 1, 1))
    figure.savefig(path, dpi=100)


def main(arguments=None):
    options = parse(arguments)
    clock = CLOCKS[options.clock]
    try:
        rows = all_rows(options)
    except (models.ModelError, peers.PeerError) as error:
        sys.exit(str(error))
    rows = compared(rows, clock)
    counts = list(dict.fromkeys(row["target"] for row in rows if row["method"] != "neural"))
    print(f"Times: medians, {options.clock} clock, one thread.\n\n{every_row(rows, clock)}\n\n"
          f"Geometric means over the clouds:\n\n{summary(rows, clock, counts)}")
    if options.plot:
        plot(rows, clock, options.plot)


if __name__ == "__main__":
    main()
