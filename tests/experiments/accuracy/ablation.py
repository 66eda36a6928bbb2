#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""What each optional stage of the reconstruction brings: every stage is skipped, one at a time, over groups of clouds.

    ablation.py --plugin LIBRARY.so [--quick] [--data FOLDER] [--real FOLDER] [--out FOLDER] [--minutes N]
    ablation.py --plugin LIBRARY.so --runs [--groups walls,topology] ...    each run with everything on, by any plugin

LIBRARY is pymeshlab's plugin of a build with -DNEURALMESH_ABLATION=ON. Prints one table (markdown) and writes it to
OUT/ablation.md. Every run is kept in OUT/ablation.jsonl under the checksum of the plugin, so an interrupted run, or one
that --minutes ended, goes on where it stopped.

A column of a group has the error (forward plus backward RMS) without the stage over that with everything on: the geometric
mean of the runs of the group whose topology is right with and without it. "Failures" are runs whose topology is wrong, that
are no oriented manifold, whose faces cut each other, or that end with an error: those that the stage saves, and those that
occur with it only. "Cut faces" is the change of their number. "Time" is the ratio of the processor times. The row "another
seed" says what chance does. Runs that never ask for a stage, and those whose result has the same bytes, count as unchanged.

A stage stays if it brings 3 % of the mean error of some group, saves a failure that nothing else saves, or brings 10 % of
the time. Where chance changes the error of the group by as much, the verdict says so. Stages that few runs ask for are
measured first.
"""

import argparse
import hashlib
import itertools
import os
import re
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
import cad_parts  # noqa: E402
import evaluate  # noqa: E402
import models  # noqa: E402
import open_surfaces  # noqa: E402
import peers  # noqa: E402
import scan_table  # noqa: E402
import scans  # noqa: E402
import scenes  # noqa: E402
import wall_shapes  # noqa: E402
from accuracy_table import TABLE_MODELS  # noqa: E402
from compare_accuracy import Kept, geometric_mean, numbers, table  # noqa: E402

LEAST_ERROR, LEAST_TIME = 1.03, 1.10  # that a stage has to bring
OTHER_SEED = 1000  # added to a seed for the row that says what chance does
OTHER = ("another seed",)
CODE_MODELS = ("torus", "filleted-cube", "cup", "linked-tori", "two-spheres")
GENUS_OF_PARTS = {"plate-with-bores": 4}  # of the others 0
POINTS_PER_VERTEX_OF_WALLS = 40


@dataclass(frozen=True)
class Scale:
    """How much is run: points of a cloud, vertices of a mesh, runs of a group, points at which an error is measured."""

    samples: int
    vertices: tuple
    most: int
    measured: int


FULL = Scale(100_000, (500, 2000, 10_000), 1_000_000, 40_000)
QUICK = Scale(20_000, (500, 1000), 5, 20_000)


@dataclass
class Task:
    """A cloud to learn. make() gives its points, and a function from the mesh to its measures."""

    group: str
    name: str
    vertices: int
    make: object
    settings: dict = field(default_factory=dict)

    def label(self):
        return f"{self.group}, {self.name}, {self.vertices}"


def stages():
    """The names that a development build can skip, in the order of the reconstruction."""
    text = (ROOT / "vcg_core/base/ablation.h").read_text()
    return re.findall(r'"(\w+)"', re.search(r"kStages\[\] = \{(.*?)\};", text, re.DOTALL)[1])


# --- clouds and measures ------------------------------------------------------------------------------------------


def closed_measure(truth, genus, components):
    def measure(vertices, faces):
        row = evaluate.evaluate(vertices, faces, truth)
        right = row["manifold"] and not row["boundary_loops"] and (row["genus"], row["components"]) == (genus, components)
        return {"error": row["sum_rms"], "right": bool(right), "cut": row["self_intersecting_faces"]}

    return measure


def open_measure(case):
    def measure(vertices, faces):
        row = open_surfaces.measure(vertices, faces, case)
        right = row["manifold"] and row["oriented"]
        if "true_loops" in row:
            right = right and (row["loops"], row["chi"]) == (row["true_loops"], row["true_chi"])
        return {"error": row["forward"] + row["backward"], "right": bool(right), "cut": row["cut"]}

    return measure


def of_surface(surface, genus, components, cloud, scale):
    return cloud, closed_measure(evaluate.Truth(*surface, scale.measured), genus, components)


def of_model(name, options, cloud_of):
    """cloud_of(vertices, faces) of a closed model."""
    surface, model = models.load_model(name, options.data), models.MODELS[name]
    return of_surface(surface, model.genus, model.components, cloud_of(*surface), options.scale)


def plain_cloud(options, noise, samples=None):
    return lambda v, f: models.make_cloud(v, f, samples or options.scale.samples, noise)


def closed(options):
    for name, noise, n in itertools.product(options.closed, (0, .1, .3), options.scale.vertices):
        yield Task("closed", f"{name}, noise {noise:g} %", n,
                   lambda name=name, noise=noise: of_model(name, options, plain_cloud(options, noise)))


def cad(options):
    def part(name, noise):
        surface = cad_parts.PARTS[name]()
        return of_surface(surface, GENUS_OF_PARTS.get(name, 0), 1, plain_cloud(options, noise)(*surface), options.scale)

    for name, noise, n in itertools.product(cad_parts.PARTS, (0, .1), options.scale.vertices):
        yield Task("CAD", f"{name}, noise {noise:g} %", n, lambda name=name, noise=noise: part(name, noise))
    for name, noise, n in itertools.product(options.creased, (0, .1), options.scale.vertices):
        yield Task("CAD", f"{name}, noise {noise:g} %", n,
                   lambda name=name, noise=noise: of_model(name, options, plain_cloud(options, noise)))


def walls(options):
    def shape(name, edges, n):
        make, genus, components = wall_shapes.WALLS[name]
        surface, _ = wall_shapes.walled(make, edges, n)
        cloud = models.make_cloud(*surface, POINTS_PER_VERTEX_OF_WALLS * n)
        return of_surface(surface, genus, components, cloud, options.scale)

    for name, edges, n in itertools.product(wall_shapes.WALLS, (.6, 1, 2), options.scale.vertices[:2]):
        yield Task("walls", f"{name}, {edges:g} edges", n, lambda name=name, e=edges, n=n: shape(name, e, n))


def topology(options):
    for n, start, name in itertools.product(options.scale.vertices[1:] or options.scale.vertices, (1, 0), options.wild):
        yield Task("topology", f"{name} from {('the shell', 'the tetrahedron')[start]}", n,
                   lambda name=name: of_model(name, options, plain_cloud(options, 0)), {"start_mesh": start})


def cuts(options):
    def cut(name, kind, noise):
        case = open_surfaces.case_of(name, kind, noise, options.data, options.scale.samples)
        return case.cloud, open_measure(case)

    for name, kind, noise, n in itertools.product(options.closed, open_surfaces.CUTS, (0, .1), options.scale.vertices):
        yield Task("open cuts", f"{name}, {kind}, noise {noise:g} %", n,
                   lambda name=name, kind=kind, noise=noise: cut(name, kind, noise))


def outliers(options):
    def with_them(kind, share):
        return lambda v, f: scans.with_outliers(plain_cloud(options, 0)(v, f), kind, share)[0]

    for name, (kind, share), n in itertools.product(options.closed, scan_table.OUTLIERS, options.scale.vertices[1:2] or
                                                    options.scale.vertices):
        yield Task("outliers", f"{name}, {kind} {100 * share:g} %", n,
                   lambda name=name, kind=kind, share=share: of_model(name, options, with_them(kind, share)))


def levels(options):
    pixels, dense = (300, scans.DENSE) if options.scale is FULL else (90, 200_000)

    def seen(name, level):
        surface, model = models.load_model(name, options.data), models.MODELS[name]
        result = scans.scan(*surface, scans.LEVELS[level], pixels=pixels, dense=dense)
        truth = scan_table.seen_part(evaluate.Truth(*surface, options.scale.measured), result)
        return result.points, closed_measure(truth, model.genus, model.components)

    for level, name, n in itertools.product(scans.LEVELS, options.closed, options.scale.vertices[1:2] or
                                            options.scale.vertices):
        yield Task("levels", f"{name}, level {level}", n, lambda name=name, level=level: seen(name, level))


def virtual_scans(options):
    def scene(make, seed):
        case = make(seed)
        return case.cloud, open_measure(case)

    for seed, name, n in itertools.product((1, 2), scenes.SCENES, options.scale.vertices[1:] or options.scale.vertices):
        yield Task("virtual scans", f"{name} {seed}", n,
                   lambda make=scenes.SCENES[name], seed=seed: scene(make, seed))


def few_points(options):
    for name, each, noise, n in itertools.product(options.closed, (1.3, 2, 4), (0, .1), options.scale.vertices):
        yield Task("few points", f"{name}, {each:g} per vertex, noise {noise:g} %", n,
                   lambda name=name, each=each, noise=noise, n=n:
                   of_model(name, options, plain_cloud(options, noise, int(each * n))))


def real_clouds(options):
    def half(path):
        case = open_surfaces.case_of(path, "half", 0, None)
        return case.cloud, open_measure(case)

    files = sorted(options.real.glob("*.ply"), key=lambda path: path.stat().st_size) if options.real else []
    for n, path in itertools.product(options.scale.vertices[1:] or options.scale.vertices, files):
        yield Task("real clouds", path.stem, n, lambda path=path: half(path))


GROUPS = {"closed": closed, "CAD": cad, "walls": walls, "topology": topology, "open cuts": cuts, "outliers": outliers,
          "levels": levels, "virtual scans": virtual_scans, "few points": few_points, "real clouds": real_clouds}


def spread(items, most):
    """At most that many of the items, from all over the list."""
    return [items[i * len(items) // most] for i in range(most)] if len(items) > most else items


# --- runs ---------------------------------------------------------------------------------------------------------


class Runs:
    """Reconstructions with stages skipped, each in a process of its own, and their measures, kept on disk."""

    def __init__(self, options):
        self.options = options
        self.kept = Kept(options.out / "ablation.jsonl", options.plugin)
        self.work = options.out / "work" / "ablation"
        self.work.mkdir(parents=True, exist_ok=True)
        self.made = {}
        self.end = time.monotonic() + 60 * options.minutes

    def prepare(self, task):
        """The file of the cloud and the measures of the task."""
        if task.label() not in self.made:
            points, measure = task.make()
            cloud = self.work / f"{hashlib.sha256(task.label().encode()).hexdigest()[:16]}-{self.options.scale.samples}.ply"
            models.save_ply(cloud, points)
            self.made[task.label()] = cloud, measure
        return self.made[task.label()]

    def learned(self, task, seed, skipped, before):
        """The row of one run. before: that with everything on, or none."""
        cloud, measure = self.made[task.label()]
        folder = self.work / f"{cloud.stem}-{seed}-{hashlib.sha256(','.join(skipped).encode()).hexdigest()[:12]}"
        folder.mkdir(exist_ok=True)
        asked = folder / "asked.txt"
        environment = {"NEURALMESH_SKIP": ",".join(skipped), "NEURALMESH_ASKED": str(asked)}
        settings = {**task.settings, "random_seed": seed, "threads": 1}
        mesh = folder / f"{task.vertices}.ply"
        try:
            figures = peers.run("neural", cloud, folder, [task.vertices], plugin=self.options.plugin, settings=settings,
                                timeout=self.options.timeout, environment=environment)[task.vertices]
            row = {"digest": hashlib.sha256(mesh.read_bytes()).hexdigest()[:16], "cpu": figures["cpu_seconds"],
                   "asked": asked.read_text().split() if asked.exists() else []}
            if before and before.get("digest") == row["digest"]:
                row.update((key, before[key]) for key in ("error", "right", "cut"))
            else:
                row.update(measure(*models.load_mesh(mesh)))
        except (peers.PeerError, models.ModelError, ValueError) as error:
            row = {"failed": str(error)[-200:]}
        for file in (mesh, asked):
            file.unlink(missing_ok=True)
        folder.rmdir()
        return row

    def row(self, task, seed, skipped=(), before=None):
        """The same from disk if it is there, nothing if no time is left."""
        if before and not any(stage in before.get("asked", skipped) for stage in skipped):
            return before
        key = {"task": task.label(), "settings": task.settings, "samples": self.options.scale.samples,
               "measured": self.options.scale.measured, "seed": seed, "skipped": list(skipped)}
        if time.monotonic() > self.end and not self.kept.has(**key):
            return None
        return self.kept.row(lambda: self.learned(task, seed, skipped, before), **key)

    def rows(self, jobs):
        """The rows of (task, seed, skipped, before), several at a time."""
        for task in {job[0].label(): job[0] for job in jobs}.values():
            self.prepare(task)
        with ThreadPoolExecutor(self.options.jobs) as pool:
            return list(pool.map(lambda job: self.row(*job), jobs))


# --- table --------------------------------------------------------------------------------------------------------


def is_failure(row):
    return "failed" in row or not row["right"] or row["cut"] > 0


def compared(pairs):
    """What rows without a stage are beside those with everything on, from (group, before, after)."""
    ratios, times, result = {}, [], {"saved": 0, "caused": 0, "cut": 0, "changed": 0, "runs": len(pairs)}
    for group, before, after in pairs:
        changed = after.get("digest") != before.get("digest")
        result["changed"] += changed
        result["saved"] += is_failure(after) and not is_failure(before)
        result["caused"] += is_failure(before) and not is_failure(after)
        if "failed" in after or "failed" in before:
            continue
        if before["right"] and after["right"]:
            ratios.setdefault(group, []).append(after["error"] / max(before["error"], 1e-12) if changed else 1)
        times.append(after["cpu"] / before["cpu"] if after is not before else 1)
        result["cut"] += after["cut"] - before["cut"]
    result["error"] = {group: geometric_mean(values) for group, values in ratios.items()}
    result["time"] = geometric_mean(times) if times else float("nan")
    return result


def verdict(result, chance=None):
    """By the rule of this script. chance: the errors of the groups with another seed, over those with this one."""
    def is_chance(group, ratio):
        return abs(np.log(ratio)) <= abs(np.log((chance or {}).get(group, 1)))

    reasons = [f"{100 * (ratio - 1):.0f} % of {group}" + (" (chance?)" if is_chance(group, ratio) else "")
               for group, ratio in result["error"].items() if ratio >= LEAST_ERROR]
    if result["saved"] > result["caused"]:
        reasons.append(f"{result['saved'] - result['caused']} failure(s)")
    if result["time"] >= LEAST_TIME:
        reasons.append(f"{100 * (result['time'] - 1):.0f} % of the time")
    if reasons:
        return "stays: " + ", ".join(reasons)
    better = [group for group, ratio in result["error"].items() if ratio <= 2 - LEAST_ERROR and not is_chance(group, ratio)]
    if result["changed"] == 0:
        return "may go: changes no result here"
    return "may go" + (f": {', '.join(better)} better without" if better else "")


def line(name, result, groups, says):
    return [name, *(f"{result['error'][group]:.3f}" if group in result["error"] else "-" for group in groups),
            f"{result['changed']} of {result['runs']}", f"+{result['saved']} -{result['caused']}", f"{result['cut']:+d}",
            f"{result['time']:.2f}", says]


def tasks_of(options):
    return [task for group in options.groups for task in spread(list(GROUPS[group](options)), options.scale.most)]


def measured_table(options, note):
    runs, tasks, seeds = Runs(options), tasks_of(options), options.seeds
    groups = list(dict.fromkeys(task.group for task in tasks))
    cases = [(task, seed) for task in tasks for seed in seeds]
    base = runs.rows([(task, seed, (), None) for task, seed in cases])
    known = [(case, row) for case, row in zip(cases, base) if row is not None]
    note(f"everything on: {len(known)} of {len(cases)} runs, {sum(is_failure(row) for _, row in known)} failures")
    lines, results = {}, {}

    def compare(names, rows):
        pairs = [(case[0].group, before, after) for (case, before), after in zip(known, rows) if after is not None]
        if not pairs:
            return
        results[names] = result = compared(pairs)
        says = verdict(result, results[OTHER]["error"]) if names != OTHER and OTHER in results else "chance"
        lines[names] = line(", ".join(names) + ("" if len(pairs) == len(cases) else " (unfinished)"), result, groups, says)
        note(" | ".join(map(str, lines[names])))

    def runs_of(names):
        return sum(any(stage in row.get("asked", names) for stage in names) for _, row in known)

    compare(OTHER, runs.rows([(task, seed + OTHER_SEED, (), None) for (task, seed), _ in known]))
    wanted = [(stage,) for stage in options.stages] + ([tuple(options.all_losers)] if options.all_losers else [])
    for names in sorted(wanted, key=runs_of):
        compare(names, runs.rows([(task, seed, names, before) for (task, seed), before in known]))
    header = ["stage", *groups, "runs changed", "failures", "cut faces", "time", "verdict"]
    failures = sum(is_failure(row) for _, row in known)
    text = (f"{len(known)} runs for each stage, seeds {', '.join(map(str, seeds))}; with everything on {failures} of them "
            f"fail.\n\n" + table(header, [lines[names] for names in [OTHER, *wanted] if names in lines]))
    return text, {", ".join(names): result for names, result in results.items()}


def table_of_runs(options):
    """Each run with everything on, whose topology is right or not."""
    runs = Runs(options)
    lines = [[task.group, task.name, task.vertices, seed, row.get("failed") or f"{row['error']:.4f}",
              "yes" if row.get("right") else "**no**", row.get("cut", "-")]
             for task in tasks_of(options) for seed in options.seeds
             if runs.prepare(task) and (row := runs.row(task, seed)) is not None]
    return table(["group", "cloud", "vertices", "seed", "forward + backward, %", "topology right", "cut faces"], lines)


def check_plugin(options):
    """Ends with a sentence if the plugin skips no stages."""
    meshes = Path(options.out / "work")
    meshes.mkdir(parents=True, exist_ok=True)
    models.save_ply(meshes / "sphere.ply", models.make_cloud(*models.load_model("sphere"), 500))
    try:
        peers.run("neural", meshes / "sphere.ply", meshes, [50], plugin=options.plugin,
                  environment={"NEURALMESH_SKIP": "no_such_stage"})
    except peers.PeerError as error:
        if "no_such_stage" in str(error):
            return
        sys.exit(str(error))
    sys.exit(f"{options.plugin} skips no stages: it has to be built with -DNEURALMESH_ABLATION=ON.")


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--plugin", required=True, help="pymeshlab's libfilter_neuralmesh.so, built to skip stages")
    parser.add_argument("--stages", type=numbers(str), default=stages(), help="names (default: all)")
    parser.add_argument("--all-losers", type=numbers(str), default=[], help="stages to skip together, in one more row")
    parser.add_argument("--groups", type=numbers(str), default=list(GROUPS), help=f"of {', '.join(GROUPS)}")
    parser.add_argument("--seeds", nargs="+", type=int, default=[1, 2])
    parser.add_argument("--data", default=os.environ.get("NEURAL_MESH_DATA"), help="data folder")
    parser.add_argument("--real", type=Path, help="folder with real clouds, *.ply")
    parser.add_argument("--out", type=Path, default=Path("build/experiments"))
    parser.add_argument("--minutes", type=float, default=float("inf"), help="start no run later than this")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="runs at a time")
    parser.add_argument("--timeout", type=float, default=300, help="seconds of one run")
    parser.add_argument("--runs", action="store_true", help="skip no stages, print each run")
    parser.add_argument("--quick", action="store_true", help="some 40 runs of a second for each stage, one seed")
    options = parser.parse_args(arguments)
    if not Path(options.plugin).exists():
        parser.error(f"There is no plugin at {options.plugin}.")
    if unknown := [name for name in (*options.stages, *options.all_losers) if name not in stages()]:
        parser.error(f"There is no stage called {unknown[0]}. There are: {', '.join(stages())}.")
    if unknown := [name for name in options.groups if name not in GROUPS]:
        parser.error(f"There is no group called {unknown[0]}. There are: {', '.join(GROUPS)}.")
    options.scale = QUICK if options.quick else FULL
    if options.quick:
        options.seeds = options.seeds[:1]
    with_data = options.data
    public = models.PUBLIC_MODELS if options.scale is FULL else CODE_MODELS
    options.closed = TABLE_MODELS if with_data else public
    options.creased = ("fandisk", "block") if with_data else ("crossed-cylinders",)
    options.wild = (("kitten", "eight", "linked-tori", "bunny", "two-spheres", "genus3", "block") if with_data
                    else ("torus", "linked-tori", "two-spheres", "cup"))
    return options


def main(arguments=None):
    options = parse(arguments)
    if options.runs:
        print(table_of_runs(options))
        return {}
    check_plugin(options)
    try:
        text, results = measured_table(options, lambda words: print(words, file=sys.stderr, flush=True))
    except models.ModelError as error:
        sys.exit(str(error))
    (options.out / "ablation.md").write_text(text + "\n")
    print(text)
    return results


if __name__ == "__main__":
    main()
