#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Uses the filter in MeshLab's window: opens a cloud, finds the filter by the filter search, opens its dialog and
applies it. Saves screenshots of the dialog and of the result.

    gui_filter.py --plugin libfilter_neuralmesh.so --cloud CLOUD.ply --out FOLDER
    gui_filter.py --root FOLDER ...      the MeshLab installed in a Debian root directory (needs root)

Fails if MeshLab does not load the plugin, the filter reports a failure, or the result shows no colours.
"""

import argparse
import os
import re
import shutil
import sys
from pathlib import Path

import numpy as np

from gui_session import GuiError, GuiSession, require_programs, wait_until

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "experiments" / "pictures"))

from meshlab_picture import LIBRARIES, PLUGINS, program_copy  # noqa: E402

FILTER = "Surface Reconstruction: Neural Mesh"
SCREEN = (1440, 1080)
# A mesh coloured by its counter has thousands of pixels of strong colour; MeshLab's background and log area have
# none that count_colorful() counts.
COLORFUL_PIXELS = 3000

SETTINGS = """[General]
dontRemindMeAboutUpgrade=true
dontRemindMeToSendEmail=true
checkForUpdate=false
lastTimeMeshLabVersionCheckedOnStart=Tue Jan 1 2999
"""

# Run in a private mount namespace, so that the bind mounts end with the program.
ENTER_ROOT = """
mount --rbind /dev "$0/dev" && mount -t proc proc "$0/proc" &&
mkdir -p "$0/tmp/.X11-unix" && mount --bind /tmp/.X11-unix "$0/tmp/.X11-unix" &&
exec chroot "$0" sh -c 'cd "$0" && exec meshlab cloud.ply' /tmp/neural_mesh_gui
"""


def all_plugins(plugin):
    """MeshLab's plugins, except the one that program_copy() adds, and ours."""
    own = [path for path in sorted(PLUGINS.glob("*.so")) if path.name not in ("libio_base.so", plugin.name)]
    return own + [plugin]


def start_installed(session, plugin, cloud):
    """Starts this machine's MeshLab with the plugin beside a copy of it."""
    shutil.copy(cloud, Path(session.directory) / "cloud.ply")
    folder = Path(session.directory) / "config" / "VCG"
    folder.mkdir(parents=True)
    (folder / "MeshLab_64bit_fp.conf").write_text(SETTINGS)
    session.start([program_copy(session.directory, all_plugins(plugin)), "cloud.ply"],
                  LD_LIBRARY_PATH=LIBRARIES)


def start_in_root(session, root, plugin, cloud):
    """Starts the MeshLab of another Debian, installed under `root`, with a copy of the plugin."""
    require_programs("unshare", "chroot")
    if not (root / "usr/bin/meshlab").exists():
        raise GuiError(f"There is no MeshLab in {root}: make it with gui_debian_root.sh.")
    home = root / "tmp/neural_mesh_gui"
    shutil.rmtree(home, ignore_errors=True)
    (home / "config" / "VCG").mkdir(parents=True)
    home.chmod(0o700)
    (home / "config" / "VCG" / "MeshLab_64bit_fp.conf").write_text(SETTINGS)
    shutil.copy(cloud, home / "cloud.ply")
    # Plugins that an earlier run has copied would be loaded as well.
    for earlier in (root / PLUGINS.relative_to("/")).glob("libfilter_neuralmesh*"):
        earlier.unlink()
    if plugin.resolve().parent != PLUGINS:
        shutil.copy(plugin, root / PLUGINS.relative_to("/"))
    inside = "/tmp/neural_mesh_gui"
    session.start(["unshare", "--mount", "sh", "-c", ENTER_ROOT, str(root)], HOME=inside,
                  XDG_CONFIG_HOME=inside + "/config", XDG_RUNTIME_DIR=inside)


def geometry(session, window):
    """x, y, width and height of a window in pixels."""
    words = dict(word.split("=") for word in session.xdotool("getwindowgeometry", "--shell", window).split())
    return tuple(int(words[name]) for name in ("X", "Y", "WIDTH", "HEIGHT"))


def drawing_area(session, main_window):
    """Width and height of MeshLab's drawing area: the largest window inside the main one."""
    def sizes():  # empty for a moment while windows come and go
        areas = [geometry(session, window)[2:] for window in session.windows("") if window != main_window]
        return [area for area in areas if area[0] < session.width and area[1] < session.height]
    return max(wait_until(sizes, "MeshLab's drawing area", 10), key=lambda size: size[0] * size[1])


def open_filter(session, main_window, name):
    """Finds the filter by the filter search (Ctrl+F) and opens its dialog; returns its window."""
    title = "^" + re.escape(name) + "$"

    def search():
        session.check_alive()
        session.keys(main_window, "Escape")
        before = len(session.windows(""))
        session.keys(main_window, "ctrl+f")
        try:
            wait_until(lambda: len(session.windows("")) > before, "the search box", 3)
            session.xdotool("type", "--delay", 30, name)
            session.steady_screenshot()
            session.xdotool("key", "--delay", 60, "Down", "Return")
            return session.wait_for_window(title, 5)
        except GuiError:  # a key pressed too early is lost: the whole step is tried again
            session.check_alive()
            return None
    return wait_until(search, f"the dialog of '{name}' (is the plugin loaded?)", 30)


def lay_out(session, dialog):
    """Moves the dialog over the layer list, tall enough for all parameters; the cloud stays visible."""
    width, top = 530, 66
    place = (session.width - width - 6, top, width, session.height - top - 6)

    def placed():
        session.xdotool("windowmove", dialog, *place[:2], "windowsize", dialog, *place[2:])
        return abs(geometry(session, dialog)[3] - place[3]) <= 2
    wait_until(placed, "the dialog's new size", 10)


def press(session, dialog, column):
    """Presses one of the two buttons of the dialog's last row: 0 Close, 1 Apply."""
    x, y, width, height = geometry(session, dialog)
    session.click(x + width * (1 + 2 * column) // 4, y + height - 20)


def apply_filter(session, dialog, seconds):
    """Presses Apply and waits until MeshLab logs that the filter ran; raises GuiError if it failed."""
    def finished():
        session.check_alive()
        if session.windows("Filter Failure|Filtering Error|Uncaught|Error"):
            raise GuiError("MeshLab reports that the filter failed.\n" + session.log())
        return re.search(r"Applied filter:? ", session.log())
    press(session, dialog, 1)
    wait_until(finished, "the filter to end", seconds)


def count_colorful(picture, size):
    """Pixels of the drawing area with a strong colour other than MeshLab's blue and red."""
    width, height = size
    area = np.asarray(picture.crop((2, 160, width - 2, 160 + height - 260)).convert("RGB")).astype(int)
    red, green, blue = area[..., 0], area[..., 1], area[..., 2]
    return int(np.count_nonzero((green - np.minimum(red, blue) > 60)))


def wait_for_main_window(session):
    """MeshLab's main window; raises GuiError if MeshLab lists plugins that it could not load instead."""
    def look():
        session.check_alive()
        if session.windows("^Error while loading plugins"):
            raise GuiError("MeshLab could not load some plugins, see failure.png.")
        return session.windows(r"^MeshLab 20")
    return wait_until(look, "MeshLab's window", 60)[-1]


def run(session, options):
    """The steps after the start of the program; returns the lines of its log about the filter."""
    out = Path(options.out)
    out.mkdir(parents=True, exist_ok=True)
    window = wait_for_main_window(session)
    session.wait_for_log("Opened mesh")
    session.fill_screen(window)
    version = re.search(r"20\d\d\.\d\d", session.xdotool("getwindowname", window)).group()
    dialog = open_filter(session, window, options.filter)
    lay_out(session, dialog)
    session.steady_screenshot().save(out / f"meshlab_{version}_dialog.png")
    apply_filter(session, dialog, options.seconds)
    press(session, dialog, 0)
    wait_until(lambda: not session.windows("^" + re.escape(options.filter) + "$"), "the dialog to close", 10)
    size = drawing_area(session, window)
    # The points of the cloud lie in the new surface; the eye beside the first layer hides them.
    session.click(size[0] + 36, 111)
    session.click(size[0] + 130, 143)  # the new layer is the current one
    session.keys(window, "shift+h")  # hides the trackball's circle
    session.xdotool("mousemove", size[0] + 60, 330)
    picture = session.steady_screenshot()
    picture.save(out / f"meshlab_{version}_result.png")
    colorful = count_colorful(picture, size)
    if options.filter == FILTER and colorful < COLORFUL_PIXELS:
        raise GuiError(f"The result shows no colours ({colorful} colourful pixels): see {out}.")
    log = [line for line in session.log().splitlines() if line.startswith("LOG")]
    print(f"MeshLab {version}: {colorful} colourful pixels; the log says:", *log, sep="\n  ")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--plugin", type=Path, required=True)
    parser.add_argument("--cloud", type=Path, required=True)
    parser.add_argument("--out", default="out/gui", help="folder of the screenshots")
    parser.add_argument("--root", type=Path, help="Debian root directory with a MeshLab")
    parser.add_argument("--filter", default=FILTER)
    parser.add_argument("--seconds", type=float, default=120.0, help="longest run of the filter")
    options = parser.parse_args()
    for path in (options.plugin, options.cloud):
        if not path.exists():
            raise GuiError(f"{path} does not exist.")
    with GuiSession(*SCREEN) as session:
        try:
            if options.root:
                start_in_root(session, options.root, options.plugin, options.cloud)
            else:
                start_installed(session, options.plugin, options.cloud)
            run(session, options)
        except GuiError:
            os.makedirs(options.out, exist_ok=True)
            session.screenshot().save(Path(options.out) / "failure.png")
            sys.stderr.write(session.log() if Path(session.log_path).exists() else "")
            raise


if __name__ == "__main__":
    try:
        main()
    except (GuiError, OSError) as error:
        sys.exit(f"gui_filter: {error}")
