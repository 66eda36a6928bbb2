# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The plugins in the libraries of MeshLab 2020.09, 2022.02 and 2025.07: plugins of other hosts, cancelling, running out
of memory, many runs, two runs at once."""

import inputs
import library_hosts
import meshlabserver
import pytest
from library_hosts import RELEASES

pytestmark = pytest.mark.full

HOSTS = ("meshlab-2020.09", "meshlab-2022.02", "meshlab-2025.07", "pymeshlab-2025.7")


@pytest.fixture
def learn(build, tmp_path):
    """learn(release, host, layer, *mode) -> the finished process, its result in tmp_path / "out.off"."""
    def run(release, host, layer, *mode):
        file = inputs.write_layer(layer, tmp_path / "layer.txt")
        return library_hosts.run(build, release, meshlabserver.plugin_path(build, host), file, tmp_path / "out.off", *mode)
    return run


def ball(**parameters):
    return inputs.Input(inputs.ball(1000), target=100, parameters={"settling_signals_per_vertex": 10, **parameters})


@pytest.mark.parametrize("release, host", [(release, host) for release in RELEASES for host in HOSTS
                                           if host != f"meshlab-{release}"])
def test_plugins_of_other_hosts_are_refused(learn, release, host):
    done = learn(release, host, ball())
    assert done.returncode == 1, done.stderr
    assert done.stdout.startswith("refused: ") and len(done.stdout) > 40


@pytest.mark.parametrize("release", RELEASES)
def test_a_host_that_asks_to_stop_gets_the_mesh_so_far(build, learn, tmp_path, release):
    first, *stopped = library_hosts.outcomes(learn(release, f"meshlab-{release}", ball(), "cancel"))
    assert first["stop_reason"] == 0 and first["vn"] == 100
    # The number of the filter's calls depends on its time, so a later call may not occur.
    assert stopped[0]["asked_to_stop"]
    for outcome in stopped:
        assert outcome["unchanged"] and outcome["layers"] == 3 and outcome["current"] == "Neural Mesh"
        assert outcome["stop_reason"] == (2 if outcome["asked_to_stop"] else 0)
        assert outcome["logged"].count("it was cancelled") == (1 if outcome["asked_to_stop"] else 0)
        assert outcome["vn"] == outcome["vertices"] <= 100
    found = meshlabserver.check_mesh(build, tmp_path / "out.off")
    assert found["vertices"] == stopped[-1]["vn"] and found["watertight"] and found["oriented"]


@pytest.mark.parametrize("release", RELEASES)
def test_out_of_memory_at_any_allocation_leaves_the_document_as_it_was(learn, release):
    quick = ball(settling_signals_per_vertex=0, start_mesh=1, fit_to_points=0, select_features=1)
    first, *starved = library_hosts.outcomes(learn(release, f"meshlab-{release}", quick, "memory"))
    assert first["vn"] == 100 and len(starved) > 200
    for index, outcome in enumerate(starved):
        assert outcome["unchanged"], f"run {index} has changed the layer: {outcome}"
        if outcome["sentence"]:
            assert "signals=" not in outcome["logged"], f"run {index} reports a mesh that does not exist: {outcome}"
            assert "memory" in outcome["sentence"] and outcome["sentence"].endswith("."), f"run {index}: {outcome}"
            assert (outcome["layers"], outcome["current"]) == (2, "layer"), f"run {index}: {outcome}"
        else:
            assert (outcome["layers"], outcome["vn"], outcome["signals"]) == (3, 100, first["signals"])
    assert sum(1 for outcome in starved if outcome["sentence"]) > len(starved) / 2


def test_no_bad_alloc_leaves_the_plugin_in_meshlab_2020(build):
    first, *starved = library_hosts.outcomes(
        library_hosts.run_2020(build, meshlabserver.plugin_path(build, "meshlab-2020.09")))
    assert first["learned"] and first["vn"] == 100 and len(starved) > 200
    for index, outcome in enumerate(starved):
        assert not outcome["escaped"], f"run {index}"
        expected = (2, "Neural Mesh", 100) if outcome["learned"] else (1, "layer", 1000)
        assert (outcome["layers"], outcome["current"], outcome["vn"]) == expected, f"run {index}: {outcome}"
        assert outcome["learned"] or not outcome["reported"], f"run {index} reports a mesh that does not exist"
    assert sum(1 for outcome in starved if not outcome["learned"]) > len(starved) / 2


QUICK = {"settling_signals_per_vertex": 0, "start_mesh": 1, "threads": 2}


@pytest.mark.parametrize("release", RELEASES)
def test_a_hundred_runs_leave_nothing_behind(learn, release):
    *runs, grown = library_hosts.outcomes(learn(release, f"meshlab-{release}", ball(**QUICK), "repeat"))
    assert len(runs) > 100 and all(outcome["unchanged"] and outcome["vn"] == 100 for outcome in runs)
    # The heap of the C library may keep this much; a leak of one mesh per run would be more.
    assert grown["blocks"] == 0 and grown["bytes"] < 1 << 20


@pytest.mark.parametrize("release", RELEASES)
def test_two_runs_at_once_give_what_each_gives_alone(learn, release):
    _, outcome = library_hosts.outcomes(learn(release, f"meshlab-{release}", ball(**QUICK), "together"))
    assert outcome == {"different": True, "alike": True}
