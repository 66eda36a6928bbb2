# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Shared by the scripts of this folder: models, runs of the core, vertex normals, rows kept on disk.

The model files of the paper are not public. The data folder (NEURAL_MESH_DATA) has other meshes of Max-Planck, Dino
and Brain; without it models from Debian packages are used.
"""

import hashlib
import json
import resource
import subprocess
from pathlib import Path

import numpy as np
import pymeshlab
from scipy.spatial import cKDTree

import import_paths  # noqa: F401
import evaluate
import models

BRAIN = "mesh/brain_aim_18k.ply"


class RunError(RuntimeError):
    """A program that the experiment needs failed; the message contains its output."""


def surface(name, data=None):
    """Vertices and triangles of a model of models.py, or of "brain": the largest component of a scan's surface.

    Raises models.ModelError if it is not available.
    """
    if name != "brain":
        return models.load_model(name, data)
    if not data:
        raise models.ModelError("The brain needs a data folder: give --data or set NEURAL_MESH_DATA.")
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.load_new_mesh(f"{data}/{BRAIN}")
    meshes.generate_splitting_by_connected_components()
    largest = max(list(meshes)[1:], key=lambda mesh: mesh.vertex_number())
    return largest.vertex_matrix(), largest.face_matrix()


def is_available(name, data=None):
    """Whether surface() can provide the model. May download a package."""
    try:
        surface(name, data)
        return True
    except (models.ModelError, pymeshlab.PyMeshLabException):
        return False


def output_of(command):
    run = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    if run.returncode != 0:
        raise RunError(f"{' '.join(map(str, command))} failed: {run.stderr.strip()}")
    return run


def learn(program, cloud, out, start=None, **settings):
    """Runs the core on a PLY file, from the mesh of the file start if any; returns its report, with the warnings as
    "warnings" and the processor time, including reading and writing, as "processor_seconds". Processor time depends less on
    other load than wall time."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    # The paper draws its signals evenly over the points.
    settings = {"even_sampling": 0, **settings}
    files = [cloud, out] if start is None else [cloud, out, start]
    run = output_of([program, *files, *(f"{key}={value}" for key, value in settings.items())])
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    warnings = [line for line in run.stderr.splitlines() if not line.startswith("Note: ")]
    return {**json.loads(run.stdout), "warnings": warnings,
            "processor_seconds": after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime}


def check(program, mesh, reference):
    """Topology and Hausdorff distances of a mesh by vcglib, as check_mesh.cpp prints them."""
    return json.loads(output_of([program, mesh, reference]).stdout)


def vertex_normals(vertices, faces):
    """Unit normals of the vertices, the mean over the faces weighted by their area."""
    corners = vertices[faces]
    weighted = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = np.zeros_like(vertices)
    for corner in range(3):
        np.add.at(normals, faces[:, corner], weighted)
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), np.finfo(float).tiny)


def samples_with_normals(vertices, faces, count, seed):
    """Points uniform over the area, with the vertex normals interpolated over the faces."""
    points, of_face = models.sample_surface(vertices, faces, count, np.random.default_rng(seed))
    origin, corner1, corner2 = (vertices[faces[of_face, k]] for k in range(3))
    edges = np.stack([corner1 - origin, corner2 - origin], axis=2)
    gram = np.einsum("nij,nik->njk", edges, edges) + 1e-300 * np.eye(2)
    right = np.einsum("nij,ni->nj", edges, points - origin)
    determinant = np.maximum(np.linalg.det(gram), np.finfo(float).tiny)
    u = (gram[:, 1, 1] * right[:, 0] - gram[:, 0, 1] * right[:, 1]) / determinant
    v = (gram[:, 0, 0] * right[:, 1] - gram[:, 0, 1] * right[:, 0]) / determinant
    at_vertices = vertex_normals(vertices, faces)
    weights = np.stack([1 - u - v, u, v], axis=1).clip(0, 1)
    normals = np.einsum("nk,nkj->nj", weights, at_vertices[faces[of_face]])
    return points, normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), np.finfo(float).tiny)


class SmoothNormals:
    """A true surface, to measure the error of vertex normals."""

    def __init__(self, vertices, faces, samples=evaluate.NORMAL_SAMPLES):
        self.points, self.normals = samples_with_normals(vertices, faces, samples, 20030103)

    def angles(self, vertices, faces):
        """At points uniform over the true surface, the angle in degrees between the true normal and the mesh's next to
        it, both interpolated from the vertices. A mesh that is inside out is turned over."""
        points, normals = samples_with_normals(vertices, faces, evaluate.SAMPLES, 20030104)
        _, nearest = cKDTree(points).query(self.points)
        cosine = np.einsum("ij,ij->i", self.normals, normals[nearest])
        angle = np.degrees(np.arccos(cosine.clip(-1, 1)))
        return angle if angle.mean() <= 90 else 180 - angle

    def error(self, vertices, faces):
        """The mean of angles()."""
        return float(self.angles(vertices, faces).mean())


def digest(data):
    return hashlib.sha256(data).hexdigest()[:16]


class Kept:
    """The rows of an experiment on disk, so that an interrupted run continues where it stopped.

    The key contains the checksum of the program, the cloud and the settings, so only rows of equal runs are reused.
    The file has one JSON object per line; an incomplete last line is ignored.
    """

    def __init__(self, path, program):
        self.path = path
        self.program = digest(Path(program).read_bytes())
        self.rows = {}
        path.parent.mkdir(parents=True, exist_ok=True)
        for line in path.read_text().splitlines() if path.exists() else ():
            try:
                found = json.loads(line)
            except json.JSONDecodeError:
                continue
            self.rows[found["key"]] = found["row"]

    def _word(self, key):
        return json.dumps({**key, "program": self.program}, sort_keys=True)

    def has(self, **key):
        return self._word(key) in self.rows

    def row(self, make, **key):
        """The row under the key; make() makes it if it is missing."""
        word = self._word(key)
        if word not in self.rows:
            self.rows[word] = make()
            with self.path.open("a") as file:
                file.write("\n" + json.dumps({"key": word, "row": self.rows[word]}))
        return self.rows[word]
