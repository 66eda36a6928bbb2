# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""tests/bench/error_over_time.py: what it reads from its measured points, and a small run."""

import json

import pytest

import error_over_time
import meshlabserver

pytestmark = pytest.mark.full

# On the straight line error = 1 / seconds^2, in the logarithms of both.
LINE = [(1, 1), (2, 1 / 4), (4, 1 / 16), (10, 1 / 100)]


def test_on_a_line_in_the_logarithms_the_seconds_are_exact():
    for seconds in (1, 1.5, 2, 3, 5, 10):
        assert error_over_time.seconds_to_reach(1 / seconds**2, LINE) == pytest.approx(seconds)


def test_points_that_a_faster_one_is_as_accurate_as_are_left_out():
    slow = [(3, 1 / 4), (5, 1 / 10), (2.5, .5)]
    assert error_over_time.lower_envelope(LINE + slow) == LINE
    assert error_over_time.seconds_to_reach(1 / 9, LINE + slow) == pytest.approx(3)


def test_an_error_outside_the_points_has_no_seconds():
    assert error_over_time.seconds_to_reach(1 / 100 - 1e-6, LINE) == "finer"
    assert error_over_time.seconds_to_reach(1 + 1e-6, LINE) == "coarser"


def row(method, target, seconds, error, model="sphere"):
    return {"model": model, "method": method, "target": target, "seconds": seconds, "sum_rms": error}


def test_each_cloud_is_compared_with_our_points_of_the_same_cloud():
    rows = [row("neural", 100 * i, *point) for i, point in enumerate(LINE)]
    rows += [row("neural", 100, 50, 1, "cup"), row("neural", 200, 100, .01, "cup")]
    rows += [row("poisson", 500, 12, 1 / 9), row("poisson", 500, 12, 1, "cup"), row("alpha-wrap", 500, .1, 2)]
    rows = error_over_time.compared(rows, "seconds")
    on_sphere, on_cup, outside = rows[-3:]
    assert on_sphere["ours_seconds"] == pytest.approx(3) and on_sphere["ratio"] == pytest.approx(4)
    assert on_cup["ours_seconds"] == pytest.approx(50) and on_cup["ratio"] == pytest.approx(12 / 50)
    assert outside["ours_seconds"] == "coarser" and outside["ratio"] is None
    table = error_over_time.every_row(rows, "seconds")
    assert "| sphere | Alpha Wrap | 500 | 0.10 | 2.0000 | - (coarser) | - |" in table
    summary = error_over_time.summary(rows, "seconds", [500])
    assert "| Screened Poisson, plain chain | 12.00 / 0.3333 / 1.0 | - |" in summary  # the mean of 4 and of 12 / 50


def test_the_chosen_one_does_best_against_ours_not_by_error():
    tried = [{"seconds": 40, "sum_rms": 1 / 16}, {"seconds": 9, "sum_rms": 1 / 9}, {"seconds": 5, "sum_rms": 1},
             {"seconds": .1, "sum_rms": 5}, {"seconds": None, "sum_rms": None}]
    rows = [row("neural", 100 * i, *point) for i, point in enumerate(LINE)]
    rows.append({**row("poisson-tuned", 500, 40, 1 / 16), "choices": tried})
    tuned, chosen = error_over_time.compared(rows, "seconds")[-2:]
    assert (tuned["method"], tuned["ratio"]) == ("poisson-tuned", pytest.approx(10))
    assert (chosen["method"], chosen["seconds"], chosen["ratio"]) == ("poisson-quick", 9, pytest.approx(3))


def test_a_small_run_measures_every_method_and_shows_its_rows_again(build, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(error_over_time.scan_table, "DEPTHS", (5,))
    out, picture = tmp_path / "rows.json", tmp_path / "picture.png"
    error_over_time.main(["--plugin", str(meshlabserver.plugin_path(build, "pymeshlab-2025.7")), "--models", "sphere",
                          "--samples", "5000", "--vertices", "100,300", "--ours", "50,400", "--repeats", "2", "--out",
                          str(out), "--plot", str(picture)])
    printed = capsys.readouterr().out
    rows = json.loads(out.read_text())["rows"]
    expected = {(m, n) for m in ("poisson", "poisson-tuned", "ball-pivoting") for n in (100, 300)}
    assert {(row["method"], row["target"]) for row in rows} == expected | {("neural", 50), ("neural", 400)}
    assert all(row["seconds"] > 0 and row["sum_rms"] > 0 and "error" not in row for row in rows)
    tuned = [row for row in rows if row["method"] == "poisson-tuned"]
    assert all(row["sum_rms"] == min(choice["sum_rms"] for choice in row["choices"]) for row in tuned)
    assert picture.stat().st_size > 10_000
    error_over_time.main(["--again", str(out)])
    assert capsys.readouterr().out == printed
