# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The plugins in the libraries of MeshLab 2022.02 and 2025.07: plugins of other hosts, cancelling, running out of memory."""

import library_hosts
import meshlabserver
from check_mesh import check_mesh
import pytest
from library_hosts import RELEASES

pytestmark = pytest.mark.full



@pytest.mark.parametrize("release, host", [(release, host) for release in RELEASES for host in meshlabserver.HOSTS
                                           if host != f"meshlab-{release}"])
def test_plugins_of_other_hosts_are_refused(build, release, host):
    done = library_hosts.run(build, release, meshlabserver.plugin_path(build, host), "nowhere")
    assert done.returncode == 1, done.stderr
    assert done.stdout.startswith("refused: ") and len(done.stdout) > 40


@pytest.mark.parametrize("release", RELEASES)
def test_a_host_that_asks_to_stop_gets_the_mesh_so_far(build, tmp_path, release):
    first, *stopped = library_hosts.outcomes(library_hosts.run(
        build, release, meshlabserver.plugin_path(build, f"meshlab-{release}"), tmp_path / "out.off", "cancel"))
    assert first["stop_reason"] == 0 and first["vn"] == 100
    # The number of the filter's calls depends on its time, so a later call may not occur.
    assert stopped[0]["asked_to_stop"]
    for outcome in stopped:
        assert outcome["unchanged"] and outcome["layers"] == 3 and outcome["current"] == "Neural Mesh"
        assert outcome["stop_reason"] == (2 if outcome["asked_to_stop"] else 0)
        assert outcome["logged"].count("it was cancelled") == (1 if outcome["asked_to_stop"] else 0)
        assert outcome["vn"] == outcome["vertices"] <= 100
    found = check_mesh(tmp_path / "out.off")
    assert found["vertices"] == stopped[-1]["vn"] and found["watertight"] and found["oriented"]


@pytest.mark.parametrize("release", RELEASES)
def test_out_of_memory_at_any_allocation_leaves_the_document_as_it_was(build, tmp_path, release):
    first, *starved = library_hosts.outcomes(library_hosts.run(
        build, release, meshlabserver.plugin_path(build, f"meshlab-{release}"), tmp_path / "out.off", "memory"))
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
