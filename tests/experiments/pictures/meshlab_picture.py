#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Pictures of PLY files drawn by MeshLab 2020.09 on a virtual display.

In a project file each mesh is a layer with its rendering options and a matrix that places it in front of one fixed
orthographic camera. MeshLab's "Snap All Layers" then draws them all, without decorations, in one start of one to two
seconds.

    meshlab_picture.py MESH.ply OUT.png    a mesh with its vertex colours

Needs the Debian packages meshlab, xvfb, xdotool, libgl1-mesa-dri, and numpy and Pillow.
"""

import sys
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from PIL import Image

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "hosts"))

from gui_session import GuiSession, require_programs, wait_until  # noqa: E402
from meshlab_picture_ply import positions, read_vertices  # noqa: E402
from meshlab_picture_project import HALF_HEIGHT, VIEW_TEXT, project_text, settings_text  # noqa: E402

PROGRAM = "/usr/bin/meshlab"
PLUGINS = Path("/usr/lib/x86_64-linux-gnu/meshlab/plugins")
LIBRARIES = "/usr/lib/x86_64-linux-gnu/meshlab"

STYLES = ("wireframe", "flat", "smooth", "flat-lines", "smooth-lines", "points")
# MeshLab draws several pixels for each pixel of the picture; their average smooths the lines.
SUPERSAMPLING = 3
MARGIN = 0.03  # free border, as a part of the picture's height
# Size of the menus, tool bars and frames of MeshLab's window.
CHROME_HEIGHT = 130
CHROME_WIDTH = 60


@dataclass
class Picture:
    """One mesh with its style and camera.

    style: one of STYLES; "wireframe" hides the lines behind the surface.
    color: the file's vertex colours (on the surface, or on the points), else `surface_color`.
    view, up: direction from the mesh to the viewer and what points upwards, in the mesh's frame.
    line_width: pixels of the picture.
    fit_to: PLY files that must fit the picture as well, so that a row shares its scale. The mesh itself
    may be of any type MeshLab opens if these are given.
    """
    mesh: str
    style: str = "smooth"
    color: bool = False
    view: tuple = (0.0, 0.0, 1.0)
    up: tuple = (0.0, 1.0, 0.0)
    line_width: float = 0.8
    point_size: float = 1.0
    line_color: tuple = (30, 30, 40)
    surface_color: tuple = (205, 208, 214)
    fit_to: list = field(default_factory=list)


def camera_axes(view, up):
    """Rows: right, up and towards the viewer, orthonormal. Raises ValueError for a degenerate view."""
    towards = np.asarray(view, dtype="f8")
    right = np.cross(np.asarray(up, dtype="f8"), towards)
    if np.linalg.norm(right) < 1e-9 * max(1.0, np.linalg.norm(towards)):
        raise ValueError("The view direction and the upward direction must not be parallel.")
    towards = towards / np.linalg.norm(towards)
    right = right / np.linalg.norm(right)
    return np.array([right, np.cross(towards, right), towards])


def is_ply(path):
    return str(path).lower().endswith(".ply")


def layer_transformation(picture, aspect):
    """The 4 x 4 matrix that puts the picture's mesh centred and filling in front of the camera."""
    axes = camera_axes(picture.view, picture.up)
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for path in [picture.mesh, *picture.fit_to] if is_ply(picture.mesh) else picture.fit_to:
        seen = positions(read_vertices(path)) @ axes.T
        seen = seen[np.isfinite(seen).all(axis=1)]
        if len(seen):
            low, high = np.minimum(low, seen.min(axis=0)), np.maximum(high, seen.max(axis=0))
    if not np.isfinite(low).all():
        raise ValueError(f"{picture.mesh} has no vertex to draw.")
    half = np.maximum((high - low) / 2, 1e-12)
    scale = HALF_HEIGHT * (1 - 2 * MARGIN) / max(half[1], half[0] / aspect)
    matrix = np.eye(4)
    matrix[:3, :3] = scale * axes
    matrix[:3, 3] = -scale * (low + high) / 2
    return matrix


def program_copy(directory, plugins=()):
    """Copies MeshLab's program beside a plugins folder with links to just the named plugin files.

    MeshLab looks for plugins beside itself; loading one instead of eighty saves a second, and needs
    no right to write where the package lives. Returns the program's path.
    """
    require_programs(PROGRAM)
    folder = Path(directory) / "meshlab"
    (folder / "plugins").mkdir(parents=True)
    program = folder / "meshlab"
    program.write_bytes(Path(PROGRAM).read_bytes())
    program.chmod(0o755)
    for plugin in [PLUGINS / "libio_base.so", *map(Path, plugins)]:
        (folder / "plugins" / plugin.name).symlink_to(plugin.resolve())
    return str(program)


def write_settings(directory):
    """Puts the settings where a MeshLab started in this GuiSession directory finds them."""
    folder = Path(directory) / "config" / "VCG"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "MeshLab_64bit_fp.conf").write_text(settings_text())


def save_all_layers(session, window):
    """Opens File > Save Snapshot, ticks "Snap All Layers" and saves into the session's directory."""
    def open_dialog():
        session.check_alive()
        if not session.windows("^Save snapshot$"):
            session.keys(window, "Escape", "alt+f", "t")
            try:
                session.wait_for_window("^Save snapshot$", 3)
            except Exception:  # the menu is not ready; the caller tries again
                session.check_alive()
        return session.windows("^Save snapshot$")
    dialog = wait_until(open_dialog, "MeshLab's snapshot dialog", 40)[-1]
    # From the output folder over "...", base name and counter to the box; Return is "Save".
    session.keys(dialog, "Tab", "Tab", "Tab", "Tab", "space", "Return")


def load_when_complete(path):
    """The picture in a file, or None while it is missing or still being written."""
    try:
        with Image.open(path) as image:
            return image.convert("RGB")
    except (OSError, SyntaxError):
        return None


def snapshots(pictures, matrices, size):
    """Runs MeshLab once; returns its drawings, one per picture, as it saved them."""
    width, height = (SUPERSAMPLING * length for length in size)
    with GuiSession(width + CHROME_WIDTH, height + CHROME_HEIGHT) as session:
        directory = Path(session.directory)
        (directory / "project.mlp").write_text(project_text(pictures, matrices, SUPERSAMPLING))
        (directory / "view.xml").write_text(VIEW_TEXT)
        write_settings(directory)
        session.start([program_copy(directory), "project.mlp", "view.xml"], LD_LIBRARY_PATH=LIBRARIES)
        window = session.wait_for_window(r"^MeshLab 20")
        session.wait_for_log("Opened mesh", len(pictures))
        session.fill_screen(window)
        session.keys(window, "ctrl+l")  # hides the layer list: its width varies from start to start
        save_all_layers(session, window)
        files = [directory / f"snapshot00_L{index:02d}.png" for index in range(len(pictures))]
        return [wait_until(lambda path=path: session.check_alive() or load_when_complete(path),
                           "MeshLab's snapshot", 60) for path in files]


def cut_to_size(drawing, size):
    """Cuts the middle of MeshLab's drawing to the picture's shape and averages it to its size."""
    aspect = size[0] / size[1]
    height = drawing.height
    width = round(height * aspect)
    if width > drawing.width:
        raise RuntimeError(f"MeshLab drew {drawing.width} x {drawing.height} pixels, too narrow for "
                           f"{size[0]} x {size[1]}: raise CHROME_WIDTH.")
    left = (drawing.width - width) // 2
    return drawing.crop((left, 0, left + width, height)).resize(size, Image.LANCZOS)


def render(pictures, size=(600, 600)):
    """Draws all pictures in one run of MeshLab; returns Pillow images of exactly `size` pixels. Takes 2 to 4 s. Raises
    GuiError when MeshLab cannot be run, ValueError for a mesh that cannot be drawn as asked."""
    for picture in pictures:
        if picture.style not in STYLES:
            raise ValueError(f"There is no style '{picture.style}': it is one of {', '.join(STYLES)}.")
        if picture.color and is_ply(picture.mesh) and "red" not in read_vertices(picture.mesh).dtype.names:
            raise ValueError(f"{picture.mesh} has no vertex colours to show.")
    matrices = [layer_transformation(picture, size[0] / size[1]) for picture in pictures]
    return [cut_to_size(drawing, size) for drawing in snapshots(pictures, matrices, size)]


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    try:
        render([Picture(sys.argv[1], "flat-lines", True)])[0].save(sys.argv[2])
    except (RuntimeError, ValueError, OSError) as error:
        sys.exit(f"meshlab_picture: {error}")
