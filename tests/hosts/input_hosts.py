# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Handing the layers of inputs.py to the filter in every host, and what has to be true of what comes back."""

import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass

import inputs
import library_hosts
import meshlabserver
import models
import numpy as np

PYTHON_NAME = "generate_surface_reconstruction_neural_mesh"
SERVER = "meshlabserver 2020.09"
PYMESHLAB = "pymeshlab 2025.7"
HOSTS = (SERVER, *(f"library {release}" for release in library_hosts.RELEASES), PYMESHLAB)


@dataclass
class Outcome:
    sentence: str = ""  # the refusal
    host: str = ""
    mesh: object = None  # the file of the result
    origin: tuple = (0, 0, 0)  # of its coordinates: the translation in the result's matrix, which no such file holds
    told: dict = None
    unchanged: bool = True  # the input layer; True also where the host ends before it can be asked

    def mesh_in_single_precision(self, layer):
        """(coordinates, faces), the same in all hosts; None if there is no mesh."""
        if self.mesh is None:
            return None
        vertices, faces = models.load_mesh(self.mesh)
        # A host in double precision counts from the world's origin even where the others do not.
        return (vertices - np.subtract(layer.origin, self.origin)).astype("f4"), faces


def origin_in(host, layer):
    """Where the host's result is to be counted from; in double precision nothing is lost in world coordinates."""
    return (0, 0, 0) if host == PYMESHLAB else tuple(layer.origin)


def parameters_of(layer):
    return {"target_vertices": layer.target, **layer.parameters}


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
    """A MeshLab project of layers under one matrix."""
    rows = "\n".join(" ".join(f"{x:g}" for x in row) + " " for row in matrix)
    path.write_text(PROJECT.format(layers="".join(PROJECT_LAYER.format(file=file, matrix=rows) for file in files)))
    return path


def _server_input(layer, folder):
    """The layer twice, as a comparison for itself; the second is the current one."""
    files = [inputs.write_ply(layer, folder / name) for name in ("layer.ply", "copy.ply")]
    if (layer.matrix == np.eye(4)).all():
        return ["-i", *files]
    return ["-p", write_project(folder / "project.mlp", layer.matrix, *(file.name for file in files))]


def in_server(build, server, layer, folder):
    script = meshlabserver.write_script(build, folder / "script.mlx", **parameters_of(layer))
    if layer.deleted.any():
        # This host leaves what it deletes in the layer, marked as deleted.
        text = script.read_text().replace("<FilterScript>", '<FilterScript>\n <filter name="Delete Selected Vertices"/>', 1)
        script.write_text(text)
    out, kept, copy = (folder / name for name in ("out.ply", "kept.ply", "kept_copy.ply"))
    project = folder / "learned.mlp"
    moved = not (layer.matrix == np.eye(4)).all()
    code, text = meshlabserver.run(server, *_server_input(layer, folder), *(("-w", project) if moved else ()),
                                   "-o", out, "-m", "vq",
                                   "-o", copy, "-l", 0, "-m", *ALL_ATTRIBUTES, "-o", kept, "-l", 1, "-m", *ALL_ATTRIBUTES,
                                   "-s", script)
    assert code in (0, 255), f"ended with code {code}: {text[-2000:]}"
    if code != 0:
        lines = [line.strip() for line in text.splitlines()]
        problem = next((i for i, line in enumerate(lines) if line.startswith("Problem with filter")), None)
        assert problem is not None, text
        sentences = [line for line in lines if line.endswith(".") and " " in line and not line.startswith(("LOG", "MeshLab"))]
        return Outcome(sentence=" ".join(sentences))
    assert out.exists() and kept.exists(), text
    same = kept.read_bytes() == copy.read_bytes() if not layer.deleted.any() else True
    origin = _translation_of_last(project) if moved else (0, 0, 0)
    return Outcome(host=SERVER, mesh=out, origin=origin, told=meshlabserver.figures(text), unchanged=same)


def _translation_of_last(project):
    """That in the matrix of a project's last layer; the rest of it must be no change."""
    text = ElementTree.parse(project).getroot().findall(".//MLMatrix44")[-1].text
    return _translation_in(np.array(text.split(), dtype=float).reshape(4, 4))


def _translation_in(matrix):
    origin = tuple(matrix[:3, 3])
    assert (matrix == inputs.moved(*origin)).all(), f"the result's matrix is {matrix}"
    return origin


# --- pymeshlab ---------------------------------------------------------------------------------------------------


# pymeshlab 2025.7 goes on logging into the MeshSet in which a filter, any filter, has raised, and crashes when it is
# gone. So MeshSets are kept.
_kept = []


def new_mesh_set(pymeshlab):
    _kept.append(pymeshlab.MeshSet(verbose=False))
    return _kept[-1]


def state(meshes):
    """All that can be asked of every layer, in comparable form."""
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


def _load(pymeshlab, layer, folder):
    meshes = new_mesh_set(pymeshlab)
    cleaned_by_reader = not np.isfinite(layer.points).all() or any(len(set(face)) < 3 for face in layer.faces)
    if cleaned_by_reader:
        faces = np.array([corners for corners, _, _ in layer.triangles()], dtype="i4").reshape(-1, 3)
        quality = layer.quality().astype(float)
        meshes.add_mesh(pymeshlab.Mesh(layer.points.astype(float), faces, v_scalar_array=quality))
    else:
        meshes.load_new_mesh(str(inputs.write_ply(layer, folder / "layer.ply")))
    if layer.deleted.any():
        # The number of selected vertices, by which the host goes, is not read from a file.
        meshes.compute_selection_by_condition_per_vertex(condselect=f"vi >= {layer.deleted.argmax()}")
        meshes.meshing_remove_selected_vertices()
    if not (layer.matrix == np.eye(4)).all():
        meshes.set_matrix(transformmatrix=layer.matrix, freeze=False)
    if layer.textured:
        meshes.current_mesh().add_vertex_custom_scalar_attribute(layer.quality().astype(float), "heat")
    return meshes


def in_pymeshlab(pymeshlab, layer, folder):
    meshes = _load(pymeshlab, layer, folder)
    before = state(meshes)

    def unchanged():
        mesh = meshes.mesh(0)
        kept = not layer.textured or (mesh.vertex_custom_scalar_attribute_array("heat") == layer.quality()).all()
        return kept and state(meshes)[0][0] == before[0][0]

    try:
        told = meshes.apply_filter(PYTHON_NAME, **parameters_of(layer))
    except pymeshlab.PyMeshLabException as error:
        sentence = str(error).split("Details: ", 1)[1].strip()
        return Outcome(sentence=sentence, unchanged=unchanged() and state(meshes) == before)
    assert len(list(meshes)) == 2 and meshes.current_mesh().label() == "Neural Mesh"
    out = folder / "out.ply"
    meshes.save_current_mesh(str(out))
    origin = _translation_in(meshes.current_mesh().transform_matrix())
    return Outcome(host=PYMESHLAB, mesh=out, origin=origin, told=told, unchanged=unchanged())


# --- the libraries of 2022.02 and 2025.07 ------------------------------------------------------------------------


def in_library(build, release, layer, folder):
    out = folder / "out.off"
    plugin = meshlabserver.plugin_path(build, f"meshlab-{release}")
    told, = library_hosts.outcomes(library_hosts.run(build, release, plugin, inputs.write_layer(layer, folder / "layer.txt"), out))
    learned = not told["sentence"]
    assert (told["layers"], told["current"]) == ((3, "Neural Mesh") if learned else (2, "layer"))
    return Outcome(sentence=told["sentence"], host=f"library {release}", mesh=out if learned else None, told=told,
                   origin=_translation_in(np.array(told["matrix"]).reshape(4, 4)) if learned else (0, 0, 0),
                   unchanged=told["unchanged"])


# --- the judge ---------------------------------------------------------------------------------------------------


def try_out(build, server, pymeshlab, host, layer, folder):
    """Hands the layer to the host. AssertionError: a promise is broken."""
    if host == SERVER:
        return in_server(build, server, layer, folder)
    if host == PYMESHLAB:
        return in_pymeshlab(pymeshlab, layer, folder)
    return in_library(build, host.split()[1], layer, folder)


def judge(build, layer, outcome):
    """AssertionError where the outcome is not what inputs.py asks for. Writes beside the result."""
    assert outcome.unchanged, "the input layer has changed"
    if layer.refused:
        assert layer.refused in outcome.sentence, outcome.sentence or "it was learned"
        return
    assert not outcome.sentence, outcome.sentence
    told = outcome.told
    origin = tuple(float(x) for x in outcome.origin)
    assert origin == origin_in(outcome.host, layer), f"coordinates are counted from {origin}"
    points = layer.followed_points() - origin
    file = outcome.mesh.with_name("points.ply")
    models.save_ply(file, points)
    found = meshlabserver.check_mesh(build, outcome.mesh, file)
    assert found["vertices"] == told["vertices"] == layer.target
    assert told["stop_reason"] == 0 and told["boundary_loops"] == 0
    assert found["watertight"] and found["oriented"], "no closed, oriented surface"
    assert found["non_manifold_edges"] == found["non_manifold_vertices"] == found["unreferenced_vertices"] == 0
    assert (found["genus"], found["components"]) == (told["genus"], told["components"])
    assert (found["components"], found["genus"]) == (layer.components, layer.genus), (
        f"{found['components']} components of genus {found['genus']}")
    assert found["rms_to_mesh"] < layer.rms, f"the points are {found['rms_to_mesh']} % from the mesh"
    assert found["max_to_reference"] < layer.far, f"the mesh is up to {found['max_to_reference']} % from the points"
    # Hosts in single precision round the coordinates of the result.
    rounding = np.spacing(np.abs(points).max().astype("f4"))
    per_cent = 100 / np.linalg.norm(np.ptp(points, 0))
    _judge_error_told(layer, told["rms_error"], found["rms_to_mesh"], per_cent * rounding)
    vertices, faces = models.load_mesh(outcome.mesh)
    _judge_volume(layer, vertices, faces)
    _judge_place(layer, points, vertices, rounding)


def _judge_error_told(layer, told, measured, rounding):
    """All in %. The filter measures at samples of the points, hence the allowance."""
    assert told >= 0
    if layer.outliers or (layer.faces and layer.parameters.get("draw_from_faces", True)):
        return  # of samples of the faces, or with outliers among the points: check_mesh has other points
    assert abs(told - measured) < .05 * measured + .001 + rounding, f"it tells {told} %, where {measured} % is measured"


def _judge_volume(layer, vertices, faces):
    expected = layer.world_volume()
    if expected is None:
        return
    a, b, c = np.moveaxis((vertices - vertices.mean(0))[faces], 1, 0)
    volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6
    assert abs(volume - expected) < layer.within * expected, f"it encloses {volume}, not {expected}"


def _judge_place(layer, points, vertices, rounding):
    """All vertices finite and in the box of the points, somewhat larger, and across it."""
    assert np.isfinite(vertices).all(), "vertices that are not finite"
    low, high = points.min(0), points.max(0)
    margin = layer.margin * np.linalg.norm(high - low) + rounding
    assert (vertices >= low - margin).all() and (vertices <= high + margin).all(), "vertices outside the points' box"
    assert (np.ptp(vertices, 0) + rounding >= .7 * (high - low)).all(), "parts of the points are not covered"
