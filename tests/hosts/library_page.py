# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The blocks of code of filter_neuralmesh/docs/python.md, and what they print.

    library_page.py [FIRST]    runs the blocks with the neural_mesh that Python finds, or the first FIRST of them, each
                               where the last one ended, and compares what they print with the page

Blocks that import what is not installed are left out. Standard library only, to be run in bare systems."""

import contextlib
import io
import re
import sys
from pathlib import Path

PAGE = Path(__file__).resolve().parents[2] / "filter_neuralmesh/docs/python.md"
BLOCK = re.compile(r"^```python\n(.*?)^```\n(?:```\n(.*?)^```\n)?", re.MULTILINE | re.DOTALL)


def blocks():
    """[(code, what the page says it prints)]"""
    return BLOCK.findall(PAGE.read_text(encoding="utf-8"))


def main():
    made, wrong, left_out = {}, 0, 0
    chosen = blocks()[:int((*sys.argv, 99)[1])]
    for number, (code, expected) in enumerate(chosen, 1):
        printed = io.StringIO()
        try:
            with contextlib.redirect_stdout(printed):
                exec(code, made)
        except ModuleNotFoundError as error:
            if error.name not in ("bpy", "open3d", "trimesh"):
                raise
            left_out += 1
            continue
        if not printed.getvalue().endswith(expected.removeprefix("...\n")):
            print(f"Block {number} printed\n{printed.getvalue()}instead of\n{expected}")
            wrong += 1
    print(f"{len(chosen) - left_out} blocks were run, {wrong} printed something else")
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main())
