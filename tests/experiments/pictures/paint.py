#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Pictures of meshes and points, drawn from far to near, and sheets of them.

    paint.py MESH.ply OUT.png    a binary file of triangles with vertex colours

Needs numpy and Pillow alone, which `./run.sh demo` installs."""

import sys
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

LARGER = 3  # pictures are drawn so many times as large, then averaged
PLAIN, INK, TEXT, GAP = (205, 208, 214), (30, 30, 40), (25, 25, 30), 12
TYPES = {"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4", "float": "f4",
         "double": "f8", "uint8": "u1", "int32": "i4", "float32": "f4", "float64": "f8"}


class Drawing:
    """An empty picture of a size, seen from the direction `towards`, scaled to what is shown."""

    def __init__(self, shown, size, towards=(0, 0, 1), up=(0, 1, 0)):
        z = np.divide(towards, np.linalg.norm(towards))
        x = np.cross(up, z) / np.linalg.norm(np.cross(up, z))
        self.axes, self.size = np.array([x, np.cross(z, x), z]), LARGER * np.array(size)
        low, high = (shown @ self.axes.T).min(0), (shown @ self.axes.T).max(0)
        self.scale, self.middle = .94 * (self.size / (high - low)[:2]).min(), (low + high) / 2
        self.image = Image.new("RGB", tuple(self.size), "white")
        self.draw = ImageDraw.Draw(self.image)

    def places(self, points):
        """x and y in pixels, and the height above the picture."""
        return ((points @ self.axes.T - self.middle) * self.scale) * (1, -1, 1) + (*self.size / 2, 0)

    def points(self, points, width=2):
        pixels = np.array(self.image)
        x, y, _ = self.places(points).round().astype(int).T
        for right, down in np.ndindex(width, width):
            inside = (x + right >= 0) & (x + right < self.size[0]) & (y + down >= 0) & (y + down < self.size[1])
            pixels[(y + down)[inside], (x + right)[inside]] = INK
        self.image = Image.fromarray(pixels)
        return self

    def mesh(self, vertices, faces, colors=None, outline=INK):
        """Both sides of faces, lit by the viewer. colors: of the vertices, 0 to 255."""
        corners = self.places(vertices)[faces]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        lit = np.abs(normals[:, 2]) / np.maximum(np.linalg.norm(normals, axis=1), 1e-300)
        paint = np.broadcast_to(PLAIN, (len(faces), 3)) if colors is None else np.asarray(colors)[faces].mean(axis=1)
        paint = (paint * (.5 + .5 * lit[:, None])).astype(int)
        for f in np.argsort(corners[:, :, 2].mean(axis=1)):
            self.draw.polygon([tuple(p) for p in corners[f, :, :2]], fill=tuple(paint[f]), outline=outline or tuple(paint[f]))
        return self

    def lines(self, vertices, edges, color, width=6):
        places = self.places(vertices)
        for one, other in edges:
            self.draw.line([*places[one][:2], *places[other][:2]], fill=color, width=width)
        return self

    def done(self):
        return self.image.resize(tuple(self.size // LARGER), Image.LANCZOS)


def font(size=18):
    try:
        return ImageFont.truetype("DejaVuSans.ttf", size)
    except OSError:
        return ImageFont.load_default()


def save(image, path):
    """With a palette, which makes the file small; its nearly white is white."""
    palette = image.quantize(256, method=Image.Quantize.MAXCOVERAGE, kmeans=10)
    palette.putpalette([255 if value >= 250 else value for value in palette.getpalette()])
    image.quantize(palette=palette).save(path, optimize=True)


def sheet(path, rows, captions, ramp=None):
    """Rows of pictures of one size, captions below each row or none, and a ramp of colours from low to high."""
    (width, height), line = rows[0][0].size, 30
    result = Image.new("RGB", (len(rows[0]) * (width + GAP) + GAP,
                               sum(height + GAP + line * bool(words) for words in captions) + GAP + 2 * line * bool(ramp)),
                       "white")
    draw, top = ImageDraw.Draw(result), GAP
    for row, words in zip(rows, captions):
        for column, picture in enumerate(row):
            left = GAP + column * (width + GAP)
            result.paste(picture, (left, top))
            if words:
                draw.text((left + width / 2, top + height + line / 2), words[column], TEXT, font(), anchor="mm")
        top += height + GAP + line * bool(words)
    for x, color in enumerate(ramp or ()):
        draw.line([result.width / 2 - len(ramp) / 2 + x, top, result.width / 2 - len(ramp) / 2 + x, top + 20], fill=color)
    if ramp:
        for side, word, anchor in ((-1, "feature counter   low", "rm"), (1, "high", "lm")):
            draw.text((result.width / 2 + side * (len(ramp) / 2 + GAP), top + 10), word, TEXT, font(), anchor=anchor)
    save(result, path)


def ramp_of(counters, colors, steps=320):
    """The colours of a mesh from its lowest counter to the highest but one in a hundred."""
    order = np.argsort(counters, kind="stable")
    at = np.searchsorted(counters[order], np.linspace(*np.quantile(counters, (0, .99)), steps))
    return [tuple(map(int, colors[order][i])) for i in at]


def read_ply(path):
    """Vertices, faces and vertex colours."""
    content = Path(path).read_bytes()
    header, _, data = content.partition(b"end_header\n")
    fields, counts, kind = {"vertex": [], "face": []}, {}, None
    for words in map(str.split, header.decode().splitlines()):
        if words[0] == "element":
            kind = words[1]
            counts[kind] = int(words[2])
        elif words[0] == "property" and words[1] == "list":
            fields[kind] += [("count", "u1"), ("corners", "<" + TYPES[words[3]], 3)]
        elif words[0] == "property":
            fields[kind].append((words[2], "<" + TYPES[words[1]]))
    vertices = np.frombuffer(data, fields["vertex"], counts["vertex"])
    faces = np.frombuffer(data, fields["face"], counts["face"], vertices.nbytes)
    return (np.column_stack([vertices[axis] for axis in "xyz"]).astype(float), faces["corners"],
            np.column_stack([vertices[channel] for channel in ("red", "green", "blue")]))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    mesh = read_ply(sys.argv[1])
    save(Drawing(mesh[0], (600, 600)).mesh(*mesh).done(), sys.argv[2])
