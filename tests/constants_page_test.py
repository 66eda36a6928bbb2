#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The page of constants is that of the code, and the script that makes it reads the code as it should."""

import sys
import tempfile
import unittest
from pathlib import Path

import constants_page

SAMPLE = """/// Of the points. With .3 the error of
/// bunny is 1.1 times.
constexpr double kShare = 0.2, kOther = 0.3;
constexpr int kNext = 4;

constexpr float kWeights[] = {1, 2,
                              3};  ///< beside
void f() {
    constexpr double kBelow = 0.75;  // of the spacing
    constexpr int kChunk = 512;
    if (noise < kBelow && points_per_vertex >= 3) return;
    if (noise > other || skips("stage")) return;
    x = calm ? kShare : kOther;
}
constexpr int at(int i) { return i; }
"""


class ConstantsPage(unittest.TestCase):
    def test_the_page_is_up_to_date(self):
        self.assertTrue(constants_page.is_current(constants_page.ROOT),
                        "vcg_core/what_steers_the_result.md is out of date: run tests/constants_page.py.")

    def test_constants_are_read_with_their_reasons(self):
        found = constants_page.constants_of("fit/a.cpp", SAMPLE)
        self.assertEqual([c.names for c in found], [["kShare", "kOther"], ["kNext"], ["kWeights"], ["kBelow"], ["kChunk"]])
        self.assertEqual([c.values for c in found], [["0.2", "0.3"], ["4"], ["{1, 2, 3}"], ["0.75"], ["512"]])
        self.assertEqual(found[0].reason, "Of the points. With .3 the error of bunny is 1.1 times.")
        self.assertTrue(found[1].above and not found[0].above)
        self.assertEqual([c.reason for c in found[2:]], ["beside", "of the spacing", ""])
        self.assertEqual([bool(constants_page.why_inert(c)) for c in found], [False, False, False, False, True])
        self.assertEqual(constants_page.unit_of(found[3]), "spacings")

    def test_thresholds_are_found_once_for_each_subject(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder, "vcg_core", "fit", "a.cpp")
            file.parent.mkdir(parents=True)
            file.write_text(SAMPLE)
            found = constants_page.thresholds(Path(folder))
        self.assertEqual([subjects for _, _, subjects in found], [["noise", "points per vertex"], ["noise"]])


if __name__ == "__main__":
    sys.exit(unittest.main())
