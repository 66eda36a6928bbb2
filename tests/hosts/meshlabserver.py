# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Runs the filter in meshlabserver 2020.09 without changing the installed MeshLab.

meshlabserver loads plugins from beside its binary, so a copy of it is made in a folder with the format plugins and
ours. Uses the standard library only, because `./run.sh demo` installs no other."""

import atexit
import functools
import os
import shutil
import subprocess
from pathlib import Path

import programs

INSTALLED = Path("/usr/bin/meshlabserver")
LIBRARIES = Path("/usr/lib/x86_64-linux-gnu/meshlab")
# All file formats of MeshLab, and the filters that tests run before ours.
NEIGHBOURS = ("libio_*.so", "libfilter_func.so", "libfilter_layer.so", "libfilter_select.so")
HOSTS = ("meshlab-2020.09", "meshlab-2022.02", "meshlab-2025.07", "pymeshlab-2025.7")


class ServerError(RuntimeError):
    """meshlabserver failed; the message is its output."""


def plugin_path(build, host=HOSTS[0]):
    return Path(build) / "plugins" / host / "libfilter_neuralmesh.so"


def make_folder(folder, plugin):
    """Makes `folder`, replacing an old one, with a meshlabserver that finds `plugin`. It must not be named bin: from
    there Debian's MeshLab loads plugins from another place."""
    folder = Path(folder)
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "plugins").mkdir(parents=True)
    folder.chmod(0o700)
    shutil.copy(INSTALLED, folder / "meshlabserver")
    for pattern in NEIGHBOURS:
        for neighbour in (LIBRARIES / "plugins").glob(pattern):
            (folder / "plugins" / neighbour.name).symlink_to(neighbour)
    (folder / "plugins" / "libfilter_neuralmesh.so").symlink_to(Path(plugin).resolve())
    return folder


def environment(folder):
    """Environment variables with which the command `meshlabserver` is the one in `folder`."""
    return dict(os.environ, PATH=f"{folder}:{os.environ['PATH']}", LD_LIBRARY_PATH=str(LIBRARIES),
                XDG_RUNTIME_DIR=str(folder), LC_ALL="C.UTF-8")


@functools.lru_cache(maxsize=1)
def display(screen="1280x1024x24"):
    """The display of an X server without a screen, which is started once and ends with this program. xvfb-run would
    start one for each call, and sometimes fails to end it. Without -noreset it would turn away a program that starts just
    after the last one has ended."""
    reading, writing = os.pipe()
    xvfb = subprocess.Popen(["Xvfb", "-displayfd", str(writing), "-screen", "0", screen, "-nolisten", "tcp", "-noreset"],
                            pass_fds=[writing], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    atexit.register(xvfb.terminate)
    os.close(writing)
    with os.fdopen(reading) as pipe:
        number = pipe.readline().strip()
    if not number:
        raise ServerError("Xvfb did not start: install the package xvfb.")
    return f":{number}"


def run(folder, *arguments, timeout=600):
    """Runs meshlabserver without a screen. Returns (exit code, all it printed)."""
    variables = dict(environment(folder), DISPLAY=display())
    done = programs.run("meshlabserver", *arguments, env=variables, stderr=subprocess.STDOUT, errors="replace",
                        timeout=timeout)
    return done.returncode, done.stdout


def reconstruct(folder, cloud, script, out, timeout=600):
    """Runs `script` on `cloud` and saves the result with quality, colour and selection flags.
    Returns the figures in the log. ServerError: it failed, or saved no file, which the exit code does not show.
    `timeout` in seconds; None: no limit."""
    out = Path(out)
    out.unlink(missing_ok=True)
    code, text = run(folder, "-i", cloud, "-o", out, "-m", "vq", "vc", "vf", "-s", script, timeout=timeout)
    if code != 0 or not out.exists():
        raise ServerError(text)
    return figures(text)


MEASURES = ("rms_error", "held_out_error", "mean_counter", "topology_confidence", "seconds")  # the others are counts


def figures(text):
    """The figures that the filter has written to the log, as a dictionary."""
    lines = [line for line in text.splitlines() if "vertices=" in line and "stop_reason=" in line]
    if not lines:
        raise ServerError(text)
    pairs = (word.split("=") for word in lines[-1].split() if "=" in word)
    return {key: float(value) if key in MEASURES else int(value)
            for key, value in pairs}


def parameters(build, filter_name=""):
    """The table of a filter's parameters, by its Python name or the reconstruction: dictionaries of texts."""
    return _name_and_parameters(build, filter_name)[1]


def _name_and_parameters(build, filter_name):
    keys = ("stage", "advanced", "id", "type", "default", "low", "high", "choices", "label", "help")
    text = programs.output_of(Path(build) / "tests/parameter_table", filter_name, encoding="utf-8")
    name, *lines = text.splitlines()
    return name, [dict(zip(keys, line.split("\t"))) for line in lines]


def script(build, filter_name="", **values):
    """The text of a complete script with the defaults of a filter, by its Python name or the reconstruction, and the given values.
    (meshlabserver aborts on scripts that omit a parameter.)"""
    name, table = _name_and_parameters(build, filter_name)
    lines = ["<!DOCTYPE FilterScript>", "<FilterScript>", f' <filter name="{name}">']
    for row in table:
        value = values.pop(row["id"], row["default"])
        attributes = {"type": row["type"], "name": row["id"], "value": str(value).lower() if isinstance(value, bool) else value}
        if row["type"] == "RichEnum":
            choices = row["choices"].split("|")
            attributes["enum_cardinality"] = len(choices)
            attributes.update((f"enum_val{i}", choice) for i, choice in enumerate(choices))
        if row["type"] == "RichAbsPerc":
            attributes.update(min=0, max=1)
        lines.append("  <Param " + " ".join(f'{key}="{text}"' for key, text in attributes.items()) + "/>")
    if values:
        raise ServerError(f"{name} has no parameters {', '.join(values)}.")
    return "\n".join([*lines, " </filter>", "</FilterScript>", ""])


def write_script(build, path, filter_name="", **values):
    Path(path).write_text(script(build, filter_name, **values), encoding="utf-8")
    return Path(path)
