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

import hashlib
import itertools
import os
import re
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

import evaluate
import models
import open_surfaces
import peers
import scan_table
import scenes
import shapes
from compare_accuracy import Kept, geometric_mean, note, numbers, parsed, parser, table

ROOT = Path(__file__).resolve().parents[3]
LEAST_ERROR, LEAST_TIME = 1.03, 1.10  # that a stage has to bring
OTHER_SEED = 1000  # added to a seed for the row that says what chance does
OTHER = "another seed"
CODE_MODELS = ("torus", "filleted-cube", "cup", "linked-tori", "two-spheres")
POINTS_PER_VERTEX_OF_WALLS = 40


@dataclass(frozen=True)
class Scale:
    """How much is run: points of a cloud, vertices of a mesh, runs of a group, points at which an error is measured, views."""
    samples: int
    vertices: tuple
    most: int
    measured: int
    views: dict


FULL = Scale(100_000, (500, 2000, 10_000), 1_000_000, 40_000, {})
QUICK = Scale(20_000, (500, 1000), 5, 20_000, {"pixels": 90, "dense": 200_000})


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


def of_case(case):
    """The cloud of an open surface, and its measures."""
    def measure(vertices, faces):
        row = open_surfaces.measure(vertices, faces, case)
        right = row["manifold"] and row["oriented"]
        if "true_loops" in row:
            right = right and (row["loops"], row["chi"]) == (row["true_loops"], row["true_chi"])
        return {"error": row["forward"] + row["backward"], "right": bool(right), "cut": row["self_intersecting_faces"]}
    return case.cloud, measure


def of_model(name, make, options):
    """The cloud that make(truth) draws from a closed model, see scan_table.cases(), and its measures."""
    truth, model = evaluate.Truth(*models.load_model(name, options.data), options.scale.measured), models.MODELS[name]
    points, _, truth = make(truth)
    return points, closed_measure(truth, model.genus, model.components)


def of_models(options, names, counts, cases, settings=({},)):
    """(name, vertices, make, settings) of each model with each of cases(vertices)."""
    for name, n, own in itertools.product(names, counts, settings):
        for case, make in cases(n):
            yield ", ".join([name, case, *(f"{key} {value}" for key, value in own.items())]), n, lambda name=name, make=make: of_model(name, make, options), own


def noisy(options, *levels):
    return lambda _: [(f"noise {noise:g} %", scan_table.drawn(options.scale.samples, noise)) for noise in levels]


def scanned(options, group):
    return lambda n: scan_table.cases(group, options.scale.samples, n, (1.3, 2, 4), **options.scale.views)


def walls(options):
    def shape(name, edges, n):
        make, genus, components = shapes.WALLS[name]
        surface, _ = shapes.walled(make, edges, n)
        cloud = models.make_cloud(*surface, POINTS_PER_VERTEX_OF_WALLS * n)
        return cloud, closed_measure(evaluate.Truth(*surface, options.scale.measured), genus, components)

    for name, edges, n in itertools.product(shapes.WALLS, (.6, 1, 2), options.scale.vertices[:2]):
        yield f"{name}, {edges:g} edges", n, lambda name=name, e=edges, n=n: shape(name, e, n), {}


def of_cases(cases, counts):
    """The same of [(name, make)], with make() -> an open_surfaces.Case."""
    for n, (name, make) in itertools.product(counts, cases):
        yield name, n, lambda make=make: of_case(make()), {}


def cuts(options):
    return [(f"{name}, {kind}, noise {noise:g} %", lambda args=(name, kind, noise): open_surfaces.case_of(
        *args, options.data, options.scale.samples))
            for name, kind, noise in itertools.product(options.closed, open_surfaces.CUTS, (0, .1))]


def virtual_scans():
    return [(f"{name} {seed}", lambda make=make, seed=seed: make(seed))
            for seed in (1, 2) for name, make in scenes.SCENES.items()]


def halves(options):
    files = sorted(options.real.glob("*.ply"), key=lambda path: path.stat().st_size) if options.real else []
    return [(path.stem, lambda path=path: open_surfaces.case_of(path, "half", 0, None)) for path in files]


def groups(options):
    """{group: its (name, vertices, make, settings)}"""
    counts, closed = options.scale.vertices, options.closed
    return {"closed": of_models(options, closed, counts, noisy(options, 0, .1, .3)),
            "CAD": of_models(options, models.CAD_PARTS + options.creased, counts, noisy(options, 0, .1)),
            "walls": walls(options),
            "topology": of_models(options, options.wild, counts[1:], noisy(options, 0), ({"start_mesh": 1}, {"start_mesh": 0})),
            "open cuts": of_cases(cuts(options), counts),
            "outliers": of_models(options, closed, counts[1:2], lambda n: scanned(options, "outliers")(n)[1:]),
            "levels": of_models(options, closed, counts[1:2], scanned(options, "levels")),
            "virtual scans": of_cases(virtual_scans(), counts[1:]),
            "few points": of_models(options, closed, counts, scanned(options, "points")),
            "real clouds": of_cases(halves(options), counts[1:])}


def spread(items, most):
    """At most that many of the items, from all over the list."""
    return [items[i * len(items) // most] for i in range(most)] if len(items) > most else items


def tasks_of(options):
    return [Task(group, *task) for group, tasks in groups(options).items() if not options.groups or group in options.groups
            for task in spread(list(tasks), options.scale.most)]


# --- runs ---------------------------------------------------------------------------------------------------------


class Runs:
    """Reconstructions with stages skipped, each in a process of its own, and their measures, kept on disk."""

    def __init__(self, options):
        self.options = options
        self.kept = Kept("ablation", options)
        self.work = options.out / "work" / "ablation"
        self.work.mkdir(parents=True, exist_ok=True)
        self.made = {}

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
        settings = {**self.options.settings, **task.settings, "random_seed": seed, "threads": 1}
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
        return self.kept.row(lambda: self.learned(task, seed, skipped, before), task=task.label(), seed=seed,
                             settings=self.options.settings, samples=self.options.scale.samples,
                             measured=self.options.scale.measured, skipped=list(skipped))

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


def measured_table(options):
    runs, tasks, seeds = Runs(options), tasks_of(options), options.seeds
    groups_run = list(dict.fromkeys(task.group for task in tasks))
    cases = [(task, seed) for task in tasks for seed in seeds]
    base = runs.rows([(task, seed, (), None) for task, seed in cases])
    known = [(case, row) for case, row in zip(cases, base) if row is not None]
    failures = sum(is_failure(row) for _, row in known)
    note(f"everything on: {len(known)} of {len(cases)} runs, {failures} failures")
    lines, chance = {}, {}

    def compare(name, rows):
        pairs = [(case[0].group, before, after) for (case, before), after in zip(known, rows) if after is not None]
        if not pairs:
            return
        result = compared(pairs)
        chance.setdefault("error", result["error"])  # the first row is that of another seed
        says = "chance" if name == OTHER else verdict(result, chance["error"])
        lines[name] = line(name + ("" if len(pairs) == len(cases) else " (unfinished)"), result, groups_run, says)
        note(" | ".join(map(str, lines[name])))

    def runs_of(stage):
        return sum(stage in row.get("asked", (stage,)) for _, row in known)

    compare(OTHER, runs.rows([(task, seed + OTHER_SEED, (), None) for (task, seed), _ in known]))
    for stage in sorted(options.stages, key=runs_of):
        compare(stage, runs.rows([(task, seed, (stage,), before) for (task, seed), before in known]))
    header = ["stage", *groups_run, "runs changed", "failures", "cut faces", "time", "verdict"]
    return (f"{len(known)} runs for each stage, seeds {', '.join(map(str, seeds))}; with everything on {failures} of them "
            f"fail.\n\n" + table(header, [lines[name] for name in [OTHER, *options.stages] if name in lines]))


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
    options = parser(__doc__)
    options.add_argument("--stages", type=numbers(str), default=stages(), help="names (default: all)")
    options.add_argument("--groups", type=numbers(str), help="(default: all)")
    options.add_argument("--seeds", nargs="+", type=int, default=[1, 2])
    options.add_argument("--real", type=Path, help="folder with real clouds, *.ply")
    options.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="runs at a time")
    options.add_argument("--runs", action="store_true", help="skip no stages, print each run")
    options.add_argument("--quick", action="store_true", help="some 40 runs of a second for each stage, one seed")
    values = parsed(options, arguments)
    if unknown := [name for name in values.stages if name not in stages()]:
        options.error(f"There is no stage called {unknown[0]}. There are: {', '.join(stages())}.")
    values.scale = QUICK if values.quick else FULL
    if values.quick:
        values.seeds = values.seeds[:1]
    values.closed = CODE_MODELS if values.quick and not values.data else values.models
    values.creased = ("fandisk", "block") if values.data else ("crossed-cylinders",)
    values.wild = (("kitten", "eight", "linked-tori", "bunny", "two-spheres", "genus3", "block") if values.data
                   else ("torus", "linked-tori", "two-spheres", "cup"))
    if unknown := [name for name in values.groups or () if name not in groups(values)]:
        options.error(f"There is no group called {unknown[0]}. There are: {', '.join(groups(values))}.")
    return values


def main(arguments=None):
    options = parse(arguments)
    if options.runs:
        print(table_of_runs(options))
        return
    check_plugin(options)
    try:
        text = measured_table(options)
    except models.ModelError as error:
        sys.exit(str(error))
    (options.out / "ablation.md").write_text(text + "\n")
    print(text)


if __name__ == "__main__":
    main()
