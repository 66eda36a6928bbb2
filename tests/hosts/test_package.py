# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The plugin files: hardened, with no exported symbols but entry points for Qt and Python, and dependent on their host, Qt
and the compiler's libraries only."""

from pathlib import Path

import library_hosts
import meshlabserver
import pytest
from programs import output_of

# The classes that the adapters use; any other undefined symbol without a version would be a missing one of ours.
MESHLAB_CLASSES = ("FilterPlugin", "GLLogStream", "MeshDocument", "MeshLabApplication", "MeshLabPluginLogger",
                   "MeshModel", "RichBool", "RichEnum", "RichFloat", "RichInt", "RichMesh", "RichParameterList",
                   "RichAbsPerc", "RichPercentage")
LIBRARIES = ("libmeshlab-common.so", "libQt5Core.so.5", "libQt5Widgets.so.5", "libstdc++.so.6", "libm.so.6",
             "libgcc_s.so.1", "libc.so.6", "ld-linux-x86-64.so.2")
VERSIONS = ("Qt_5", "GLIBCXX_", "CXXABI_", "GCC_", "GLIBC_")


@pytest.fixture(params=meshlabserver.HOSTS)
def host(request):
    return request.param


@pytest.fixture
def plugin(build, host):
    return meshlabserver.plugin_path(build, host)


def undefined(plugin, *options):
    """(kind, symbol) of the undefined symbols; weak ones (w) may be missing in the host."""
    return [line.split(None, 1) for line in output_of("nm", "-D", "-u", *options, plugin).splitlines()]


def test_only_entry_points_can_be_called(plugin, host):
    names = output_of("nm", "-D", "--defined-only", plugin)
    functions = [line.split()[2] for line in names.splitlines() if line.split()[1] == "T"]
    ours = [] if host == "meshlab-2020.09" else ["neural_mesh_messages"]  # which Python reads
    assert sorted(functions) == [*ours, "qt_plugin_instance", "qt_plugin_query_metadata"]


def test_all_undefined_symbols_are_of_the_host_or_of_libraries(plugin):
    strong = [symbol for kind, symbol in undefined(plugin, "-C") if kind == "U"]
    assert any("@" in symbol for symbol in strong)
    for symbol in strong:
        name, _, version = symbol.rpartition("@")
        if name:
            assert version.startswith(VERSIONS), symbol
        else:
            assert symbol.removeprefix("typeinfo for ").split("::")[0] in MESHLAB_CLASSES, symbol


def test_it_needs_no_other_library_and_searches_no_folder(plugin, host):
    dynamic = output_of("readelf", "-dW", plugin)
    needed = [line.split("[")[1].rstrip("]") for line in dynamic.splitlines() if "(NEEDED)" in line]
    assert set(needed) <= set(LIBRARIES)
    # The later hosts provide their symbols when they load a plugin; a dependency would bind it to a path.
    assert ("libmeshlab-common.so" in needed) == (host in ("meshlab-2020.09", "pymeshlab-2025.7"))
    assert "RPATH" not in dynamic and "RUNPATH" not in dynamic


def test_it_is_hardened(plugin):
    """Bound at once, so a host that lacks one of its symbols cannot load it."""
    dynamic, segments = output_of("readelf", "-dW", plugin), output_of("readelf", "-lW", plugin)
    assert "BIND_NOW" in dynamic and "TEXTREL" not in dynamic
    assert "GNU_RELRO" in segments
    stack = next(line for line in segments.splitlines() if "GNU_STACK" in line)
    assert " RW " in stack and "RWE" not in stack
    assert any(symbol.startswith("__stack_chk_fail@") for _, symbol in undefined(plugin))


def test_it_names_no_folder_of_the_machine_that_built_it(plugin):
    content = plugin.read_bytes()
    for folder in (Path(__file__).resolve().parents[2], library_hosts.CACHE, Path.home()):
        assert f"{folder}/".encode() not in content, folder
