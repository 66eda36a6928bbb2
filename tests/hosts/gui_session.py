# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Runs and controls a program with windows on a virtual X display: keys and clicks by xdotool, each step followed by
waiting for its effect.

Needs the Debian packages xvfb, xdotool and libgl1-mesa-dri, and Pillow for screenshots.
"""

import contextlib
import os
import re
import shutil
import signal
import subprocess
import tempfile
import time

POLL_SECONDS = 0.05


class GuiError(RuntimeError):
    """Something did not appear on the display in time; the message says what."""


def require_programs(*names):
    """Raises GuiError naming every program of `names` that is not installed."""
    missing = [name for name in names if shutil.which(name) is None]
    if missing:
        raise GuiError(f"{', '.join(missing)} not found: install the Debian packages "
                       "xvfb, xdotool, libgl1-mesa-dri and meshlab.")


def wait_until(condition, what, seconds=30.0):
    """Polls `condition` until it returns something true and returns that. Raises GuiError."""
    deadline = time.monotonic() + seconds
    while True:
        result = condition()
        if result:
            return result
        if time.monotonic() > deadline:
            raise GuiError(f"Timed out after {seconds:g} s of waiting for {what}.")
        time.sleep(POLL_SECONDS)


def stop(process):
    """Ends a child process, which leads a process group, and the processes that it started."""
    for sig in (signal.SIGTERM, signal.SIGKILL):
        if process.poll() is None:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, sig)
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(timeout=5)


class GuiSession(contextlib.AbstractContextManager):
    """One virtual display with one program on it; leaving the context ends both.

    width, height: the screen, in pixels. The program starts with `start()`; its standard
    output and error are in `log()`. Windows have no manager: they are placed, sized and
    given the keyboard explicitly, so that nothing depends on a desktop.
    """

    def __init__(self, width, height):
        require_programs("Xvfb", "xdotool")
        self.width, self.height = width, height
        self.directory = tempfile.mkdtemp(prefix="neural_mesh_gui_")
        self.log_path = os.path.join(self.directory, "program.log")
        self._program = None
        read_end, write_end = os.pipe()
        # With -displayfd the server chooses a free display number and reports it.
        self._server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write_end), "-screen", "0", f"{width}x{height}x24",
             "-dpi", "96", "-nolisten", "tcp", "+extension", "GLX", "-noreset"],
            pass_fds=[write_end], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            start_new_session=True)
        os.close(write_end)
        with os.fdopen(read_end) as pipe:
            number = pipe.readline().strip()
        if not number:
            self.__exit__(None, None, None)
            raise GuiError("The virtual X server did not start.")
        self.display = f":{number}"

    def __exit__(self, *exception):
        if self._program:
            stop(self._program)
        stop(self._server)
        shutil.rmtree(self.directory, ignore_errors=True)

    def environment(self, **extra):
        """The program's environment: software OpenGL, English, separate settings."""
        result = dict(os.environ, DISPLAY=self.display, LIBGL_ALWAYS_SOFTWARE="1", LC_ALL="C.UTF-8",
                      HOME=self.directory, XDG_CONFIG_HOME=os.path.join(self.directory, "config"),
                      XDG_RUNTIME_DIR=self.directory, QT_QPA_PLATFORM="xcb", QT_STYLE_OVERRIDE="fusion",
                      QT_AUTO_SCREEN_SCALE_FACTOR="0")
        result.pop("WAYLAND_DISPLAY", None)
        result.update(extra)
        return result

    def start(self, command, **environment):
        """Starts the program in the session's scratch directory."""
        with open(self.log_path, "wb") as log_file:
            self._program = subprocess.Popen(command, cwd=self.directory, stdin=subprocess.DEVNULL,
                                             stdout=log_file, stderr=subprocess.STDOUT,
                                             env=self.environment(**environment), start_new_session=True)

    def log(self):
        with open(self.log_path, "rb") as log_file:
            return log_file.read().decode("utf-8", "replace")

    def check_alive(self):
        if self._program.poll() is not None:
            raise GuiError(f"The program ended by itself (code {self._program.returncode}). "
                           f"Its last words:\n{self.log()[-2000:]}")

    def xdotool(self, *arguments):
        """Runs xdotool on this display; returns what it prints (empty when it finds nothing)."""
        run = subprocess.run(["xdotool", *map(str, arguments)], capture_output=True, text=True, check=False,
                             env=dict(os.environ, DISPLAY=self.display))
        return run.stdout

    def windows(self, title):
        """Ids of the visible windows whose title matches the regular expression, oldest first."""
        return self.xdotool("search", "--onlyvisible", "--name", title).split()

    def wait_for_window(self, title, seconds=30.0):
        def look():
            self.check_alive()
            return self.windows(title)
        return wait_until(look, f"a window called '{title}'", seconds)[-1]

    def wait_for_log(self, pattern, count=1, seconds=60.0):
        """Waits until the program has printed `pattern` (a regular expression) `count` times."""
        def look():
            self.check_alive()
            return len(re.findall(pattern, self.log())) >= count
        wait_until(look, f"'{pattern}' in the program's output", seconds)

    def fill_screen(self, window):
        """Moves and sizes a window to the whole screen and waits until it keeps that place and size.

        Asked again and again: a program that is still starting may set its own size afterwards.
        """
        wanted = ["X=0", "Y=0", f"WIDTH={self.width}", f"HEIGHT={self.height}"]
        kept = 0

        def settle():
            nonlocal kept
            self.check_alive()
            geometry = self.xdotool("getwindowgeometry", "--shell", window).split()
            kept = kept + 1 if all(word in geometry for word in wanted) else 0
            if not kept:
                self.xdotool("windowmove", window, 0, 0, "windowsize", window, self.width, self.height)
            return kept >= 4
        wait_until(settle, "the window's new size", 20)

    def keys(self, window, *keys):
        """Gives the keyboard to the window and presses keys (xdotool's names, "alt+f") in order."""
        self.xdotool("windowfocus", "--sync", window)
        self.xdotool("key", "--clearmodifiers", "--delay", 40, *keys)

    def click(self, x, y, button=1):
        """Clicks at a point of the screen (pixels from its top left corner)."""
        self.xdotool("mousemove", "--sync", x, y, "click", button)

    def screenshot(self):
        """The whole screen as a Pillow image."""
        from PIL import ImageGrab
        return ImageGrab.grab(xdisplay=self.display)

    def steady_screenshot(self, seconds=20.0, still_for=0.35):
        """The screen after it has not changed for `still_for` seconds.

        Shorter than half the blinking of a text cursor, which must not count as a change.
        """
        deadline = time.monotonic() + seconds
        picture, since = self.screenshot(), time.monotonic()
        while time.monotonic() < deadline:
            time.sleep(0.1)
            self.check_alive()
            following = self.screenshot()
            if following.tobytes() != picture.tobytes():
                picture, since = following, time.monotonic()
            elif time.monotonic() - since >= still_for:
                return picture
        raise GuiError(f"The screen was still changing after {seconds:g} s.")
