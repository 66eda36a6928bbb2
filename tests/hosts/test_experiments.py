# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Small forms of the experiments: the paper's table, the data of its figures, features and termination, and what each stage
brings. `./run.sh figures` makes the full ones."""

import json
import subprocess

import numpy as np
import pytest

import ablation
import features
import meshlabserver
import models
import paper_figures
import paper_runs
import paper_table1
import paper_termination
import peers
import scans
import selection_table
import shapes

pytestmark = pytest.mark.full

VERTICES = 1000  # of the small table


@pytest.fixture(scope="module")
def learn(build):
    return build / "tests" / "learn"


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


# --- learn, the core as a program ---------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def learned(learn, tmp_path_factory):
    """learned(OUT, WORD...): the finished process of `learn` on a small sphere."""
    cloud = tmp_path_factory.mktemp("learned") / "cloud.ply"
    models.save_ply(cloud, models.make_cloud(*models.load_model("sphere"), 1000))

    def run(out, *words):
        return subprocess.run([str(learn), str(cloud), str(out), "target_vertices=100", "settling_signals_per_vertex=0",
                               *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)

    return run


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


def test_a_mesh_that_cannot_be_saved_ends_with_a_sentence(learned, tmp_path):
    done = learned(tmp_path / "no_such_folder" / "out.ply")
    assert done.returncode == 1 and done.stdout == ""
    assert "Cannot write" in done.stderr and "no_such_folder" in done.stderr


@pytest.mark.parametrize("word", ["fit_to_points=yes", "fit_to_points=", "learning_rate=,06", "learning_rate=.06x",
                                  "target_vertices=many", "target_vertices=true", "target_vertex=100"])
def test_a_word_that_gives_no_parameter_a_value_is_refused(learned, tmp_path, word):
    done = learned(tmp_path / "out.ply", word)
    assert done.returncode == 1 and word in done.stderr and done.stderr.strip().endswith(".")


def test_true_and_false_are_one_and_zero(learned, tmp_path):
    for value, number in (("true", "1"), ("false", "0")):
        assert learned(tmp_path / "word.ply", f"fit_to_points={value}").returncode == 0
        assert learned(tmp_path / "number.ply", f"fit_to_points={number}").returncode == 0
        assert (tmp_path / "word.ply").read_bytes() == (tmp_path / "number.ply").read_bytes()


# --- Table 1 ------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def table1(build, learn, tmp_path_factory):
    out = tmp_path_factory.mktemp("table1")
    paper_table1.main(["--learn", str(learn), "--check", str(build / "tests" / "check_mesh"), "--out", str(out),
                       "--models", "bunny", "--vertices", str(VERTICES), "--seeds", "1,2"])
    return json.loads((out / "table1.json").read_text())


def median_of(rows, measure, **wanted):
    return np.median([row[measure] for row in paper_table1.runs_of(rows, **wanted)])


def test_every_run_has_exactly_the_vertices_asked_for(table1):
    assert len(table1) == 3 * 2 * 2
    assert all(row["vertices"] == row["target"] for row in table1)


def test_to_the_letter_adaptive_growth_stalls_and_with_maturity_it_does_not(table1):
    def stalled(**wanted):
        return [any("stalled" in warning for warning in row["warnings"])
                for row in paper_table1.runs_of(table1, **wanted)]

    assert all(stalled(variant="to the letter", kind="ad"))
    assert not any(stalled(variant="to the letter", kind="nad"))
    assert not any(stalled(variant="with maturity")) and not any(stalled(variant="default"))


def test_adaptive_meshes_are_closer_and_have_better_normals(table1):
    for measure in ("rms", "normal_error"):
        adaptive, even = (median_of(table1, measure, variant="with maturity", kind=kind)
                          for kind in ("ad", "nad"))
        assert adaptive < even, measure


def test_the_default_is_closer_than_the_papers_learning(table1):
    default, paper = (median_of(table1, "rms", variant=variant, kind="ad") for variant in ("default", "with maturity"))
    assert default < 0.7 * paper


# --- Figure 1 -----------------------------------------------------------------------------------------------------


def test_density_follows_curvature_with_the_normal_counter(learn, tmp_path):
    surface = models.load_model("bunny")
    models.save_ply(tmp_path / "cloud.ply", models.make_cloud(*surface, 40_000))
    curvature = paper_figures.mean_curvature(*surface)
    found = {}
    for utility in (0, 1):
        mesh = tmp_path / f"{utility}.ply"
        paper_runs.learn(learn, tmp_path / "cloud.ply", mesh, target_vertices=1500, utility_counter=utility,
                         fit_to_points=0)
        found[utility] = paper_figures.density_correlation(mesh, surface[0], curvature)
    assert found[0] > 0.35 and found[0] > found[1] + 0.3, found


# --- features -----------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def feature_rows(learn, tmp_path_factory):
    out = tmp_path_factory.mktemp("features")
    features.main(["--learn", str(learn), "--out", str(out), "--models", "crossed-cylinders,filleted-cube",
                   "--noise", ".3", "--vertices", "2500", "--samples", "50000"])
    return json.loads((out / "features.json").read_text())


def test_the_crease_measure_beats_every_analysis_of_the_final_mesh(feature_rows):
    rows = [row for row in feature_rows if row["model"] == "crossed-cylinders" and row["stage"] == "fitted"]
    assert len(rows) == 2
    for row in rows:
        ours = row["crease measure"]
        assert ours["default"] > features.best_of(row, features.MESH_MEASURES), row
        assert ours["best"] > row["eq 6 counter"]["best"] and ours["best"] <= row["oracle"]["best"], row


def test_the_default_selects_better_than_the_final_mesh_at_any_one_threshold(learn, tmp_path):
    selection_table.main(["--learn", str(learn), "--out", str(tmp_path), "--models", "chamfered-wedge,plate-with-bores",
                          "--noise", ".3", "--vertices", "2500", "--samples", "50000"])
    rows = json.loads((tmp_path / "selection.json").read_text())
    mean = {name: np.mean([row["curves"][name] for row in rows], axis=0) for name in rows[0]["curves"]}
    ours = mean.pop("crease measure")[selection_table.DEFAULT]
    assert all(ours > curve.max() for curve in mean.values())


def test_rounded_edges_are_no_creases(feature_rows):
    rows = [row for row in feature_rows if row["model"] == "filleted-cube"]
    assert len(rows) == 4 and all(row["false positives"] < 0.1 for row in rows)


# --- termination --------------------------------------------------------------------------------------------------


def test_the_stop_criterion_depends_on_the_mesh_and_eq_4_does_not(build, learn, tmp_path):
    paper_termination.main(["--learn", str(learn), "--trace", str(build / "tests" / "counter_trace"), "--out",
                            str(tmp_path), "--models", "bunny,filleted-cube", "--samples", "50000", "--most", "5000",
                            "--thresholds", ".25"])
    results = json.loads((tmp_path / "termination.json").read_text())
    for trace in results["traces"].values():
        assert len(trace) == 4
        # 1 a signal on average, less 5 % of the sum: 0.95 / 0.05.
        assert [line["sum_eq4"] for line in trace] == pytest.approx([19] * 4, rel=0.25)
        turns = [line["mean_turn"] for line in trace]
        assert turns[-1] < 0.6 * turns[0]
    rows = results["rows"]
    assert all(row["stopped"]["stop_reason"] == paper_termination.CONVERGED for row in rows)
    # The bunny needs more vertices for the same quality of normals; with equal numbers the qualities differ more.
    assert paper_termination.spread([row["stopped"]["vertices"] for row in rows]) > 2
    off = [row for row in rows if row["fit"] == "fit off"]
    assert all(paper_termination.spread([row["stopped"][error] for row in off]) <
               0.6 * paper_termination.spread([row["even"][error] for row in off]) for error in ("normal_error", "normal_rms"))


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
