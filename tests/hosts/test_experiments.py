# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Small forms of the experiments: features, and what each stage brings. `./run.sh figures` makes the full ones."""

import json
import subprocess

import numpy as np
import pytest

import ablation
import features
import meshlabserver
import models
import paper_runs
import peers
import scans
import shapes

pytestmark = pytest.mark.full


def test_kept_rows_are_taken_again_and_only_those(tmp_path):
    program = tmp_path / "program"
    program.write_text("one build")
    made = []

    def make():
        made.append(len(made))
        return {"row": made[-1]}

    path = tmp_path / "out" / "rows.jsonl"
    kept = paper_runs.Kept(path, program)
    assert kept.row(make, seed=1) == {"row": 0}
    assert kept.row(make, seed=2) == {"row": 1}
    with path.open("a") as file:
        file.write('\n{"key": "the run ended he')
    again = paper_runs.Kept(path, program)
    assert [again.row(make, seed=seed) for seed in (1, 2, 3)] == [{"row": 0}, {"row": 1}, {"row": 2}]
    assert paper_runs.Kept(path, program).row(make, seed=3) == {"row": 2}
    program.write_text("another build")
    assert paper_runs.Kept(path, program).row(make, seed=1) == {"row": 3}


@pytest.mark.parametrize("kind", scans.OUTLIERS)
def test_outliers_are_flagged_and_the_other_points_are_as_before(kind):
    points = np.random.default_rng(1).normal(size=(2000, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    result, outlier = scans.with_outliers(points, kind, .05)
    assert outlier.sum() == 100
    assert len(result) == (2100 if kind in ("box", "clumps") else 2000)
    assert np.isin(result[~outlier], points).all()
    if kind == "clumps":
        assert (np.abs(np.linalg.norm(result[outlier], axis=1) - 1) > .01 * models.diagonal(points)).all()


def test_a_scan_sees_the_outside_and_is_off_it_by_its_noise():
    vertices, faces = shapes.torus()
    clean = scans.scan(vertices, faces, scans.Level(0, 0, 0, 0), pixels=60, dense=100_000)
    assert not clean.outlier.any()
    assert len(clean.seen) > 90_000
    distance, _ = scans.cKDTree(clean.seen).query(clean.points)
    assert distance.max() < .02 * models.diagonal(vertices)
    noisy = scans.scan(vertices, faces, scans.Level(.01, 0, 0, .1), pixels=60, dense=100_000)
    assert noisy.outlier.sum() == round(.1 * len(noisy.points))


def test_the_default_selects_better_than_the_final_mesh_at_any_one_threshold(build, tmp_path):
    features.main(["--learn", str(build / "tests/learn"), "--out", str(tmp_path), "--models", "chamfered-wedge,plate-with-bores",
                          "--noise", ".3", "--vertices", "2500", "--samples", "50000"])
    rows = json.loads((tmp_path / "features.json").read_text())
    mean = {name: np.mean([row["curves"][name] for row in rows], axis=0) for name in rows[0]["curves"]}
    ours = mean.pop("crease measure")[features.DEFAULT]
    assert all(ours > curve.max() for curve in mean.values())


# --- what each stage brings ---------------------------------------------------------------------------------------


ASKS = """#include "vcg_core/base/ablation.h"
#include <cstdio>
#include <exception>
int main() {
    try {
        std::printf("%d %d", neuralmesh::skips("webs"), neuralmesh::skips("hold"));
    } catch (const std::exception& error) {
        std::printf("%s", error.what());
    }
}
"""


def test_stages_are_skipped_in_a_development_build_only(tmp_path):
    (tmp_path / "asks.cpp").write_text(ASKS)

    def answers(names, *options):
        subprocess.run(["c++", "-std=c++17", f"-I{ablation.ROOT}", *options, tmp_path / "asks.cpp", "-o", tmp_path / "asks"],
                       check=True)
        environment = {"NEURALMESH_SKIP": names, "NEURALMESH_ASKED": str(tmp_path / "asked.txt")}
        return subprocess.run([tmp_path / "asks"], env=environment, stdout=subprocess.PIPE, text=True, check=True).stdout

    assert answers("webs,hold") == "0 0" and not (tmp_path / "asked.txt").exists()
    assert answers("webs", "-DNEURALMESH_ABLATION") == "1 0"
    assert (tmp_path / "asked.txt").read_text().split() == ["hold", "webs"]
    assert answers("", "-DNEURALMESH_ABLATION") == "0 0"
    sentence = answers("webs,cobwebs", "-DNEURALMESH_ABLATION")
    assert '"cobwebs", which does not exist' in sentence and sentence.endswith(".")


def without_a_stage(plugin_run):
    """peers.run() as if the plugin could skip: "hold" gives another mesh, "webs" the same, "notches" no mesh; "layers" is
    never asked for."""

    def run(method, cloud, folder, counts, environment=None, settings=None, **others):
        skipped = environment["NEURALMESH_SKIP"]
        assert skipped != "layers"
        if skipped == "notches":
            raise peers.PeerError("The stage is needed.")
        changed = {**settings, "signals_per_split": 20} if "hold" in skipped else settings
        (folder / "asked.txt").write_text("hold webs notches")
        return plugin_run(method, cloud, folder, counts, settings=changed, **others)

    return run


def test_the_table_of_stages_says_what_each_brings(build, tmp_path, monkeypatch, capsys):
    plugin = str(meshlabserver.plugin_path(build, "pymeshlab-2025.7"))
    with pytest.raises(SystemExit, match="skips no stages"):
        ablation.main(["--plugin", plugin, "--out", str(tmp_path)])
    monkeypatch.setattr(peers, "run", without_a_stage(peers.run))
    monkeypatch.setattr(ablation, "check_plugin", lambda options: None)
    words = ["--plugin", plugin, "--small", "--out", str(tmp_path), "--groups", "closed,walls,open cuts,virtual scans",
             "--stages", "hold,webs,notches,layers", "--all-losers", "hold,webs"]
    results = ablation.main(words)
    assert [results[name]["runs"] for name in results] == [4] * 6
    assert results["hold"]["changed"] > 0 and results["hold, webs"]["changed"] == results["hold"]["changed"]
    assert results["webs"]["changed"] == results["layers"]["changed"] == 0
    assert results["webs"]["error"] == {"closed": 1, "walls": 1, "open cuts": 1, "virtual scans": 1}
    assert results["notches"]["saved"] >= 1 and ablation.verdict(results["notches"]).startswith("stays: ")
    assert ablation.verdict(results["layers"]) == "may go: changes no result here"
    assert "| layers | 1.000 | 1.000 |" in capsys.readouterr().out
    # All of it is on disk: without time for any run the table is the same.
    first = (tmp_path / "ablation.md").read_text()
    ablation.main([*words, "--minutes", "0"])
    assert (tmp_path / "ablation.md").read_text() == first


def test_a_stage_stays_by_the_rule():
    result = {"error": {"closed": 1.0, "walls": 1.031}, "saved": 0, "caused": 0, "time": 1.0, "changed": 3}
    assert ablation.verdict(result) == "stays: 3 % of walls"
    assert ablation.verdict({**result, "error": {"closed": .96, "walls": 1.02}}) == "may go: closed better without"
    assert ablation.verdict({**result, "error": {}, "saved": 2, "caused": 1}) == "stays: 1 failure(s)"
    assert ablation.verdict({**result, "error": {}, "saved": 1, "caused": 1, "time": 1.1}) == "stays: 10 % of the time"
