#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Constants of a file differ from those of the other files in its folder and from those of all headers: files of a folder
are compiled together, where a constant in an anonymous namespace would silently take the place of a header's. The names
of the stages that a development build can skip are those that the code asks for, each at one place."""

import re
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
DEFINITION = re.compile(r"^(?:inline |static )?constexpr [\w:<>*]+ (?:const )?(k\w+[^;]*);", re.MULTILINE)
NAME = re.compile(r"(k[A-Z]\w*)(?:\[\w*\])? = ")


def constants_of(path):
    return [name for line in DEFINITION.findall(path.read_text()) for name in NAME.findall(line)]


def shared_names(root):
    """One sentence for each constant of a source file that another file or a header defines, too."""
    core = root / "vcg_core"
    of_headers = {name: path for path in sorted(core.rglob("*.h")) for name in constants_of(path)}
    in_folder = {}
    for path in sorted(core.rglob("*.cpp")):
        for name in constants_of(path):
            other = of_headers.get(name) or in_folder.get((path.parent, name))
            in_folder.setdefault((path.parent, name), path)
            if other:
                yield f"{name} is defined in {path.relative_to(root)} and in {other.relative_to(root)}."


def stages(root):
    """The names that vcg_core/base/ablation.h lists, and those that skips() is asked for, one for each place."""
    listed = re.search(r"kStages\[\] = \{(.*?)\};", (root / "vcg_core/base/ablation.h").read_text(), re.DOTALL)[1]
    asked = [name for path in sorted((root / "vcg_core").rglob("*.[hc]*"))
             for name in re.findall(r'\bskips\("(\w+)"\)', path.read_text())]
    return re.findall(r'"(\w+)"', listed), asked


class Names(unittest.TestCase):
    def test_each_stage_is_skipped_at_one_place(self):
        listed, asked = stages(ROOT)
        self.assertGreater(len(listed), 20)
        self.assertEqual(sorted(listed), sorted(asked))

    def test_constants_of_a_folder_differ(self):
        found = list(shared_names(ROOT))
        self.assertFalse(found, "\n" + "\n".join(found))


if __name__ == "__main__":
    sys.exit(unittest.main())
