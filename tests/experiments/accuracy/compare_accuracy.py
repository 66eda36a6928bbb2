#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Neural meshes compared with common methods on the same clouds: accuracy, topology, time, memory.

    compare_accuracy.py --plugin LIBRARY.so | --ours-command 'PROGRAM'   [--data FOLDER] [--out FOLDER]

prints a table (markdown) and writes OUT/accuracy.md and OUT/accuracy.json. Without a plugin or command only the peers
are measured. Their results are kept in OUT/cache; delete the folder to measure them again.

The score of a run is the sum of both RMS directions (evaluate.py). A "ratio" is our score over that of the first of
--peers on the same cloud; over several models it is the geometric mean.
"""

import argparse
import hashlib
import json
import os
import sys
from pathlib import Path

import numpy as np

import evaluate
import models
import peers

# Raise this after a change of the peers or the measures that makes cached results wrong.
CACHE_VERSION = 2


def numbers(kind):
    return lambda text: [kind(word) for word in text.split(",") if word]


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--plugin", help="pymeshlab's libfilter_neuralmesh.so")
    parser.add_argument("--ours-command", help="instead of the plugin: started as COMMAND IN.ply OUT.ply key=value...")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="a parameter of ours")
    parser.add_argument("--models", type=numbers(str), help="names of models.py (default: the table's, or the public)")
    parser.add_argument("--vertices", type=numbers(int), default=[500, 2000, 10000])
    parser.add_argument("--noise", type=numbers(float), default=[0, 0.1, 0.3, 0.6], help="%% of the diagonal")
    parser.add_argument("--samples", type=int, default=200_000, help="points of the cloud")
    parser.add_argument("--seeds", type=numbers(int), default=[1], help="of our runs; the cloud has a seed of its own")
    parser.add_argument("--cloud-seed", type=int, default=1)
    parser.add_argument("--peers", type=numbers(str), default=["poisson"], help=f"of {', '.join(peers.PEERS)}")
    parser.add_argument("--data", default=os.environ.get("NEURAL_MESH_DATA"), help="data folder")
    parser.add_argument("--out", type=Path, default=Path("build/experiments"))
    parser.add_argument("--name", default="accuracy", help="of the two files written")
    options = parser.parse_args(arguments)
    options.models = options.models or list(models.TABLE_MODELS if options.data else models.PUBLIC_MODELS)
    if options.plugin and not Path(options.plugin).exists():
        parser.error(f"There is no plugin at {options.plugin}.")
    if unknown := [name for name in options.models if name not in models.MODELS]:
        parser.error(f"There is no model called {unknown[0]}. There are: {', '.join(models.MODELS)}.")
    if unknown := [name for name in options.peers if name not in peers.PEERS]:
        parser.error(f"There is no peer called {unknown[0]}. There are: {', '.join(peers.PEERS)}.")
    if wrong := [word for word in options.set if "=" not in word]:
        parser.error(f"--set takes KEY=VALUE, not {wrong[0]}.")
    return options


class Case:
    """A model with noise: its true surface and the file of its cloud, both made on first use."""

    def __init__(self, name, noise, options):
        self.name, self.noise, self.options = name, noise, options
        self.folder = options.out / "work" / f"{name}-{options.samples}-{noise:g}-{options.cloud_seed}"
        self._truth = None

    def key(self):
        return {"model": self.name, "noise": self.noise, "samples": self.options.samples,
                "cloud_seed": self.options.cloud_seed}

    def truth(self):
        if self._truth is None:
            samples = getattr(self.options, "measure_samples", evaluate.SAMPLES)
            self._truth = evaluate.Truth(*models.load_model(self.name, self.options.data), samples)
        return self._truth

    def cloud(self):
        path = self.folder / "cloud.ply"
        if not path.exists():
            self.folder.mkdir(parents=True, exist_ok=True)
            truth = self.truth()
            points = models.make_cloud(truth.vertices, truth.faces, self.options.samples, self.noise,
                                       self.options.cloud_seed)
            models.save_ply(path, points)
        return path

    def rows(self, method, counts, seed=None, **ours):
        """Runs a method for all counts and measures the results. A failed run gives rows with its error."""
        truth = self.truth()  # a model that is not available is no failure of the method
        folder = self.folder / (method if seed is None else f"{method}-{seed}")
        try:
            figures = peers.run(method, self.cloud(), folder, counts, **ours)
        except peers.PeerError as error:
            return [{"method": method, "seed": seed, "target": n, **self.key(), "error": str(error)} for n in counts]
        rows = []
        for n in counts:
            row = {"method": method, "seed": seed, "target": n, **self.key(), **figures[n]}
            try:
                row.update(evaluate.evaluate(*models.load_mesh(folder / f"{n}.ply"), truth))
            except (ValueError, models.ModelError) as error:
                row["error"] = str(error)
            rows.append(row)
        return rows


def peer_rows(case, peer, counts, cache):
    """The rows of a peer, from the cache if possible."""
    known = {}
    for n in counts:
        name = json.dumps({"peer": peer, "target": n, "version": CACHE_VERSION, **case.key()}, sort_keys=True)
        known[n] = cache / f"{case.name}-{peer}-{n}-{hashlib.sha256(name.encode()).hexdigest()[:12]}.json"
    missing = [n for n in counts if not known[n].exists()]
    if missing:
        cache.mkdir(parents=True, exist_ok=True)
        for row in case.rows(peer, missing):
            known[row["target"]].write_text(json.dumps(row))
    return [json.loads(known[n].read_text()) for n in counts]


def all_rows(options, note):
    rows = []
    settings = dict(word.split("=", 1) for word in options.set)
    for name in options.models:
        for noise in options.noise:
            case = Case(name, noise, options)
            for peer in options.peers:
                rows += peer_rows(case, peer, options.vertices, options.out / "cache")
            if options.plugin or options.ours_command:
                for seed in options.seeds:
                    rows += case.rows("neural", options.vertices, seed, plugin=options.plugin,
                                      command=options.ours_command, settings={**settings, "random_seed": str(seed)})
            note(f"{name}, noise {noise:g} %: done")
    return rows


def geometric_mean(values):
    return float(np.exp(np.mean(np.log(values)))) if len(values) else float("nan")


def by_case(rows, method):
    """{(model, noise, vertices): rows of the method that gave a mesh}."""
    found = {}
    for row in rows:
        if row["method"] == method and "error" not in row:
            found.setdefault((row["model"], row["noise"], row["target"]), []).append(row)
    return found


def topology_right(row):
    model = models.MODELS[row["model"]]
    return row["genus"] == model.genus and row["components"] == model.components


def summary(rows, peer, ours="neural"):
    """Ours against one peer, a dictionary for each noise and number of vertices."""
    mine, theirs = by_case(rows, ours), by_case(rows, peer)
    result = []
    for noise, n in sorted({(r["noise"], r["target"]) for r in rows}):
        cases = [key for key in mine if key[1:] == (noise, n)]
        own = [row for key in cases for row in mine[key]]
        if not own:
            continue
        failed = sum(r["method"] == ours and "error" in r and (r["noise"], r["target"]) == (noise, n) for r in rows)
        line = {"peer": peer, "noise": noise, "vertices": n, "runs": len(own), "failed": failed,
                "sum_rms": geometric_mean([row["sum_rms"] for row in own]),
                "topology_right": sum(map(topology_right, own)),
                "worst_back_over_forward": max(row["backward_max"] / row["forward_max"] for row in own),
                "self_intersecting_percent": max(100 * row["self_intersecting_faces"] / row["faces"] for row in own),
                "exact_count": all(row["vertices"] == n for row in own)}
        medians = {key: np.median([row["sum_rms"] for row in mine[key]]) for key in cases}
        line["stuck"] = sum(bool(row["sum_rms"] > 2 * medians[key]) for key in cases for row in mine[key])
        pairs = [(row, theirs[key][0]) for key in cases if key in theirs for row in mine[key]]
        if pairs:
            ratios = {measure: [a[measure] / max(b[measure], 1e-12) for a, b in pairs]
                      for measure in ("sum_rms", "forward_rms", "backward_rms", "normal_error", "seconds", "peak_mb")}
            line.update((f"{measure}_ratio", geometric_mean(values)) for measure, values in ratios.items())
            worst = int(np.argmax(ratios["sum_rms"]))
            line.update(worst_ratio=ratios["sum_rms"][worst], worst_model=pairs[worst][0]["model"],
                        peer_topology_right=sum(topology_right(b) for _, b in pairs))
        result.append(line)
    return result


def table(header, lines):
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in [header, ["---"] * len(header), *lines])


def summary_table(lines):
    header = ["noise %", "vertices", "score ratio", "worst", "forward", "backward", "normals", "time", "memory",
              "topology right (peer's)", "back/forward max", "self-int. %", "exact", "stuck", "failed"]
    return table(header, [
        [f"{s['noise']:g}", s["vertices"], *(f"{s.get(k, float('nan')):.2f}" for k in ("sum_rms_ratio",)),
         f"{s.get('worst_ratio', float('nan')):.2f} {s.get('worst_model', '')}",
         *(f"{s.get(k + '_ratio', float('nan')):.2f}" for k in ("forward_rms", "backward_rms", "normal_error",
                                                              "seconds", "peak_mb")),
         f"{s['topology_right']}/{s['runs']} ({s.get('peer_topology_right', '-')})",
         f"{s['worst_back_over_forward']:.1f}", f"{s['self_intersecting_percent']:.2f}",
         "yes" if s["exact_count"] else "no", s["stuck"], s["failed"]] for s in lines])


def full_table(rows):
    header = ["model", "noise %", "target", "method", "seed", "vertices", "forward RMS", "backward RMS", "sum",
              "forward max", "backward max", "normal error", "genus", "components", "boundary edges", "self-int.", "s",
              "CPU s", "MB"]
    lines = []
    for r in sorted(rows, key=lambda r: (r["noise"], r["target"], r["model"], r["method"], r["seed"] or 0)):
        start = [r["model"], f"{r['noise']:g}", r["target"], r["method"], "" if r["seed"] is None else r["seed"]]
        if "error" in r:
            lines.append(start + ["failed: " + r["error"].replace("\n", " ")[:80]] + [""] * (len(header) - 6))
            continue
        lines.append(start + [r["vertices"], *(f"{r[k]:.4f}" for k in ("forward_rms", "backward_rms", "sum_rms")),
                              *(f"{r[k]:.2f}" for k in ("forward_max", "backward_max", "normal_error")),
                              r["genus"] if r["manifold"] else "none", r["components"], r["boundary_edges"],
                              r["self_intersecting_faces"], *(f"{r[k]:.1f}" for k in ("seconds", "cpu_seconds")),
                              f"{r['peak_mb']:.0f}"])
    return table(header, lines)


def report(rows, options):
    text = []
    summaries = []
    if any(row["method"] == "neural" for row in rows):
        for peer in options.peers:
            lines = summary(rows, peer)
            summaries += lines
            text += [f"## Neural mesh over {peer}", "Geometric means of the ratios over the models; below 1: ours is "
                     "better (less error, less time, less memory).", "", summary_table(lines), ""]
    text += ["## All runs", "RMS and maxima in % of the diagonal, normal error in degrees.", "", full_table(rows)]
    return "\n".join(text), summaries


def main(arguments=None):
    options = parse(arguments)
    try:
        rows = all_rows(options, lambda text: print(text, file=sys.stderr, flush=True))
    except models.ModelError as error:
        sys.exit(str(error))
    text, summaries = report(rows, options)
    options.out.mkdir(parents=True, exist_ok=True)
    conditions = {"samples": options.samples, "settings": options.set, "cloud_seed": options.cloud_seed}
    (options.out / f"{options.name}.json").write_text(
        json.dumps({"options": conditions, "summary": summaries, "rows": rows}, indent=1))
    (options.out / f"{options.name}.md").write_text(text + "\n")
    print(text)


if __name__ == "__main__":
    main()
