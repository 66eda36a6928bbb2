#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The page of constants is that of the code."""

import sys
import unittest

import constants_page

class ConstantsPage(unittest.TestCase):
    def test_the_page_is_up_to_date(self):
        self.assertTrue(constants_page.is_current(constants_page.ROOT),
                        "vcg_core/what_steers_the_result.md is out of date: run tests/constants_page.py.")


if __name__ == "__main__":
    sys.exit(unittest.main())
