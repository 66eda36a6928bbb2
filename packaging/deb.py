# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The Debian packages: the plugin where Debian's MeshLab looks for it, and its documentation."""

import email.utils
import gzip
import hashlib
import os
import shutil
import subprocess
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
NAME = "meshlab-plugin-neuralmesh"


@dataclass
class Target:
    """One release of Debian and the MeshLab in it."""

    host: str
    suite: str
    revision: str
    depends: str


# MeshLab of the same month only, as the plugin checks; the libraries' names and versions are the release's.
TARGETS = (
    Target("meshlab-2020.09", "bookworm", "1~deb12u1",
           "meshlab (>= 2020.09), meshlab (<< 2020.10~), libc6 (>= 2.34), libgcc-s1 (>= 3.4), libstdc++6 (>= 7), "
           "libqt5core5a (>= 5.15.2), libqt5widgets5 (>= 5.15.2)"),
    Target("meshlab-2022.02", "trixie", "1~deb13u1",
           "meshlab (>= 2022.02), meshlab (<< 2022.03~), libc6 (>= 2.34), libgcc-s1 (>= 3.4), libstdc++6 (>= 7), "
           "libqt5core5t64 (>= 5.15.2), libqt5widgets5t64 (>= 5.15.2)"),
)
CONTROL = """Package: {name}
Version: {version}
Architecture: amd64
Maintainer: {maintainer}
Installed-Size: {kilobytes}
Depends: {depends}
Section: graphics
Priority: optional
Description: neural meshes from point clouds, for MeshLab
 A filter for MeshLab that turns a point cloud without normals into a triangle
 mesh with exactly the number of vertices asked for, dense where the surface
 bends and sparse where it is flat. A growing neural network learns the cloud
 (Jeong, Ivrissimtzis and Seidel, Pacific Graphics 2003).
"""
COPYRIGHT = """Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: Neural Mesh

Files: *
Copyright: {year}, the Neural Mesh authors
 2004-2025, Visual Computing Lab, ISTI - Italian National Research Council (vcglib, MeshLab)
License: GPL-3+

License: GPL-3+
 This program is free software: you can redistribute it and/or modify it under
 the terms of the GNU General Public License as published by the Free Software
 Foundation, either version 3 of the License, or (at your option) any later
 version.
 .
 It contains templates of the library Eigen, which is under the Mozilla Public
 License 2.0.
 .
 On Debian systems, the text of the GNU General Public License version 3 is in
 /usr/share/common-licenses/GPL-3.
"""
CHANGES = """{name} ({version}) {suite}; urgency=medium

  * Neural Mesh {upstream} for the MeshLab of Debian {suite}.

 -- {maintainer}  {date}
"""


def write(out, plugin, target, version, date, maintainer):
    """Writes the package to the folder `out` and returns its path. `maintainer`: "name <address>"."""
    full = f"{version}-{target.revision}"
    path = out / f"{NAME}_{full}_amd64.deb"
    with tempfile.TemporaryDirectory() as scratch:
        tree = Path(scratch) / "tree"
        fill(tree, plugin, target, version, full, date, maintainer)
        for file in [tree, *tree.rglob("*")]:
            file.chmod(0o755 if file.is_dir() else 0o644)
            os.utime(file, (date, date))
        subprocess.run(["dpkg-deb", "--build", "--root-owner-group", "-Zxz", str(tree), str(path)], check=True,
                       stdout=subprocess.DEVNULL, env=dict(os.environ, SOURCE_DATE_EPOCH=str(date)))
    return path


def fill(tree, plugin, target, version, full, date, maintainer):
    """The files of the package, below the folder `tree`."""
    plugins = tree / "usr/lib/x86_64-linux-gnu/meshlab/plugins"
    documents = tree / "usr/share/doc" / NAME
    for folder in (plugins, documents, tree / "DEBIAN"):
        folder.mkdir(parents=True)
    shutil.copyfile(plugin, plugins / plugin.name)
    (documents / "copyright").write_text(COPYRIGHT.format(year=time.gmtime(date).tm_year))
    changes = CHANGES.format(name=NAME, version=full, suite=target.suite, upstream=version, maintainer=maintainer,
                             date=email.utils.formatdate(date))
    (documents / "changelog.Debian.gz").write_bytes(gzip.compress(changes.encode(), mtime=0))
    (documents / "changelog.gz").write_bytes(gzip.compress((ROOT / "CHANGELOG.md").read_bytes(), mtime=0))
    if target.host == "meshlab-2020.09":  # the only one with meshlabserver
        shutil.copytree(ROOT / "filter_neuralmesh/scripts", documents / "examples", copy_function=shutil.copyfile)
    files = sorted(path for path in tree.rglob("*") if path.is_file())
    (tree / "DEBIAN/md5sums").write_text("".join(
        f"{hashlib.md5(path.read_bytes()).hexdigest()}  {path.relative_to(tree)}\n" for path in files))
    kilobytes = sum(-(-path.stat().st_size // 1024) for path in files)
    (tree / "DEBIAN/control").write_text(CONTROL.format(
        name=NAME, version=full, maintainer=maintainer, kilobytes=kilobytes, depends=target.depends))
