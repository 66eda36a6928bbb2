# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Runs the filter in each host on the layers of inputs.py, and checks the results."""

import re
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass

import inputs
import meshlabserver
from check_mesh import check_mesh
import models
import numpy as np

PYTHON_NAME = inputs.RECONSTRUCTION
SERVER = "meshlabserver 2020.09"
PYMESHLAB = "pymeshlab 2025.7"
HOSTS = (SERVER, PYMESHLAB)


@dataclass
class Outcome:
    sentence: str = ""  # the error message; empty: the layer was learned
    host: str = ""
    mesh: object = None  # the file of the result
    origin: tuple = (0, 0, 0)  # the translation in the result's matrix, which the file does not contain
    report: dict = None
    unchanged: bool = True  # the input layer; True also if the host ended before it could be compared
    # Of the counters of a given mesh, which change nothing else; an entry for each vertex that is not deleted.
    quality: np.ndarray = None
    selected: np.ndarray = None

    def mesh_in_single_precision(self, layer):
        """(coordinates, faces), to be equal in all hosts; None if there is no mesh."""
        if self.mesh is None:
            return None
        vertices, faces = models.load_mesh(self.mesh)
        # A host in double precision has world coordinates where others are relative to an origin.
        return (vertices - np.subtract(layer.origin, self.origin)).astype("f4"), faces


def origin_in(host, layer):
    """The expected origin of the result's coordinates; double precision needs no other than zero."""
    return (0, 0, 0) if host == PYMESHLAB else tuple(layer.origin)


# --- meshlabserver -----------------------------------------------------------------------------------------------

PROJECT = """<!DOCTYPE MeshLabDocument>
<MeshLabProject><MeshGroup>
{layers}</MeshGroup><RasterGroup/></MeshLabProject>
"""
PROJECT_LAYER = """<MLMesh label="{file}" filename="{file}" visible="1"><MLMatrix44>
{matrix}
</MLMatrix44></MLMesh>
"""
ALL_ATTRIBUTES = ("vc", "vq", "vf", "fc", "ff", "wt", "mp")


def write_project(path, matrix, *files):
    """Writes a MeshLab project of layers with one matrix."""
    rows = "\n".join(" ".join(f"{x:g}" for x in row) + " " for row in matrix)
    path.write_text(PROJECT.format(layers="".join(PROJECT_LAYER.format(file=file, matrix=rows) for file in files)))
    return path


def server_input(layer, folder):
    """The layer twice, so that its copy can be compared with it; the second is current."""
    files = [inputs.write_ply(layer, folder / name) for name in ("layer.ply", "copy.ply")]
    if (layer.matrix == np.eye(4)).all():
        return ["-i", *files]
    return ["-p", write_project(folder / "project.mlp", layer.matrix, *(file.name for file in files))]


def write_script(build, layer, folder):
    script = meshlabserver.write_script(build, folder / "script.mlx", layer.filter, **layer.all_parameters())
    if layer.deleted.any():
        # This host keeps deleted vertices in the layer, marked as deleted.
        text = script.read_text().replace("<FilterScript>", '<FilterScript>\n <filter name="Delete Selected Vertices"/>', 1)
        script.write_text(text)
    return script


def sentence_of_server(text):
    """The error message in what the server has printed after its filter failed."""
    lines = [line.strip() for line in text.splitlines()]
    assert any(line.startswith("Problem with filter") for line in lines), text
    sentences = (line for line in lines if line.endswith(".") and " " in line and not line.startswith(("LOG", "MeshLab")))
    # What was going on stands before the sentence, with no end of line.
    return " ".join(re.sub("^Start mesh: [a-z ]+", "", sentence) for sentence in sentences)


def in_server(build, server, pymeshlab, layer, folder):
    counted = layer.filter == inputs.COUNTERS
    attributes = [name for name in ALL_ATTRIBUTES if not (counted and name in ("vq", "vf"))]
    script = write_script(build, layer, folder)
    out, kept, copy = (folder / name for name in ("out.ply", "kept.ply", "kept_copy.ply"))
    project = folder / "learned.mlp"
    moved = not (layer.matrix == np.eye(4)).all()
    code, text = meshlabserver.run(server, *server_input(layer, folder), *(("-w", project) if moved else ()),
                                   "-o", out, *(("-l", 1, "-m", "vq", "vf") if counted else ("-m", "vq", "vc")),
                                   "-o", copy, "-l", 0, "-m", *attributes, "-o", kept, "-l", 1, "-m", *attributes,
                                   "-s", script)
    assert code in (0, 255), f"ended with code {code}: {text[-2000:]}"
    if code != 0:
        return Outcome(sentence=sentence_of_server(text))
    assert out.exists() and kept.exists(), text
    same = kept.read_bytes() == copy.read_bytes() if not layer.deleted.any() else True
    if counted:
        meshes = new_mesh_set(pymeshlab)
        meshes.load_new_mesh(str(out))
        return of_counters(SERVER, meshes.current_mesh(), meshlabserver.figures(text), same)
    origin = _translation_of_last(project) if moved else (0, 0, 0)
    return Outcome(host=SERVER, mesh=out, origin=origin, report=meshlabserver.figures(text), unchanged=same)


def of_counters(host, mesh, report, unchanged):
    return Outcome(host=host, quality=mesh.vertex_scalar_array().astype("f4"), report=report, unchanged=unchanged,
                   selected=mesh.vertex_selection_array().copy())


def _translation_of_last(project):
    """The translation in the matrix of a project's last layer; the matrix must have no other part."""
    text = ElementTree.parse(project).getroot().findall(".//MLMatrix44")[-1].text
    return _translation_in(np.array(text.split(), dtype=float).reshape(4, 4))


def _translation_in(matrix):
    origin = tuple(matrix[:3, 3])
    assert (matrix == inputs.moved(*origin)).all(), f"the result's matrix is {matrix}"
    return origin


# --- pymeshlab ---------------------------------------------------------------------------------------------------


# After a filter has raised, pymeshlab 2025.7 logs into that MeshSet for ever, and crashes if it has been deleted. So
# all MeshSets are kept.
_kept = []


def new_mesh_set(pymeshlab):
    _kept.append(pymeshlab.MeshSet(verbose=False))
    return _kept[-1]


def state(meshes):
    """All properties of each layer that pymeshlab exposes, in comparable form."""
    layers = []
    for mesh in meshes:
        has = (mesh.has_vertex_scalar(), mesh.has_vertex_color(), mesh.has_face_color(), mesh.has_wedge_tex_coord())
        optional = [read().tobytes() for there, read in zip(has, (
            mesh.vertex_scalar_array, mesh.vertex_color_matrix, mesh.face_color_matrix, mesh.wedge_tex_coord_matrix)) if there]
        layers.append((mesh.id(), mesh.label(), mesh.vertex_matrix().tobytes(), mesh.face_matrix().tobytes(),
                       mesh.vertex_normal_matrix().tobytes(), has, optional,
                       mesh.vertex_selection_array().tobytes(), mesh.face_selection_array().tobytes(),
                       mesh.transform_matrix().tobytes(), mesh.is_visible(), mesh.texture_number()))
    return layers, meshes.current_mesh_id() if len(layers) else None


def without_values(state):
    """state() without scalars and selection of the vertices."""
    layers, current = state
    return [(*layer[:6], layer[6][1 if layer[5][0] else 0:], *layer[8:]) for layer in layers], current


def load(pymeshlab, layer, folder):
    meshes = new_mesh_set(pymeshlab)
    cleaned_by_reader = not np.isfinite(layer.points).all() or any(len(set(face)) < 3 for face in layer.faces)
    if cleaned_by_reader:
        faces = np.array(layer.triangles(), dtype="i4").reshape(-1, 3)
        quality = layer.quality().astype(float)
        meshes.add_mesh(pymeshlab.Mesh(layer.points.astype(float), faces, v_scalar_array=quality))
    else:
        meshes.load_new_mesh(str(inputs.write_ply(layer, folder / "layer.ply")))
    if layer.deleted.any():
        # The reader does not set the number of selected vertices, which the host's filter uses.
        meshes.compute_selection_by_condition_per_vertex(condselect=f"vi >= {layer.deleted.argmax()}")
        meshes.meshing_remove_selected_vertices()
    if not (layer.matrix == np.eye(4)).all():
        meshes.set_matrix(transformmatrix=layer.matrix, freeze=False)
    if layer.textured:
        meshes.current_mesh().add_vertex_custom_scalar_attribute(layer.quality().astype(float), "heat")
    return meshes


def in_pymeshlab(pymeshlab, layer, folder):
    meshes = load(pymeshlab, layer, folder)
    before = state(meshes)

    def unchanged():
        mesh = meshes.mesh(0)
        kept = not layer.textured or (mesh.vertex_custom_scalar_attribute_array("heat") == layer.quality()).all()
        return kept and state(meshes)[0][0] == before[0][0]

    try:
        report = meshes.apply_filter(layer.filter, **layer.all_parameters())
    except pymeshlab.PyMeshLabException as error:
        sentence = str(error).split("Details: ", 1)[1].strip()
        return Outcome(sentence=sentence, unchanged=unchanged() and state(meshes) == before)
    if layer.filter == inputs.COUNTERS:
        return of_counters(PYMESHLAB, meshes.current_mesh(), report, without_values(state(meshes)) == without_values(before))
    assert len(list(meshes)) == 2 and meshes.current_mesh().label() == "Neural Mesh"
    out = folder / "out.ply"
    meshes.save_current_mesh(str(out))
    origin = _translation_in(meshes.current_mesh().transform_matrix())
    return Outcome(host=PYMESHLAB, mesh=out, origin=origin, report=report, unchanged=unchanged())


# --- the checks ---------------------------------------------------------------------------------------------------


def try_out(build, server, pymeshlab, host, layer, folder):
    """Runs the filter on the layer in the host. AssertionError: a promise is broken."""
    if host == SERVER:
        return in_server(build, server, pymeshlab, layer, folder)
    return in_pymeshlab(pymeshlab, layer, folder)


def check(build, layer, outcome):
    """AssertionError if the outcome is not the expected one. Writes a file beside the result."""
    assert outcome.unchanged, "the input layer has changed"
    if layer.refused:
        assert layer.refused in outcome.sentence, outcome.sentence or "the layer was learned"
        return
    assert not outcome.sentence, outcome.sentence
    report = outcome.report
    origin = tuple(float(x) for x in outcome.origin)
    assert origin == origin_in(outcome.host, layer), f"the origin of the coordinates is {origin}"
    points = layer.followed_points() - origin
    file = outcome.mesh.with_name("points.ply")
    models.save_ply(file, points)
    found = check_mesh(outcome.mesh, file)
    assert found["vertices"] == report["vertices"] == layer.target
    assert report["stop_reason"] == 0 and report["boundary_loops"] == layer.loops
    assert found["boundary_loops"] == layer.loops and found["manifold"] and found["oriented"], "no oriented surface with these boundaries"
    assert (found["genus"], found["components"]) == (report["genus"], report["components"])
    assert (found["components"], found["genus"]) == (layer.components, layer.genus), (
        f"{found['components']} components of genus {found['genus']}")
    assert found["rms_to_mesh"] < layer.rms, f"the points are {found['rms_to_mesh']} % from the mesh"
    assert found["max_to_reference"] < layer.far, f"the mesh is up to {found['max_to_reference']} % from the points"
    # Hosts in single precision round the coordinates of the result.
    rounding = np.spacing(np.abs(points).max().astype("f4"))
    per_cent = 100 / np.linalg.norm(np.ptp(points, 0))
    _check_reported_error(layer, report["rms_error"], found["rms_to_mesh"], per_cent * rounding)
    vertices, faces = models.load_mesh(outcome.mesh)
    _check_volume(layer, vertices, faces)
    _check_place(layer, points, vertices, rounding)


def _check_reported_error(layer, report, measured, rounding):
    """All in %. The layers have few enough points for the filter to measure the distances of all."""
    assert report >= 0
    if layer.outliers or (layer.faces and layer.parameters.get("draw_from_faces", True)):
        return  # the filter measures samples of the faces, or outliers as well; check_mesh measures other points
    tolerance = 1e-3 * measured + 1e-5 + rounding
    assert abs(report - measured) < tolerance, f"{report} % is reported, {measured} % is measured"


def _check_volume(layer, vertices, faces):
    expected = layer.world_volume()
    if expected is None:
        return
    a, b, c = np.moveaxis((vertices - vertices.mean(0))[faces], 1, 0)
    volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6
    assert abs(volume - expected) < layer.within * expected, f"the enclosed volume is {volume}, not {expected}"


def _check_place(layer, points, vertices, rounding):
    """All vertices are finite, inside the enlarged box of the points, and span it."""
    assert np.isfinite(vertices).all(), "vertices that are not finite"
    low, high = points.min(0), points.max(0)
    margin = layer.margin * np.linalg.norm(high - low) + rounding
    assert (vertices >= low - margin).all() and (vertices <= high + margin).all(), "vertices outside the points' box"
    thin = 1e-4 * np.linalg.norm(high - low)  # one layer lies between the two sides of a thin sheet
    assert (np.ptp(vertices, 0) + rounding + thin >= .7 * (high - low)).all(), "parts of the points are not covered"
