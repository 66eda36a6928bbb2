# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The wheels: pure Python and the library, on Linux on x86-64 with the plugin for pymeshlab, too. They have nothing of
Python's ABI, so one wheel serves all versions of it.

They do not require pymeshlab, so that pip never replaces the one there is; the extra `pymeshlab` does. Other extras:
`dask` for batches on many machines, `las` and `e57` for clouds in these formats."""

import base64
import hashlib
import time
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
MODULE = ROOT / "filter_neuralmesh/python/neural_mesh"
# Zip files cannot name an earlier time.
EARLIEST = 315532800  # 1980-01-01

METADATA = """Metadata-Version: 2.1
Name: neural-mesh
Version: {version}
Summary: A point cloud to a triangle mesh with exactly the vertices you ask for, from numpy or in pymeshlab
Maintainer: {maintainer[0]}
Maintainer-email: {maintainer[1]}
License: GPL-3.0-or-later
Requires-Python: >=3.9
Requires-Dist: numpy >=1.21
Provides-Extra: pymeshlab
Requires-Dist: pymeshlab ==2025.7.*; extra == "pymeshlab"
Provides-Extra: dask
Requires-Dist: distributed; extra == "dask"
Requires-Dist: bokeh; extra == "dask"
Provides-Extra: las
Requires-Dist: laspy[lazrs]; extra == "las"
Provides-Extra: e57
Requires-Dist: pye57; extra == "e57"
Description-Content-Type: text/markdown

```python
import neural_mesh
mesh = neural_mesh.reconstruct(points, target_vertices=5000)  # points: an array of shape (n, 3)
mesh.save("mesh.ply")
```

On Linux on x86-64 with pymeshlab as a filter, too:

```python
import neural_mesh, pymeshlab
ms = pymeshlab.MeshSet()
ms.load_new_mesh("cloud.ply")
result = ms.generate_surface_reconstruction_neural_mesh(target_vertices=5000)
ms.save_current_mesh("mesh.ply", save_vertex_quality=True)
```

Or as a command: `neural-mesh cloud.ply mesh.ply target_vertices=5000`, for a folder of clouds
`neural-mesh batch clouds --out meshes target_vertices=5000`, and for a cloud larger than memory
`neural-mesh stream cloud.las mesh.ply target_vertices=100000`.
"""


def write(out, platform, binaries, version, date, maintainer):
    """Writes a wheel to the folder `out` and returns its path. `platform`: its tag, several joined by dots. `binaries`:
    the files beside the Python modules. `maintainer`: (name, address)."""
    tag = f"py3-none-{platform}"
    tags = "".join(f"Tag: py3-none-{one}\n" for one in platform.split("."))
    info = f"neural_mesh-{version}.dist-info"
    modules = [path for path in MODULE.iterdir() if path.is_file()]
    files = {f"neural_mesh/{path.name}": path.read_bytes() for path in sorted([*modules, *binaries])}
    files[f"{info}/METADATA"] = METADATA.format(version=version, maintainer=maintainer).encode()
    files[f"{info}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: neural-mesh\nRoot-Is-Purelib: false\n{tags}".encode()
    files[f"{info}/entry_points.txt"] = b"[console_scripts]\nneural-mesh = neural_mesh.__main__:main\n"
    files[f"{info}/licenses/LICENSE"] = (ROOT / "LICENSE").read_bytes()
    files[f"{info}/RECORD"] = record(files, f"{info}/RECORD").encode()
    path = out / f"neural_mesh-{version}-{tag}.whl"
    moment = time.gmtime(max(date, EARLIEST))[:6]
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            entry = zipfile.ZipInfo(name, moment)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o100644 << 16
            archive.writestr(entry, content)
    return path


def record(files, own_name):
    """The wheel's list of its files: name, checksum, size; none of the last two for the list itself."""
    lines = []
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        lines.append(f"{name},sha256={digest},{len(content)}\n")
    return "".join(lines) + f"{own_name},,\n"
