# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The true surfaces of the experiments with their known topology, and clouds drawn from them.

Three kinds of model: made in code, public ones from Debian packages, and files of a data folder
(argument, or the environment variable NEURAL_MESH_DATA). A model may have several sources; the first one
that is available is used. All random numbers are numpy's PCG64 with a given seed.
"""

import os
import subprocess
import tarfile
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pymeshlab

import shapes


class ModelError(RuntimeError):
    """A model is not available; the message says what to install or set."""


@dataclass(frozen=True)
class Model:
    """A true surface. genus is the sum over the components."""

    name: str
    genus: int
    components: int
    sources: tuple  # of "code:FUNCTION", "data:FILE", "deb:PACKAGE:MEMBER" or "deb:PACKAGE:ARCHIVE!MEMBER"
    boundary_loops: int = 0


_CGAL = "deb:libcgal-demo:usr/share/doc/libcgal-dev/data.tar.gz!data/meshes/"

MODELS = {
    model.name: model
    for model in (
        # Debian packages (the first available source is used, so a data folder saves the download)
        Model("bunny", 0, 1, ("deb:glmark2-data:usr/share/glmark2/models/bunny.obj",
                              "data:mesh/bunny_closed_35k.ply")),
        Model("fandisk", 0, 1, ("data:mesh/fandisk_16k.ply", _CGAL + "fandisk_large.off")),
        Model("dino", 0, 1, ("data:mesh/dino_diplodocus_24k.ply", _CGAL + "diplodocus.off")),
        Model("armadillo", 0, 1, (_CGAL + "armadillo.off",)),
        Model("camel", 0, 1, (_CGAL + "camel.off",)),
        Model("homer", 0, 1, (_CGAL + "homer.off",)),
        Model("knot", 1, 1, (_CGAL + "knot1.off",)),
        Model("femur", 2, 1, (_CGAL + "femur.off",)),
        Model("elephant", 3, 1, (_CGAL + "elephant.off",)),
        Model("anchor", 4, 1, (_CGAL + "anchor_dense.off",)),
        # data folder
        Model("koala", 0, 1, ("data:mesh/koala_50k.ply",)),
        Model("kitten", 1, 1, ("data:mesh/kitten_9k.ply",)),
        Model("rocker-arm", 1, 1, ("data:mesh/rocker-arm_10k.ply",)),
        Model("eight", 2, 1, ("data:mesh/eight_5k.ply",)),
        Model("feline", 2, 1, ("data:mesh/feline_50k.ply",)),
        Model("block", 3, 1, ("data:mesh/block_9k.ply",)),
        Model("genus3", 3, 1, ("data:mesh/genus3_7k.ply",)),
        Model("turbine", 11, 1, ("data:mesh/turbine_9k.ply",)),
        Model("maxplanck", 0, 1, ("data:mesh/maxplanck_45k_open.ply",), boundary_loops=1),
        Model("foot", 0, 1, ("data:mesh/foot_10k_open.ply",), boundary_loops=1),
        # made in code
        Model("sphere", 0, 1, ("code:sphere",)),
        Model("torus", 1, 1, ("code:torus",)),
        Model("linked-tori", 3, 3, ("code:linked_tori",)),
        Model("two-spheres", 0, 2, ("code:two_spheres",)),
        Model("cup", 0, 1, ("code:cup",)),
        Model("filleted-cube", 0, 1, ("code:filleted_cube",)),
        Model("crossed-cylinders", 0, 1, ("code:crossed_cylinders",)),
        Model("half-filleted-cube", 0, 1, ("code:half_filleted_cube",)),
        Model("l-block", 0, 1, ("code:l_block",)),
        Model("stepped-shaft", 0, 1, ("code:stepped_shaft",)),
        Model("plate-with-bores", 4, 1, ("code:plate_with_bores",)),
        Model("chamfered-wedge", 0, 1, ("code:chamfered_wedge",)),
    )
}

# Publicly available: from Debian packages, or made in code.
PUBLIC_MODELS = ("bunny", "fandisk", "dino", "armadillo", "homer", "knot", "femur", "elephant", "anchor")
CODE_MODELS = tuple(name for name, model in MODELS.items() if model.sources[0].startswith("code:"))
CAD_PARTS = ("half-filleted-cube", "l-block", "stepped-shaft", "plate-with-bores", "chamfered-wedge")
# Of the tables; most need a data folder.
TABLE_MODELS = ("bunny", "koala", "fandisk", "kitten", "rocker-arm", "eight", "block", "genus3")


def cache_folder():
    """Where downloaded packages are kept between runs: in the user's cache folder."""
    folder = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "neural-mesh" / "models"
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def package_file(package, member):
    """The path of a file of a Debian package, installed or not.

    member is a path inside the package, or ARCHIVE!PATH for a file in a tar archive that the package holds.
    A package that is not installed is downloaded with apt-get (no root needed) and the one file kept.
    """
    archive, _, inner = member.partition("!")
    if not inner and Path("/", archive).exists():
        return Path("/", archive)
    kept = cache_folder() / package / (inner or archive)
    if kept.exists():
        return kept
    kept.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        holder = Path("/", archive)
        if not holder.exists():
            holder = _unpacked_package(package, Path(scratch)) / archive
        if inner:
            with tarfile.open(holder) as tar:
                data = tar.extractfile(inner).read()
        else:
            data = holder.read_bytes()
    unfinished = kept.with_name(kept.name + ".part")
    unfinished.write_bytes(data)
    unfinished.rename(kept)
    return kept


def _unpacked_package(package, scratch):
    try:
        # Without this option apt warns that its sandbox user cannot write into a private folder.
        subprocess.run(["apt-get", "-q", "-o", "APT::Sandbox::User=root", "download", package], cwd=scratch,
                       check=True, capture_output=True, text=True)
        deb = next(scratch.glob("*.deb"))
        subprocess.run(["dpkg-deb", "-x", deb, scratch / "root"], check=True, capture_output=True)
    except (OSError, subprocess.CalledProcessError, StopIteration) as error:
        raise ModelError(f"The Debian package {package} is neither installed nor could it be downloaded. "
                         f"Install it with 'apt install {package}'. ({error})") from error
    return scratch / "root"


def load_mesh(path):
    """Vertices (n, 3) and triangles (m, 3) of a mesh file, unreferenced vertices removed.

    Raises ModelError if the file cannot be read as a mesh with faces.
    """
    meshes = pymeshlab.MeshSet(verbose=False)
    try:
        meshes.load_new_mesh(str(path))
    except pymeshlab.PyMeshLabException as error:
        raise ModelError(f"The file {path} cannot be read as a mesh: {error}") from error
    if meshes.current_mesh().face_number() == 0:
        raise ModelError(f"The file {path} has no faces; a triangle mesh is needed here.")
    meshes.meshing_remove_unreferenced_vertices()
    mesh = meshes.current_mesh()
    return mesh.vertex_matrix(), mesh.face_matrix()


def load_model(name, data=None):
    """Vertices and triangles of the model called name. data: the data folder, else NEURAL_MESH_DATA."""
    if name not in MODELS:
        raise ModelError(f"There is no model called {name}. There are: {', '.join(MODELS)}.")
    data = data or os.environ.get("NEURAL_MESH_DATA")
    reasons = []
    for source in MODELS[name].sources:
        kind, _, rest = source.partition(":")
        if kind == "code":
            return getattr(shapes, rest)()
        if kind == "deb":
            try:
                return load_mesh(package_file(*rest.split(":", 1)))
            except ModelError as error:
                reasons.append(str(error))
        elif data and Path(data, rest).exists():
            return load_mesh(Path(data, rest))
        else:
            reasons.append(f"Its file {rest} needs a data folder: give --data or set NEURAL_MESH_DATA.")
    raise ModelError(f"The model {name} is not available. " + " ".join(reasons))


def diagonal(points):
    """Length of the diagonal of the axis-parallel bounding box."""
    return float(np.linalg.norm(points.max(axis=0) - points.min(axis=0)))


def sample_surface(vertices, faces, count, rng):
    """count points uniform over the area, and the index of the face that each lies on. O(faces + count log faces)."""
    origin = vertices[faces[:, 0]]
    edge1, edge2 = vertices[faces[:, 1]] - origin, vertices[faces[:, 2]] - origin
    areas = np.cumsum(np.linalg.norm(np.cross(edge1, edge2), axis=1))
    chosen = np.searchsorted(areas, rng.random(count) * areas[-1], side="right").clip(max=len(faces) - 1)
    root, along = np.sqrt(rng.random(count)), rng.random(count)
    points = (origin[chosen] + edge1[chosen] * (root * (1 - along))[:, None]
              + edge2[chosen] * (root * along)[:, None])
    return points, chosen


def make_cloud(vertices, faces, samples=200_000, noise=0.0, seed=1):
    """A cloud of a surface: samples points uniform over its area, plus Gaussian noise in all three directions
    with a standard deviation of noise % of the bounding-box diagonal. Same arguments, same cloud."""
    rng = np.random.default_rng(seed)
    points, _ = sample_surface(vertices, faces, samples, rng)
    if noise:
        points = points + rng.standard_normal(points.shape) * (noise / 100 * diagonal(vertices))
    return points


def save_ply(path, vertices, faces=None):
    """Writes a binary PLY in double precision."""
    mesh = pymeshlab.Mesh(vertices) if faces is None else pymeshlab.Mesh(vertices, faces)
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(mesh)
    meshes.save_current_mesh(str(path), save_vertex_quality=False, save_vertex_color=False, save_vertex_normal=False,
                             save_face_color=False)
