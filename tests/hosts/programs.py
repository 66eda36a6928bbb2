# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Starts programs for the host tests. Standard library only."""

import os
import subprocess
import sys


def run(*words, **options):
    """The finished process, with what it has printed."""
    return subprocess.run([str(word) for word in words],
                          **{"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True, "check": False, **options})


def python(site, *words, **options):
    """The same of this Python, with the modules of the folder `site`."""
    return run(sys.executable, *words, env=dict(os.environ, PYTHONPATH=str(site)), **options)


def output_of(*words, **options):
    """What a program prints that must succeed."""
    done = run(*words, **options)
    assert done.returncode == 0, f"{' '.join(map(str, words))}: {(done.stdout or '')[-4000:]}{(done.stderr or '')[-4000:]}"
    return done.stdout
