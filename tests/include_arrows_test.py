#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Which folder of vcg_core/ may include which: data flows one way, and no include leads back up."""

import re
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
ABOVE_ALL = {"the top", "c_api"}  # the files directly in vcg_core/, and the interface for C, may include all
MAY_INCLUDE = {  # beside its own files
    "learning": {"paper", "topology", "engine", "mesh", "cloud", "base"},
    "paper": {"engine", "mesh", "cloud", "base"},
    "topology": {"mesh", "cloud", "base"},
    "engine": {"mesh", "cloud", "base"},
    "start": {"mesh", "cloud", "base"},
    "fit": {"mesh", "cloud", "base"},
    "output": {"learning", "mesh", "cloud", "base"},
    "mesh": {"base"},
    "cloud": {"base"},
    "base": set(),
}
INCLUDE = re.compile(r'\s*#\s*include\s*"([^"]+)"')


def forbidden_includes(root):
    """One sentence for each include in root/vcg_core that MAY_INCLUDE does not allow."""
    for file in sorted((root / "vcg_core").rglob("*.[hc]*")):
        path = file.relative_to(root)
        folder = path.parts[1] if len(path.parts) > 2 else "the top"
        if folder not in MAY_INCLUDE and folder not in ABOVE_ALL:
            yield f"{path}: the folder {folder} has no row in MAY_INCLUDE."
            continue
        for number, line in enumerate(file.read_text().splitlines(), 1):
            if not (found := INCLUDE.match(line)):
                continue
            parts = found[1].split("/")
            if parts[0] != "vcg_core":
                yield f"{path}:{number}: {found[1]} is not in vcg_core/."
            elif folder not in ABOVE_ALL and parts[1] not in MAY_INCLUDE[folder] | {folder}:
                target = parts[1] if len(parts) > 2 else f"the top ({parts[1]})"
                yield f"{path}:{number}: {folder} must not include {target}."


class IncludeArrows(unittest.TestCase):
    def test_the_core_has_no_forbidden_include(self):
        found = list(forbidden_includes(ROOT))
        self.assertFalse(found, "\n" + "\n".join(found))


if __name__ == "__main__":
    sys.exit(unittest.main())
