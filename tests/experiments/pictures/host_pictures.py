#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Pictures of the filter in MeshLab's window: its dialog, and the mesh with its counters as colours beside the log.

    host_pictures.py [--build FOLDER] [--pictures FOLDER] [RELEASE...]

Needs xvfb and xdotool. 2020.09 is the installed MeshLab; the others are fetched as for the tests (tests/hosts/README.md)."""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "hosts"))

import demo  # noqa: E402
import library_hosts  # noqa: E402
import meshlabserver  # noqa: E402
import programs  # noqa: E402
from paint import save  # noqa: E402
from PIL import ImageGrab  # noqa: E402

FILTER, INSTALLED, SYSTEM = "Surface Reconstruction: Neural Mesh", "2020.09", meshlabserver.LIBRARIES.parent
# In pixels. The dialog of 2020.09 shows all parameters, for which the window becomes as high as the screen.
WIDTH, HEIGHT, SCREEN_HEIGHT = 1440, 1000, 1500
DRAWING = 888  # the width of the drawing area, which leaves the log more than by default
TOP, BOTTOM = 66, 34  # tool bar and status bar
# With these MeshLab does not look for a newer one, and asks nothing.
SETTINGS = ("[General]\ndontRemindMeAboutUpgrade=true\ndontRemindMeToSendEmail=true\n"
            "lastTimeMeshLabVersionCheckedOnStart=Tue Jan 1 2999\n")


def wait_for(what, found, seconds=60):
    """What found() returns once that is true."""
    end = time.monotonic() + seconds
    while not (result := found()):
        if time.monotonic() > end:
            sys.exit(f"MeshLab did not show {what} within {seconds} s.")
        time.sleep(.5)
    return result


def command_of(release, folder, plugin):
    """Makes a MeshLab in `folder` that loads its own plugins and ours. Returns its command and its variables."""
    libraries = SYSTEM if release == INSTALLED else library_hosts.libraries_of(release)
    (folder / "plugins").mkdir()
    for each in (*(libraries / "meshlab/plugins").glob("*.so"), plugin.resolve()):
        (folder / "plugins" / each.name).symlink_to(each)
    if release == INSTALLED:
        return [shutil.copy("/usr/bin/meshlab", folder)], {"LD_LIBRARY_PATH": libraries / "meshlab"}
    # Plugins are searched for beside what the kernel has started, the loader. The OpenGL driver is this system's.
    return ([shutil.copy(libraries / "ld-linux-x86-64.so.2", folder), "--library-path",
             f"{libraries / 'meshlab'}:{libraries}:{SYSTEM}", libraries.parents[1] / "bin/meshlab"],
            {"QT_PLUGIN_PATH": libraries / "qt5/plugins", "LD_PRELOAD": SYSTEM / "libGLX_mesa.so.0"})


class Window:
    """MeshLab with the bunny's points. The screen has no window manager: windows are placed and given the keyboard here."""

    def __init__(self, release, plugin, folder):
        self.log, self.display = folder / "log", meshlabserver.display(f"{WIDTH}x{SCREEN_HEIGHT}x24")
        command, variables = command_of(release, folder, plugin)
        (folder / "VCG").mkdir()
        (folder / "VCG/MeshLab_64bit_fp.conf").write_text(SETTINGS)
        shutil.copy(demo.bunny_points(), folder / "cloud.ply")
        variables.update(dict.fromkeys(("HOME", "XDG_CONFIG_HOME", "XDG_RUNTIME_DIR"), folder), DISPLAY=self.display,
                         LC_ALL="C.UTF-8", LIBGL_ALWAYS_SOFTWARE="1")
        with self.log.open("wb") as log:
            self.program = subprocess.Popen([*command, "cloud.ply"], cwd=folder, env=dict(os.environ, **variables),
                                            stdout=log, stderr=log)

    def wait_for_log(self, pattern, seconds=60):
        wait_for(pattern, lambda: re.search(pattern, self.log.read_text(errors="replace")), seconds)

    def xdotool(self, *words):
        return programs.run("xdotool", *words, env=dict(os.environ, DISPLAY=self.display)).stdout

    def keys(self, window, *keys):
        self.xdotool("windowfocus", "--sync", window, "key", "--delay", 100, *keys, "sleep", 1)

    def click(self, x, y):
        self.xdotool("mousemove", "--sync", x, y, "sleep", .2, "click", 1, "sleep", .2)

    def find(self, title):
        if self.program.poll() is not None:
            sys.exit(f"MeshLab has ended:\n{self.log.read_text(errors='replace')}")
        # MeshLab's package does not depend on the libraries of some plugins, which a message at the start names.
        for message in self.xdotool("search", "--onlyvisible", "--name", "^Error while loading plugins").split():
            self.keys(message, "Return")
        return self.xdotool("search", "--onlyvisible", "--name", title).split()

    def size(self, window):
        return tuple(map(int, re.findall(r"(?:WIDTH|HEIGHT)=(\d+)", self.xdotool("getwindowgeometry", "--shell", window))))

    def place(self, window, x, y, *size):
        def placed():  # a program that is still starting may set its own size afterwards
            self.xdotool("windowmove", window, x, y, "windowsize", window, *size, "sleep", 1)
            return self.size(window) == size
        wait_for("a window of the wanted size", placed)

    def save(self, path, height):
        time.sleep(3)  # MeshLab draws in a tenth of a second
        save(ImageGrab.grab((0, 0, WIDTH, height), xdisplay=self.display), path)


def take(window, name):
    """Saves the two pictures, whose names begin with `name`."""
    whole = wait_for("its window", lambda: window.find("^MeshLab 20"))[-1]
    window.wait_for_log("Opened mesh")
    window.place(whole, 0, 0, WIDTH, HEIGHT)
    for y in (536, 548, 560):  # the button of points without light, as they have no normals; releases differ in its place
        window.click(WIDTH - 62, y)
    # The drawing area is the widest high window inside the whole one. Its right edge is pulled to the left.
    edge = max(width for width, height in map(window.size, window.find("")) if width < WIDTH and HEIGHT / 2 < height < HEIGHT)
    moves = [("mousemove", "--sync", x + 4, HEIGHT // 2, "sleep", .2) for x in (edge, DRAWING + 20, DRAWING)]
    window.xdotool(*moves[0], "mousedown", 1, *moves[1], *moves[2], "mouseup", 1, "sleep", 1)
    window.keys(whole, "shift+h", "ctrl+f")  # hides the trackball; the search for filters
    window.xdotool("type", "--delay", 30, FILTER)
    window.xdotool("sleep", 1, "key", "--delay", 100, "Down", "Return")
    dialog = wait_for(f"the dialog of {FILTER}", lambda: window.find(f"^{FILTER}$"))[-1]
    height = max(HEIGHT, min(SCREEN_HEIGHT, window.size(dialog)[1] + TOP + BOTTOM))
    window.place(whole, 0, 0, WIDTH, height)
    window.place(dialog, DRAWING + 2, TOP, WIDTH - DRAWING - 2, height - TOP - BOTTOM)
    window.save(f"{name}_dialog.png", height)
    window.click(WIDTH - 100, height - BOTTOM - 20)  # Apply
    window.wait_for_log("Applied filter:? ", 600)
    window.click(DRAWING + 100, height - BOTTOM - 20)  # Close
    window.place(whole, 0, 0, WIDTH, HEIGHT)
    window.click(DRAWING + 36, 111)  # hides the cloud, whose points lie in the mesh
    window.click(DRAWING + 130, 143)  # the new layer
    window.save(f"{name}_result.png", HEIGHT)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=Path("build"), help="the build folder")
    parser.add_argument("--pictures", type=Path, default=Path("screenshots"))
    parser.add_argument("releases", nargs="*", metavar="RELEASE", default=[INSTALLED, *library_hosts.RELEASES])
    options = parser.parse_args()
    for release in options.releases:
        with tempfile.TemporaryDirectory() as folder:
            window = Window(release, meshlabserver.plugin_path(options.build, f"meshlab-{release}"), Path(folder))
            try:
                take(window, options.pictures / f"meshlab_{release}")
            finally:
                window.program.kill()
                window.program.wait()


if __name__ == "__main__":
    main()
