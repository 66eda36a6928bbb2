# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Rows of pictures on one sheet, with captions and their colour scale."""

from dataclasses import dataclass

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from meshlab_picture_ply import read_vertices

TEXT_COLOR = (25, 25, 30)
GAP = 12


@dataclass
class Legend:
    """A colour scale: colours from low to high and the words at its ends."""
    title: str
    colors: list
    low: str
    high: str


def legend_of_mesh(path, title, steps=128):
    """The colour scale of a mesh, derived from the quality and colours of its vertices.

    So it cannot differ from what the filter did. The ends are where the colour stops changing.
    Raises ValueError when the mesh lacks quality or colours.
    """
    vertices = read_vertices(path)
    names = vertices.dtype.names
    value_name = next((name for name in ("quality", "scalar", "confidence") if name in names), None)
    if value_name is None or "red" not in names or len(vertices) < 2:
        raise ValueError(f"{path} has no vertex quality and colours to make a legend of.")
    values = vertices[value_name].astype("f8")
    order = np.argsort(values, kind="stable")
    colors = np.column_stack([vertices[name] for name in ("red", "green", "blue")])[order].astype("f8")
    values = values[order]
    changing = np.flatnonzero((colors != colors[0]).any(axis=1) & (colors != colors[-1]).any(axis=1))
    first, last = (changing[0], changing[-1]) if len(changing) else (0, len(values) - 1)
    at = np.linspace(values[first], values[last], steps)
    ramp = [tuple(int(round(np.interp(value, values, colors[:, channel]))) for channel in range(3))
            for value in at]
    return Legend(title, ramp, f"{values[first]:.2g}", f"{values[last]:.2g}")


def font(size):
    try:
        return ImageFont.truetype("DejaVuSans.ttf", size)
    except OSError:
        return ImageFont.load_default()


def draw_legend(sheet, legend, top, text_size):
    """Draws the scale centred under the rows, its words beside it."""
    draw = ImageDraw.Draw(sheet)
    letters = font(text_size)
    width = min(sheet.width // 3, 320)
    left = (sheet.width - width) // 2
    for x in range(width):
        color = legend.colors[x * (len(legend.colors) - 1) // (width - 1)]
        draw.line([(left + x, top), (left + x, top + text_size)], fill=color)
    middle = top + text_size / 2
    low = f"{legend.title}   {legend.low}" if legend.title else legend.low
    draw.text((left - GAP, middle), low, TEXT_COLOR, letters, anchor="rm")
    draw.text((left + width + GAP, middle), legend.high, TEXT_COLOR, letters, anchor="lm")


def contact_sheet(rows, captions, out, legend=None, text_size=18):
    """Puts rows of equally large Pillow images on one sheet and saves it. captions: the same shape, one line of text
    under each picture, "" for none. legend: a Legend under the last row."""
    cell_width = max(image.width for row in rows for image in row)
    line = round(1.7 * text_size)
    heights = [max(image.height for image in row) + (line if any(texts) else 0)
               for row, texts in zip(rows, captions)]
    columns = max(len(row) for row in rows)
    width = columns * cell_width + (columns + 1) * GAP
    height = sum(heights) + (len(rows) + 1) * GAP + (line + GAP if legend else 0)
    sheet = Image.new("RGB", (width, height), "white")
    draw, letters, top = ImageDraw.Draw(sheet), font(text_size), GAP
    for row, texts, row_height in zip(rows, captions, heights):
        for column, (image, text) in enumerate(zip(row, texts)):
            left = GAP + column * (cell_width + GAP) + (cell_width - image.width) // 2
            sheet.paste(image, (left, top))
            if text:
                draw.text((left + image.width / 2, top + row_height - line / 2), text, TEXT_COLOR, letters,
                          anchor="mm")
        top += row_height + GAP
    if legend:
        draw_legend(sheet, legend, top, text_size)
    sheet.save(out)
