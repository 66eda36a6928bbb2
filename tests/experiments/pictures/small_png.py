#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Makes PNG pictures small enough for a repository: small_png.py [--width PIXELS] FILE.png...

Replaces each file by one with a palette of 256 colours and, with --width, at most that width.
"""

import argparse
from pathlib import Path

from PIL import Image

# A white background, which averaging has made slightly grey.
NEARLY_WHITE = 250


def make_small(path, width=None):
    """Replaces the picture by one with a palette, unless that makes the file larger."""
    with Image.open(path) as file:
        image = file.convert("RGB")
    if width and width < image.width:
        image = image.resize((width, round(image.height * width / image.width)), Image.LANCZOS)
    before = Path(path).stat().st_size
    # Maximum coverage keeps rare colours; median cut would spend the palette on shades of the background.
    palette = image.quantize(256, method=Image.Quantize.MAXCOVERAGE, kmeans=10)
    palette.putpalette([255 if value >= NEARLY_WHITE else value for value in palette.getpalette()])
    small = image.quantize(palette=palette, dither=Image.Dither.FLOYDSTEINBERG)
    scratch = Path(path).with_suffix(".small.png")
    small.save(scratch, optimize=True)
    if scratch.stat().st_size < before:
        scratch.replace(path)
    else:
        scratch.unlink()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--width", type=int, help="greatest width in pixels")
    parser.add_argument("files", nargs="+", metavar="FILE.png")
    options = parser.parse_args()
    for path in options.files:
        make_small(path, options.width)


if __name__ == "__main__":
    main()
