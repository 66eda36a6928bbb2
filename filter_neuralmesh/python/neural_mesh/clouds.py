# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Files of points, read in chunks, so that a cloud need not fit into memory: PLY, lines of text, LAS, LAZ, E57."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import BinaryIO, Dict, Iterator, Optional, Union

import numpy as np

TEXT = (".xyz", ".txt", ".asc", ".csv", ".pts")
FORMATS = (".ply", *TEXT, ".las", ".laz", ".e57")


class CloudError(Exception):
    """A sentence that says what is wrong with a file of points."""


class Cloud:
    """A file of points. `count`: how many it holds, None if only reading tells. `done`: the part, 0 to 1, that the
    chunks taken so far are of the file."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.count: Optional[int] = None
        self.done = 0.0

    def chunks(self, size: int) -> Iterator[np.ndarray]:
        """All points in the order of the file, as (n, 3) arrays of double with n <= size. Can be called again.
        Raises CloudError if the file ends early or cannot be read."""
        self.done = 0.0
        read = 0
        try:
            for points in self._read(size):
                read += len(points)
                if self.count:
                    self.done = min(1.0, read / self.count)
                yield points
        except (CloudError, MemoryError):
            raise
        except Exception as error:  # the packages that read LAS and E57 raise types of their own
            raise CloudError(f"{self.path} cannot be read: {_one_line(error)}.") from error
        if self.count is not None and read < self.count:
            raise _cut_short(self.path, self.count, read)

    def _read(self, size: int) -> Iterator[np.ndarray]:
        raise NotImplementedError


def open_cloud(path: Path) -> Cloud:
    """The cloud of a file, by its ending. Reads the header only. Raises CloudError with a sentence."""
    kind = path.suffix.lower()
    if kind not in FORMATS:
        raise CloudError(f"{path} has no ending that stream reads: {', '.join(FORMATS)}.")
    try:
        with path.open("rb") as file:
            empty = not file.read(1)
        if empty:
            raise CloudError(f"{path} is empty.")
        reader = {".ply": PlyCloud, ".las": LasCloud, ".laz": LasCloud, ".e57": E57Cloud}.get(kind, TextCloud)
        cloud = reader(path)
    except (CloudError, MemoryError):
        raise
    except Exception as error:
        raise CloudError(f"{path} cannot be read: {getattr(error, 'strerror', None) or _one_line(error)}.") from error
    if cloud.count == 0:
        raise CloudError(f"{path} holds no points.")
    return cloud


def finite(points: np.ndarray) -> Union[slice, np.ndarray]:
    """The index of the points, an (n, 3) array, without NaN or infinite coordinates."""
    with np.errstate(all="ignore"):
        if np.isfinite(points.sum()):  # much faster than to look at each; a sum that overflows costs time only
            return slice(None)
    return np.isfinite(points).all(axis=1)


def _one_line(error: Exception) -> str:
    return " ".join(str(error).split()).rstrip(".") or type(error).__name__


def _cut_short(path: Path, announced: int, held: int) -> CloudError:
    return CloudError(f"{path} is cut short: it announces {announced} points and holds {held}.")


def _missing(path: Path, extra: str, package: str) -> CloudError:
    return CloudError(f"{path} needs the package {package}: run pip install 'neural-mesh[{extra}]'.")


class PlyCloud(Cloud):
    """The vertices of a PLY file, ASCII or binary, with any properties that are no lists."""

    TYPES = {"char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2",
             "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "float": "f4", "float32": "f4",
             "double": "f8", "float64": "f8"}

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        with path.open("rb") as file:
            self._parse(self._header(file))
            self._start = file.tell()
        names = [name for name, _ in self._fields]
        if not all(axis in names for axis in "xyz"):
            raise CloudError(f"{path} has vertices without x, y and z.")
        self._columns = [names.index(axis) for axis in "xyz"]
        if self._order:
            self._record = np.dtype([(name, self._order + kind) for name, kind in self._fields])
            self._start += self._skipped
            held = max(0, path.stat().st_size - self._start) // self._record.itemsize
            if held < self.count:
                raise _cut_short(path, self.count, held)

    def _header(self, file: BinaryIO) -> list[list[str]]:
        lines: list[list[str]] = []
        while True:
            words = file.readline(4096).decode("ascii", "replace").split()
            if (not lines and words != ["ply"]) or len(lines) > 10000:
                raise CloudError(f"{self.path} is not a PLY file.")
            lines.append(words)
            if words == ["end_header"]:
                return lines
            if file.read(1) == b"":
                raise CloudError(f"{self.path} is cut short in its header.")
            file.seek(-1, 1)

    def _parse(self, lines: list[list[str]]) -> None:
        """Sets _order ('' for ASCII), _fields of a vertex, count, _skipped: bytes or lines before the vertices, and _others:
        how many other elements there are."""
        self._order, self._fields, self._skipped, self._others = "", [], 0, 0
        element, number = "", 0
        try:
            for words in lines:
                if words[:1] == ["format"]:
                    self._order = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}[words[1]]
                elif words[:1] == ["element"]:
                    element, number = words[1], int(words[2])
                    self._others += number * (element != "vertex")
                    if element == "vertex":
                        self.count = number
                    elif self.count is None and not self._order:
                        self._skipped += number
                elif words[:1] == ["property"] and words[1] == "list":
                    if element == "vertex" or (self.count is None and self._order):
                        raise CloudError(f"{self.path} has lists in or before its vertices, which is not supported.")
                elif words[:1] == ["property"]:
                    if element == "vertex":
                        self._fields.append((words[2], self.TYPES[words[1]]))
                    elif self.count is None and self._order:
                        self._skipped += number * np.dtype(self.TYPES[words[1]]).itemsize
        except (IndexError, KeyError, ValueError):
            raise CloudError(f"{self.path} has the header line '{' '.join(words)}', which is not PLY.") from None
        if self.count is None:
            raise CloudError(f"{self.path} has no vertices.")

    def arrays(self) -> Optional[Dict[str, np.ndarray]]:
        """All points, with normals and colours if there are any: arguments of reconstruct(). None if the file has faces or
        other elements, is ASCII, or has colours of an unusual kind. Raises CloudError."""
        if self._others or not self._order:
            return None
        try:
            records = np.fromfile(self.path, self._record, self.count, offset=self._start)
        except OSError as error:
            raise CloudError(f"{self.path} cannot be read: {error.strerror}.") from error
        kinds = dict(self._fields)
        if any(name.startswith("diffuse_") or (name == "red" and kind != "u1") for name, kind in self._fields):
            return None
        arrays = {}
        for what, names in (("points", ("x", "y", "z")), ("normals", ("nx", "ny", "nz")),
                            ("colors", ("red", "green", "blue"))):
            if all(name in kinds for name in names):
                arrays[what] = np.column_stack([records[name] for name in names])
        return arrays

    def _read(self, size: int) -> Iterator[np.ndarray]:
        with self.path.open("rb") as file:
            file.seek(self._start)
            if not self._order:
                for _ in range(self._skipped):
                    file.readline()
                yield from _Lines(self.path, file, self._columns, self.count).chunks(size)
                return
            for first in range(0, self.count, size):
                records = np.fromfile(file, self._record, min(size, self.count - first))
                points = np.empty((len(records), 3))
                for column, axis in enumerate("xyz"):
                    points[:, column] = records[axis]
                yield points


class TextCloud(Cloud):
    """One point a line, numbers between blanks, commas or semicolons: x y z first, or where a heading names them.
    Lines of text before the first point, a lone count among them, and empty lines and comments are skipped."""

    HEADING = 100  # more lines of text than this before the first point: not a cloud
    LINE = 65536  # bytes; longer lines are no points

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        self._columns = [0, 1, 2]
        with path.open("rb") as file:
            for _ in range(self.HEADING):
                self._start = file.tell()
                line = file.readline(self.LINE)
                words = line.lower().translate(_SEPARATORS).translate(None, b'"#/').split()
                if not line:
                    break
                if len(words) >= 3 and not line.lstrip().startswith(b"#") and all(map(_is_number, words[:3])):
                    return
                if all(axis in words for axis in (b"x", b"y", b"z")):
                    self._columns = [words.index(axis) for axis in (b"x", b"y", b"z")]
        raise CloudError(f"{path} has no line that begins with three numbers.")

    def _read(self, size: int) -> Iterator[np.ndarray]:
        total = self.path.stat().st_size
        with self.path.open("rb") as file:
            file.seek(self._start)
            for points in _Lines(self.path, file, self._columns, None).chunks(size):
                self.done = file.tell() / total
                yield points


_SEPARATORS = bytes.maketrans(b",;\t\r", b"    ")


def _is_number(word: bytes) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


class _Lines:
    """Numbers in lines, of which three columns are a point."""

    def __init__(self, path: Path, file: BinaryIO, columns: list[int], count: Optional[int]) -> None:
        self._path, self._file, self._columns, self._count = path, file, columns, count

    def chunks(self, size: int) -> Iterator[np.ndarray]:
        """At most `count` points; a line of text is at least six bytes, which bounds the points of a block."""
        rest, left = b"", self._count
        while left is None or left > 0:
            block = self._file.read(6 * size)
            text = rest + block
            end = text.rfind(b"\n") + 1 if block else len(text)
            rest = text[end:]
            if len(rest) > TextCloud.LINE:
                raise CloudError(f"{self._path} is not a text of points: a line has more than {TextCloud.LINE} bytes.")
            points = self._points(text[:end].translate(_SEPARATORS), left)[:left]
            for first in range(0, len(points), size):
                yield points[first:first + size]
            left = None if left is None else left - len(points)
            if not block:
                return

    def _points(self, text: bytes, left: Optional[int]) -> np.ndarray:
        """The points of whole lines: by one call if all lines have as many words, else line by line."""
        width = len(text[:text.find(b"\n")].split())
        if width > max(self._columns) and _all_lines_have(text, width):
            with warnings.catch_warnings():
                warnings.simplefilter("error")  # numpy warns at the first word that is no number
                try:
                    return np.fromstring(text, sep=" ").reshape(-1, width)[:, self._columns]
                except (ValueError, DeprecationWarning):
                    pass
        return self._point_by_point(text, left)

    def _point_by_point(self, text: bytes, left: Optional[int]) -> np.ndarray:
        points: list[list[float]] = []
        for line in text.splitlines():
            if len(points) == left:  # what follows, such as faces, may have fewer numbers
                break
            words = line.split()
            if not words or words[0].startswith((b"#", b"//")):
                continue
            try:
                points.append([float(words[column]) for column in self._columns])
            except (IndexError, ValueError):
                shown = line[:60].decode("ascii", "replace").strip()
                raise CloudError(f"{self._path} has the line '{shown}', which is not a point.") from None
        return np.array(points, dtype=float).reshape(-1, 3)


def _all_lines_have(text: bytes, width: int) -> bool:
    letters = np.frombuffer(text, np.uint8)
    blank = letters <= 32
    starts = ~blank
    starts[1:] &= blank[:-1]
    words_before = np.cumsum(starts, dtype=np.int32)[letters == 10]
    if not text.endswith(b"\n"):
        words_before = np.append(words_before, np.count_nonzero(starts))
    return bool((words_before == width * np.arange(1, len(words_before) + 1)).all())


class LasCloud(Cloud):
    """LAS, and LAZ by laspy's decoder lazrs. Coordinates are scaled as the header says."""

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        try:
            import laspy
        except ImportError:
            raise _missing(path, "las", "laspy") from None
        self._open = laspy.open
        with self._open(str(path)) as file:
            header = file.header
            self.count = header.point_count
            held = (path.stat().st_size - header.offset_to_point_data) // header.point_format.size
            if not header.are_points_compressed and held < self.count:
                raise _cut_short(path, self.count, held)
            if header.are_points_compressed and file.laz_backend is None:
                raise _missing(path, "las", "lazrs")

    def _read(self, size: int) -> Iterator[np.ndarray]:
        with self._open(str(self.path)) as file:
            for records in file.chunk_iterator(size):
                yield np.column_stack([records.x, records.y, records.z])


class E57Cloud(Cloud):
    """E57: all scans, one after the other, in blocks, placed by their poses. Points marked as invalid become NaN."""

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        try:
            import pye57
        except ImportError:
            raise _missing(path, "e57", "pye57") from None
        self._open = pye57.E57
        self._cartesian = pye57.utils.convert_spherical_to_cartesian
        with self._open(str(path)) as file:
            self.count = sum(file.get_header(scan).point_count for scan in range(file.scan_count))

    def _read(self, size: int) -> Iterator[np.ndarray]:
        with self._open(str(self.path)) as file:
            for scan in range(file.scan_count):
                yield from self._scan(file, file.get_header(scan), size)

    def _scan(self, file, header, size: int) -> Iterator[np.ndarray]:
        """Reads through the buffers of pye57: its read_scan() would load a whole scan."""
        kind, axes = "spherical", ("sphericalRange", "sphericalAzimuth", "sphericalElevation")
        if "cartesianX" in header.point_fields:
            kind, axes = "cartesian", ("cartesianX", "cartesianY", "cartesianZ")
        state = f"{kind}InvalidState"
        data, buffers = file.make_buffers([*axes, *({state} & set(header.point_fields))], size)
        reader = header.points.reader(buffers)
        while number := reader.read():
            points = np.column_stack([data[axis][:number] for axis in axes])
            if kind == "spherical":
                points = self._cartesian(points)
            if header.has_pose():
                points = points @ header.rotation_matrix.T + header.translation
            if state in data:
                points[data[state][:number] != 0] = np.nan
            yield points
        reader.close()
