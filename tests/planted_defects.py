#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Plants small defects, one at a time, and says whether the first tier of the tests catches them.

    planted_defects.py [--tree DIR] [WORD...]    all defects, or those whose file or kind contains a WORD
    planted_defects.py --check                   only looks whether each still has its place

Works on a copy of the tree in build/planted/, or in DIR, a copy of your own; it builds there what a test needs and runs
the tests from the fastest to the slowest, those of the defect's folder first, up to the first that fails. Needs a
`./run.sh test` before. The defects are in planted_defects.txt: a line `FILE: KIND`, the lines to be replaced with `- `
before them, and the new ones with `+ `. They are found by their content, whatever their number and indentation, so a
changed line must be changed there, too. Ends with 1 if a defect is missed."""

import argparse
import os
import shutil
import signal
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
DEFECTS = Path(__file__).with_suffix(".txt")
FIRST_TIER = ["--label-exclude", "^full$"]


class PlaceError(Exception):
    """A defect's lines are not there, or more than once."""


@dataclass
class Defect:
    file: str
    kind: str
    old: list = field(default_factory=list)
    new: list = field(default_factory=list)

    def __str__(self):
        return f"{self.file}: {self.kind}"


def read_defects(path=DEFECTS):
    defects = []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if line.startswith("- "):
            defects[-1].old.append(line[2:].strip())
        elif line.startswith("+ "):
            defects[-1].new.append(line[2:].strip())
        elif line and not line.startswith("#"):
            file, colon, kind = line.partition(": ")
            if not colon:
                raise SystemExit(f"{path.name}:{number}: '{line}' is not of the form FILE: KIND.")
            defects.append(Defect(file, kind))
    return defects


def planted(text, defect):
    """The text with the defect. PlaceError: it has no place, or several."""
    lines = text.splitlines()
    bare = [line.strip() for line in lines]
    count = len(defect.old)
    places = [i for i in range(len(lines) - count + 1) if bare[i:i + count] == defect.old]
    if not defect.old or len(places) != 1:
        there = "is not there" if not places else f"is there {len(places)} times"
        raise PlaceError(f"{defect}: '{' / '.join(defect.old)}' {there}. Change {DEFECTS.name} with the code.")
    first = places[0]
    indent = lines[first][:len(lines[first]) - len(bare[first])]
    return "\n".join(lines[:first] + [indent + line for line in defect.new] + lines[first + count:]) + "\n"


def misplaced(defects, tree):
    """One sentence for each defect that cannot be planted in the tree."""
    for defect in defects:
        try:
            planted((tree / defect.file).read_text(encoding="utf-8"), defect)
        except PlaceError as error:
            yield str(error)
        except FileNotFoundError:
            yield f"{defect}: there is no such file. Change {DEFECTS.name} with the code."


# --- building and running --------------------------------------------------------------------------------------------


def run(command, limit=None, **options):
    """(status, output); ends all processes of the command after `limit` seconds, with the status None."""
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
                          start_new_session=True, **options) as process:
        try:
            output = process.communicate(timeout=limit)[0]
            return process.returncode, output
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            return None, process.communicate()[0]


class Tree:
    """A copy of the sources with its build folder."""

    def __init__(self, folder):
        self.folder = folder
        self.build = folder / "build"
        self.seconds = {}

    def target_of(self, test):
        """What has to be built for a test of ctest."""
        if test.startswith("test_"):
            return ["plugins", "parameter_table"]
        if test == "Instructions.PerSignal":
            return ["learning_loop"]
        return [] if test in ("include_arrows_test", "portability_test", "names_test") else [test]

    def compile(self, targets):
        """The compiler's output if it fails, else nothing."""
        if not targets:
            return ""
        status, output = run(["cmake", "--build", str(self.build), "--target", *targets])
        return output if status != 0 else ""

    def passes(self, test):
        """Whether the test passes, in some ten times its usual time."""
        limit = 60 + 10 * self.seconds.get(test, 60)
        return run(["ctest", "--test-dir", str(self.build), "--tests-regex", f"^{test}$", "--no-tests=error"], limit)[0] == 0

    def read_times(self):
        """The seconds of each test in the first tier, by ctest's file."""
        for case in ElementTree.parse(self.build / "tests.xml").getroot().iter("testcase"):
            if case.get("status") == "run":
                self.seconds[case.get("name")] = float(case.get("time"))

    def prepare(self):
        """Builds and tests the tree as it is, unless that has been done."""
        if not (self.build / "tests.xml").exists():
            shutil.copytree(ROOT / "build/venv", self.build / "venv", symlinks=True, dirs_exist_ok=True)
            for command in (["cmake", "-S", str(self.folder), "-B", str(self.build), "-G", "Ninja",
                             "-DCMAKE_BUILD_TYPE=Release"],
                            ["cmake", "--build", str(self.build)],
                            ["ctest", "--test-dir", str(self.build), "--output-junit", "tests.xml", *FIRST_TIER]):
                status, output = run(command)
                if status != 0:
                    raise SystemExit(f"Without a defect '{' '.join(command)}' fails:\n{output[-3000:]}")
        self.read_times()

    def tests_for(self, file):
        """The tests, those of the file's folder first, then from the fastest to the slowest."""
        parts = Path(file).parts
        folder = parts[1] if parts[0] == "vcg_core" and len(parts) > 2 else "top"
        own = [f"unit_{folder}", f"sanitized_{folder}"] if parts[0] == "vcg_core" else ["actions_tests"]

        def rank(test):
            if parts[0] != "vcg_core" and test.startswith(("unit_", "sanitized_")):
                return 2, self.seconds[test]
            return 0 if test in own else 1, self.seconds[test]

        return sorted(self.seconds, key=rank)

    def catches(self, defect):
        """The name of the test that fails first, or None."""
        path = self.folder / defect.file
        text = path.read_text(encoding="utf-8")
        try:
            path.write_text(planted(text, defect), encoding="utf-8")
            for test in self.tests_for(defect.file):
                broken = self.compile(self.target_of(test))
                if broken:
                    return f"nothing: it does not compile:\n{broken[-2000:]}"
                if not self.passes(test):
                    return test
            return None
        finally:
            path.write_text(text, encoding="utf-8")


def copy_of_sources():
    """The files that git knows, in build/planted/; those that are as before keep their time."""
    folder = ROOT / "build/planted"
    names = subprocess.run(["git", "ls-files"], cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout.splitlines()
    for name in names:
        to = folder / name
        to.parent.mkdir(parents=True, exist_ok=True)
        if not to.exists() or to.read_bytes() != (ROOT / name).read_bytes():
            shutil.copy(ROOT / name, to)
    return folder


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tree", type=Path, metavar="DIR")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("words", nargs="*", metavar="WORD")
    options = parser.parse_args()
    defects = [one for one in read_defects() if not options.words or any(word in str(one) for word in options.words)]
    wrong = list(misplaced(defects, options.tree or ROOT))
    print("\n".join(wrong or [f"{len(defects)} defects, each with its place"]), flush=True)
    if wrong or options.check:
        return 1 if wrong else 0

    tree = Tree(options.tree or copy_of_sources())
    tree.prepare()
    missed = 0
    for defect in defects:
        start = time.monotonic()
        test = tree.catches(defect)
        missed += test is None or test.startswith("nothing")
        seconds = time.monotonic() - start
        print(f"{'caught by ' + test if test else 'MISSED'} in {seconds:.0f} s: {defect}", flush=True)
    print(f"{len(defects) - missed} of {len(defects)} defects caught")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
