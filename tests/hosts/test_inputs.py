# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Every layer of inputs.py in every host: a right mesh or a sentence, the same in all of them, and the layer as it
was. inputs_table.py prints the same as a table."""

import input_hosts
import inputs
import pytest

INPUTS = inputs.all_inputs()
COUNTS = ("vertices", "faces", "signals", "splits", "collapses", "genus", "components", "stop_reason")


@pytest.fixture(scope="module")
def first_of():
    """What the first host has told, for each input."""
    return {}


@pytest.mark.parametrize("host", input_hosts.HOSTS)
@pytest.mark.parametrize("name", INPUTS)
def test_a_right_mesh_or_a_sentence(build, server, pymeshlab, first_of, tmp_path, name, host):
    outcome = input_hosts.try_out(build, server, pymeshlab, host, INPUTS[name], tmp_path)
    told = outcome.sentence or [outcome.told[key] for key in COUNTS]
    assert told == first_of.setdefault(name, told), "another result than in the first host"
    input_hosts.judge(build, INPUTS[name], outcome)
