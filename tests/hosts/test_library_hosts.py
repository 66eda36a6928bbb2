# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The plugins for MeshLab 2020.09, 2022.02 and 2025.07, loaded and run by the libraries of those releases without a
window: plugins of other hosts, a host that asks to stop, a host without memory, many runs, two at once."""

import inputs
import library_hosts
import meshlabserver
import pytest
from library_hosts import RELEASES

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
    # How often the filter calls the host depends on the time it takes; so a later call may not come.
    assert stopped[0]["asked_to_stop"]
    for told in stopped:
        assert told["unchanged"] and told["layers"] == 3 and told["current"] == "Neural Mesh"
        assert told["stop_reason"] == (2 if told["asked_to_stop"] else 0)
        assert told["logged"].count("it was cancelled") == (1 if told["asked_to_stop"] else 0)
        assert told["vn"] == told["vertices"] <= 100
    found = meshlabserver.check_mesh(build, tmp_path / "out.off")
    assert found["vertices"] == stopped[-1]["vn"] and found["watertight"] and found["oriented"]


@pytest.mark.parametrize("release", RELEASES)
def test_out_of_memory_at_any_allocation_leaves_the_document_as_it_was(learn, release):
    quick = ball(settling_signals_per_vertex=0, start_mesh=1, fit_to_points=0, select_features=1)
    first, *starved = library_hosts.outcomes(learn(release, f"meshlab-{release}", quick, "memory"))
    assert first["vn"] == 100 and len(starved) > 200
    for index, told in enumerate(starved):
        assert told["unchanged"], f"run {index} has changed the layer: {told}"
        if told["sentence"]:
            assert "signals=" not in told["logged"], f"run {index} has told of a mesh that is not there: {told}"
            assert "memory" in told["sentence"] and told["sentence"].endswith("."), f"run {index}: {told}"
            assert (told["layers"], told["current"]) == (2, "layer"), f"run {index}: {told}"
        else:
            assert (told["layers"], told["vn"], told["signals"]) == (3, 100, first["signals"])
    assert sum(1 for told in starved if told["sentence"]) > len(starved) / 2


def test_no_bad_alloc_leaves_the_plugin_in_meshlab_2020(build):
    first, *starved = library_hosts.outcomes(
        library_hosts.run_2020(build, meshlabserver.plugin_path(build, "meshlab-2020.09")))
    assert first["learned"] and first["vn"] == 100 and len(starved) > 200
    for index, came in enumerate(starved):
        assert not came["escaped"], f"run {index}"
        expected = (2, "Neural Mesh", 100) if came["learned"] else (1, "layer", 1000)
        assert (came["layers"], came["current"], came["vn"]) == expected, f"run {index}: {came}"
        assert came["learned"] or not came["told"], f"run {index} has told of a mesh that is not there"
    assert sum(1 for came in starved if not came["learned"]) > len(starved) / 2


QUICK = {"settling_signals_per_vertex": 0, "start_mesh": 1, "threads": 2}


@pytest.mark.parametrize("release", RELEASES)
def test_a_hundred_runs_leave_nothing_behind(learn, release):
    *runs, grown = library_hosts.outcomes(learn(release, f"meshlab-{release}", ball(**QUICK), "repeat"))
    assert len(runs) > 100 and all(told["unchanged"] and told["vn"] == 100 for told in runs)
    # Less than what the C library's heap may keep for itself; one mesh left behind in each run would be more.
    assert grown["blocks"] == 0 and grown["bytes"] < 1 << 20


@pytest.mark.parametrize("release", RELEASES)
def test_two_runs_at_once_give_what_each_gives_alone(learn, release):
    _, told = library_hosts.outcomes(learn(release, f"meshlab-{release}", ball(**QUICK), "together"))
    assert told == {"different": True, "alike": True}
