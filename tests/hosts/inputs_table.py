#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Prints a table of every input of inputs.py in every host, with the number of failures:

    build/venv/bin/python tests/hosts/inputs_table.py [--build DIR] [WORD...]

WORDs select the inputs whose name contains one of them. The exit code is 1 if anything failed.
"""

import argparse
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "experiments" / "accuracy"))

import input_hosts  # noqa: E402
import inputs  # noqa: E402
import meshlabserver  # noqa: E402


def cell(build, server, pymeshlab, host, layer):
    """(entry of the table, the failure)"""
    try:
        with tempfile.TemporaryDirectory() as folder:
            outcome = input_hosts.try_out(build, server, pymeshlab, host, layer, Path(folder))
            input_hosts.check(build, layer, outcome)
    except Exception as problem:  # any exception is a failure of this cell only
        return "FAILED", f"{type(problem).__name__}: {problem}"
    return ("sentence" if outcome.sentence else f"{outcome.report['rms_error']:.2f} %"), ""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=ROOT / "build")
    parser.add_argument("words", nargs="*", metavar="WORD")
    options = parser.parse_args()
    build = options.build.resolve()

    import pymeshlab
    pymeshlab.load_plugin(str(meshlabserver.plugin_path(build, "pymeshlab-2025.7")))
    problems, cells = [], 0
    print(f"{'input':26}" + "".join(f"{host:>24}" for host in input_hosts.HOSTS))
    with tempfile.TemporaryDirectory() as scratch:
        server = meshlabserver.make_folder(Path(scratch) / "meshlab", meshlabserver.plugin_path(build))
        for name, layer in inputs.all_inputs().items():
            if options.words and not any(word in name for word in options.words):
                continue
            row = [cell(build, server, pymeshlab, host, layer) for host in input_hosts.HOSTS]
            cells += len(row)
            print(f"{name:26}" + "".join(f"{word:>24}" for word, _ in row), flush=True)
            problems += [f"{name}, {host}: {problem}" for host, (_, problem) in zip(input_hosts.HOSTS, row) if problem]
    print(f"{len(problems)} of {cells} failed; numbers are the reported errors, in % of the diagonal")
    print("\n".join(problems))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
