#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Makes the packages of all hosts from built plugins: `./run.sh package` calls it.

    package.py --plugins build/plugins --libraries build/libraries --out dist

The library of this system is c_api/ beside the plugins; those of other systems are in folders that libraries.py has made.
Prints for each plugin its size and the newest symbol versions that it needs, and fails if a host's own build does not
need as new ones. The same plugins and the same SOURCE_DATE_EPOCH (seconds, default: the time of the last commit) give
the same bytes. Needs strip and readelf (binutils), dpkg-deb and git.
"""

import argparse
import gzip
import hashlib
import io
import os
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import deb  # noqa: E402
import wheel  # noqa: E402

ROOT = Path(__file__).resolve().parents[1]
PLUGIN = "libfilter_neuralmesh.so"
LIBRARY = "libneural_mesh.so"
WHEEL_HOST = "pymeshlab-2025.7"
# The newest symbol versions that a host's build needs itself; every system that runs the host has them. meshlab-2020.09
# is Debian 12's, 2022.02 and 2025.07 are the official builds, pymeshlab-2025.7 is the wheel of PyPI.
HOST_VERSIONS = {
    "meshlab-2020.09": {"GLIBC": "2.36", "GLIBCXX": "3.4.30", "CXXABI": "1.3.13"},
    "meshlab-2022.02": {"GLIBC": "2.31", "GLIBCXX": "3.4.28", "CXXABI": "1.3.12"},
    "meshlab-2025.07": {"GLIBC": "2.35", "GLIBCXX": "3.4.29", "CXXABI": "1.3.13"},
    "pymeshlab-2025.7": {"GLIBC": "2.35", "GLIBCXX": "3.4.29", "CXXABI": "1.3.13"},
}
ARCHIVE_HOSTS = {"meshlab-2022.02": "2022.02", "meshlab-2025.07": "2025.07"}
# Whom the packages name, unless DEBFULLNAME and DEBEMAIL are set, as for any Debian package. The project has no address
# of its own; example.org is reserved for such cases.
MAINTAINER = ("Neural Mesh maintainers", "neural-mesh@example.org")
MOST_BYTES = 2_000_000  # of a stripped plugin or library
MOST_BYTES_OF_WHEEL = 3_000_000
WHERE_TO_PUT_IT = """Neural Mesh {version} for MeshLab {release} ({scalar} build) on {platform}.
Install it in MeshLab: Help - Plugin Info - Load Plugins, then choose libfilter_neuralmesh.so of this folder.
Use it: Filters - Remeshing, Simplification and Reconstruction - Surface Reconstruction: Neural Mesh.
"""


class PackagingError(RuntimeError):
    """A package cannot be made; the message says why."""


def output_of(*command):
    return subprocess.run([str(word) for word in command], check=True, stdout=subprocess.PIPE, text=True).stdout


def project_version():
    return re.search(r"^project\(neural_mesh VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text(), re.M)[1]


def source_date():
    """The time that packages name as theirs, in seconds since 1970."""
    if date := os.environ.get("SOURCE_DATE_EPOCH"):
        return int(date)
    try:
        return int(output_of("git", "-C", ROOT, "log", "-1", "--format=%ct"))
    except (OSError, subprocess.CalledProcessError):
        raise PackagingError("This is no git repository: set SOURCE_DATE_EPOCH, such as to $(date +%s).") from None


def maintainer():
    """(name, address)"""
    return tuple(os.environ.get(name) or default for name, default in zip(("DEBFULLNAME", "DEBEMAIL"), MAINTAINER))


def number(version):
    return tuple(int(part) for part in version.split("."))


def needed_versions(plugin):
    """{"GLIBC": "2.29", ...}: the newest version of each library's symbols that the file needs."""
    newest = {}
    for name, version in re.findall(r"Name: (GLIBC|GLIBCXX|CXXABI)_([0-9.]+)", output_of("readelf", "-VW", plugin)):
        newest[name] = max(newest.get(name, "0"), version, key=number)
    return newest


def too_new(host, needed):
    """The needed versions that are newer than the host's, as words."""
    return [f"{name}_{version}" for name, version in needed.items()
            if number(version) > number(HOST_VERSIONS[host][name])]


def stripped(source, host, folder):
    """A stripped copy of a plugin or library for a host in `folder`; prints and checks its size and symbol versions."""
    if not source.exists():
        raise PackagingError(f"{source} is missing: './run.sh build' makes it.")
    if b"NEURALMESH_SKIP" in source.read_bytes():
        raise PackagingError(f"{source} is for development: build it without -DNEURALMESH_ABLATION=ON.")
    target = Path(folder) / host / source.name
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(source, target)
    subprocess.run(["strip", "--strip-unneeded", "--remove-section=.comment", str(target)], check=True)
    needed, size = needed_versions(target), target.stat().st_size
    print(f"{host}, {source.name}: {size:,} bytes, needs at most " +
          " ".join(f"{name}_{version}" for name, version in sorted(needed.items())))
    if newer := too_new(host, needed):
        raise PackagingError(f"{source.name} for {host} needs {', '.join(newer)}, newer than its host.")
    if size > MOST_BYTES:
        raise PackagingError(f"{source.name} for {host} has {size:,} bytes, more than {MOST_BYTES:,}.")
    return target


def write_archive(out, host, plugin, version, date):
    """A .tar.gz with the plugin, the licence and where to put them."""
    scalar, system = "float", "linux-x86_64"
    name = f"neural-mesh-{version}-meshlab-{ARCHIVE_HOSTS[host]}-{scalar}-{system}"
    files = {PLUGIN: plugin.read_bytes(), "LICENSE": (ROOT / "LICENSE").read_bytes(),
             "README.txt": WHERE_TO_PUT_IT.format(version=version, release=ARCHIVE_HOSTS[host], scalar=scalar,
                                                  platform="Linux (x86-64)").encode()}
    tar = io.BytesIO()
    with tarfile.open(fileobj=tar, mode="w", format=tarfile.USTAR_FORMAT) as archive:
        for file, content in sorted(files.items()):
            entry = tarfile.TarInfo(f"{name}/{file}")
            entry.size, entry.mtime, entry.mode = len(content), date, 0o644
            archive.addfile(entry, io.BytesIO(content))
    path = out / f"{name}.tar.gz"
    path.write_bytes(gzip.compress(tar.getvalue(), mtime=date))
    return path


def write_wheels(out, plugin, library, libraries, version, date):
    """The wheel for this system, with the plugin, and those for which the folder `libraries` has a library."""
    glibc = max((needed_versions(file)["GLIBC"] for file in (plugin, library)), key=number)
    binaries = {f"manylinux_{glibc.replace('.', '_')}_x86_64": [plugin, library]}
    binaries.update((folder.name, list(folder.iterdir())) for folder in sorted(libraries.glob("*")) if folder.is_dir())
    wheels = [wheel.write(out, platform, files, version, date, maintainer()) for platform, files in binaries.items()]
    for path in wheels:
        if path.stat().st_size > MOST_BYTES_OF_WHEEL:
            raise PackagingError(f"{path.name} has {path.stat().st_size:,} bytes, more than {MOST_BYTES_OF_WHEEL:,}.")
    return wheels


def make_packages(plugins, libraries, out):
    """Fills the folder `out` with all packages and their checksums. Returns their paths."""
    version, date = project_version(), source_date()
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    with tempfile.TemporaryDirectory() as scratch:
        ready = {host: stripped(plugins / host / PLUGIN, host, scratch) for host in HOST_VERSIONS}
        library = stripped(plugins.parent / "c_api" / LIBRARY, WHEEL_HOST, scratch)
        made = [write_archive(out, host, ready[host], version, date) for host in ARCHIVE_HOSTS]
        made += [deb.write(out, ready[target.host], target, version, date, "{} <{}>".format(*maintainer()))
                 for target in deb.TARGETS]
        made += write_wheels(out, ready[WHEEL_HOST], library, libraries, version, date)
    sums = [f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n" for path in sorted(made)]
    (out / "SHA256SUMS").write_text("".join(sums))
    return sorted(made)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--plugins", type=Path, default=ROOT / "build" / "plugins")
    parser.add_argument("--libraries", type=Path, default=ROOT / "build" / "libraries")
    parser.add_argument("--out", type=Path, default=ROOT / "dist")
    given = parser.parse_args()
    try:
        for path in make_packages(given.plugins, given.libraries, given.out):
            print(f"{path.stat().st_size:>9,} bytes  {path}")
    except PackagingError as error:
        sys.exit(str(error))


if __name__ == "__main__":
    main()
