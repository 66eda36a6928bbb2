# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Small layers, valid and invalid, that a host may pass to the filter, each with the expected result."""

import functools
from dataclasses import dataclass, field

import numpy as np
import shapes

SELECTED = 0x20  # vcg's flag, in the property "flags" of a PLY file
NAN, INF = float("nan"), float("inf")
RECONSTRUCTION = "generate_surface_reconstruction_neural_mesh"
COUNTERS = "compute_scalar_by_neural_normal_counter_per_vertex"
GOLDEN_TURN = 2.399963229728653
BALL = 4 / 3 * np.pi
EACH_POINT_ALIKE = {"even_sampling": False}  # else the points of an uneven cloud have weights in the reported error


@dataclass
class Input:
    """One layer. Arrays have one row per point or face; faces may have more than three corners."""

    points: np.ndarray
    faces: list = field(default_factory=list)
    refused: str = ""  # words of the error message; empty: the layer is learned
    selected_points: np.ndarray = None
    selected_faces: np.ndarray = None
    deleted: np.ndarray = None  # points that are marked as deleted but still stored
    matrix: np.ndarray = field(default_factory=lambda: np.eye(4))
    textured: bool = False
    paint: np.ndarray = None  # the points' colours, RGB from 0 to 255; None: a pattern
    outliers: int = 0  # the number of last points, which the mesh must not follow
    filter: str = RECONSTRUCTION
    parameters: dict = field(default_factory=dict)
    target: int = 250  # vertices
    # The expected mesh; the defaults are those of a ball. Percentages are of the diagonal of followed_points().
    components: int = 1
    genus: int = 0
    loops: int = 0  # boundary loops
    volume: float = BALL  # enclosed, before the matrix is applied; None: nothing is enclosed (a sheet, a line)
    within: float = .03  # relative tolerance of the volume
    rms: float = .12  # from the points to the mesh, %
    far: float = 2.0  # the largest distance from the mesh to the points, %
    margin: float = .05  # how far the mesh may exceed the points' box, in its diagonals
    origin: tuple = (0, 0, 0)  # of the result's coordinates in a float host

    def __post_init__(self):
        # Single precision, so that float and double hosts get the same numbers.
        self.points = np.asarray(self.points, dtype="f4").reshape(-1, 3)
        none = np.zeros(len(self.points), dtype=bool)
        self.deleted = none if self.deleted is None else self.deleted
        self.selected_points = none if self.selected_points is None else self.selected_points
        if self.selected_faces is None:
            self.selected_faces = np.zeros(len(self.faces), dtype=bool)

    def quality(self):
        """The quality that the layer has before the filter runs."""
        return (np.arange(len(self.points)) % 97).astype("f4")

    def colors(self):
        """The colours that the layer has before the filter runs, RGBA from 0 to 255."""
        if self.paint is not None:
            return np.column_stack([self.paint, np.full(len(self.points), 255)]).astype("u1")
        steps = np.arange(len(self.points))
        return np.column_stack([steps % 251, steps % 13 * 19, steps % 7 * 36, steps * 0 + 255]).astype("u1")

    def all_parameters(self):
        return {**({"target_vertices": self.target} if self.filter == RECONSTRUCTION else {}), **self.parameters}

    def triangles(self):
        """The corners of the faces split into fans of triangles."""
        return [(face[0], face[k], face[k + 1]) for face in self.faces for k in range(1, len(face) - 1)]

    def learned_points(self):
        """The points from which the filter draws its signals, in world coordinates."""
        chosen = ~self.deleted
        only_selected = self.parameters.get("selected_only", False)
        if self.faces and self.parameters.get("draw_from_faces", True):
            chosen[:] = False
            for face, selected in zip(self.faces, self.selected_faces):
                chosen[list(face)] |= bool(selected or not only_selected)
        elif only_selected:
            chosen &= self.selected_points
        points = self.points[chosen].astype("f8")
        return points @ self.matrix[:3, :3].T + self.matrix[:3, 3]

    def followed_points(self):
        """The distinct points that the mesh must be near, in world coordinates."""
        points = self.learned_points()
        return np.unique(points[:len(points) - self.outliers], axis=0)

    def world_volume(self):
        return None if self.volume is None else self.volume * abs(np.linalg.det(self.matrix[:3, :3]))


def moved(*translation):
    """The matrix that translates."""
    matrix = np.eye(4)
    matrix[:3, 3] = translation
    return matrix


def ball(count=2000, radius=1.0, centre=(0, 0, 0)):
    """Points distributed evenly over a sphere."""
    steps = np.arange(count)
    z = 1 - (2 * steps + 1) / count
    turn = GOLDEN_TURN * steps
    rim = np.sqrt(1 - z * z)
    return radius * np.column_stack([rim * np.cos(turn), rim * np.sin(turn), z]) + centre


def ball_mesh():
    vertices, faces = shapes.sphere(subdivisions=3)
    return vertices, [tuple(int(v) for v in face) for face in faces]


def spoilt_balls():
    """The corners and faces of a ball, and what the layers of both filters make of them: corners of which one is not finite,
    the upper half of the faces, corners and faces with two fins."""
    vertices, faces = ball_mesh()
    broken = vertices.copy()
    broken[5, 1] = NAN
    half = [face for face in faces if vertices[list(face), 2].mean() > 0]
    finned = np.vstack([vertices, vertices[0] * 1.2, vertices[1] * 1.3])
    return vertices, faces, broken, half, finned, faces + [(0, 1, len(vertices)), (1, 0, len(vertices) + 1)]


def square(count=45):
    u, v = np.meshgrid(np.linspace(0, 1, count), np.linspace(0, 1, count))
    return np.column_stack([u.ravel(), v.ravel(), 0 * u.ravel()])


def quads(count=16):
    """A closed tube of quadrilaterals, bent to a ring."""
    points, faces = [], []
    for i in range(count):
        for j in range(count):
            u, v = 2 * np.pi * i / count, 2 * np.pi * j / count
            points.append([(1 + .4 * np.cos(v)) * np.cos(u), (1 + .4 * np.cos(v)) * np.sin(u), .4 * np.sin(v)])
            corners = ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))
            faces.append(tuple(a % count * count + b % count for a, b in corners))
    return points, faces


def _clouds(random):
    line = np.linspace(0, 1, 100)[:, None] * [1, 2, -1]
    whole = ball(6000)
    dense = whole[:, 0] > 0
    stray = whole[~dense & (random.random(6000) < .001)]
    broken = ball(500)
    broken[[3, 50, 499], [0, 1, 2]] = NAN, INF, -INF
    turned = np.array([[0, -3, 0, 100], [0, 0, 6, -50], [-3, 0, 0, 7], [0, 0, 0, 1]], dtype=float)
    return {
        "empty layer": Input([], refused="no points"),
        # Rounding to single precision moves these points off the line.
        "a line, rounded": Input(line + [5000, -3000, 1000], refused="on curves"),
        "not finite": Input(broken, refused="3 of the 500"),
        "size 1e+30": Input(ball() * 1e30, volume=BALL * 1e90),
        "offset 1e+7": Input(ball(2000, 1000) + [1e7, -1e7, 1e7], volume=BALL * 1e9),
        # In single precision these coordinates are whole numbers: rounding moves points off a plane by 2.8 %, and the
        # diagonal of a cell of that lattice is 16.7 %. The mesh is 1.3 to 1.7 % from the ball; one that follows the rounding,
        # 1.5 to 1.7 % from the points, is 2.3 to 2.6 % from the ball.
        "offset 1e+7, small": Input(ball(2000, 3) + [1e7, -1e7, 1e7], volume=27 * BALL, within=.1, rms=4, far=16.7),
        # The result is a bowl: the few points of the other half are too far apart for a surface. How far its rim
        # reaches towards them depends on the seed: by 2.9 to 8.4 % with seeds 1 to 6.
        "density 1000 : 1": Input(np.vstack([whole[dense], stray]), outliers=len(stray), volume=None, loops=1, rms=.6,
                                  far=10, margin=.1),
        "deleted vertices": Input(np.vstack([ball(), ball(200, 9)]), deleted=np.arange(2200) >= 2000),
        "selected points": Input(np.vstack([ball(), ball(2000, 1, (5, 0, 0))]),
                                 selected_points=np.arange(4000) >= 2000, parameters={"selected_only": True}),
        "nothing selected": Input(ball(), refused="Only the selected vertices", parameters={"selected_only": True}),
        "turned, scaled, moved": Input(ball(), matrix=turned),
        "mirrored": Input(ball(), matrix=np.diag([-1.0, 1, 1, 1])),
        "flattened by its matrix": Input(ball(), matrix=np.diag([1.0, 1, 0, 1]), volume=None, loops=1, rms=.7,
                                         parameters=EACH_POINT_ALIKE),
        "matrix not finite": Input(ball(500), refused="The matrix of the layer", matrix=np.diag([NAN, 1, 1, 1])),
        "georeferenced": Input(ball(), matrix=moved(1e7, -1e7, 1e7), origin=(1e7, -1e7, 1e7)),
        "georeferenced, turned": Input(ball(), matrix=moved(4e5, 5e6, 100) @ turned, origin=(4e5 + 100, 5e6 - 50, 107)),
    }


def _meshes():
    vertices, faces, broken, half, finned, with_fins = spoilt_balls()
    far = np.vstack([vertices, [[50, 50, 50]] * 10])
    both = np.vstack([vertices, vertices + [5, 0, 0]])
    shifted = [tuple(v + len(vertices) for v in face) for face in faces]
    ring, ring_faces = quads()
    ball_of_faces = functools.partial(Input, rms=.14, far=3)  # its vertices are farther apart than the balls' points
    return {
        "mesh": ball_of_faces(vertices, faces),
        "mesh's vertices": ball_of_faces(vertices, faces, parameters={"draw_from_faces": False}),
        "a vertex not finite": Input(broken, faces, refused="1 of the 642 vertices"),
        "unreferenced vertices": ball_of_faces(far, faces),
        "zero-area faces": ball_of_faces(vertices, faces + [(0, 0, 1), (2, 2, 2), (3, 4, 3)]),
        "non-manifold faces": Input(finned, with_fins + faces[:20], rms=.25, far=4.6),
        "open mesh": Input(vertices, half, volume=None, loops=1, rms=1.2, far=4.8),
        "selected faces": ball_of_faces(both, faces + shifted, parameters={"selected_only": True},
                                        selected_faces=np.arange(2 * len(faces)) >= len(faces)),
        "no face selected": Input(vertices, faces, refused="Only the selected faces", parameters={"selected_only": True}),
        "quads": Input(ring, ring_faces, genus=1, volume=3.0, rms=.2, far=7.5),
        # A layer that is cloud and start mesh at once.
        "start from itself": ball_of_faces(vertices, faces, target=1000, parameters={"start_mesh": 2}),
        "start from an open mesh": Input(vertices, half, volume=None, loops=1, rms=1.2, far=4.8, target=700,
                                         parameters={"start_mesh": 2}),
        "start from too many vertices": Input(vertices, faces, refused="needs 642 vertices", parameters={"start_mesh": 2}),
        "start from bad faces": Input(finned, with_fins + faces[:20], refused="faces that repeat others (20)",
                                      target=1000, parameters={"start_mesh": 2}),
        "texture and attributes": ball_of_faces(vertices, faces, textured=True),
    }


def counted_inputs():
    """name -> Input whose counters are asked for. Those with refused = "" get a value at every vertex of a face."""
    count = functools.partial(Input, filter=COUNTERS, parameters={"select_features": True})
    vertices, faces, broken, half, finned, with_fins = spoilt_balls()
    far = np.vstack([[[50, 50, 50]] * 10, vertices])
    moved_faces = [tuple(v + 10 for v in face) for face in faces]
    return {
        "empty layer": count([], refused="no points"),
        "mesh": count(vertices, faces),
        "selection not asked for": count(vertices, faces, parameters={}, selected_points=np.arange(len(vertices)) % 3 == 0),
        "by the counter": count(vertices, faces, parameters={"select_features": True, "select_by": 0}),
        "crease measure": count(vertices, faces, parameters={"feature_measure": 1}),
        "a vertex not finite": count(broken, faces, refused="1 of the 642 vertices"),
        "unreferenced vertices": count(far, moved_faces),
        "deleted vertices": count(np.vstack([vertices, vertices[:9] * 2]), faces,
                                  deleted=np.arange(len(vertices) + 9) >= len(vertices)),
        "open mesh": count(vertices, half),
        "quads": count(*quads()),
        "texture and attributes": count(vertices, faces, textured=True),
        "zero-area faces": count(vertices, faces + [(0, 0, 1), (2, 2, 2)], refused="faces with a corner twice (2)"),
        "repeated faces": count(vertices, faces + faces[:20], refused="faces that repeat others (20)"),
        "fins": count(finned, with_fins, refused="edges with more than two faces"),
        "georeferenced": count(vertices, faces, matrix=moved(1e7, -1e7, 1e7)),
        "matrix not finite": count(vertices, faces, matrix=np.diag([NAN, 1, 1, 1]), refused="The matrix of the layer"),
    }


def all_inputs():
    """name -> Input, the same at every call."""
    return {**_clouds(np.random.default_rng(1)), **_meshes()}


def write_ply(layer, path):
    """Writes the layer as a PLY file, which cannot contain its matrix and deleted points."""
    points = np.empty(len(layer.points), dtype=[("xyz", "<f4", 3), ("quality", "<f4"), ("color", "u1", 4), ("flags", "<i4")])
    points["xyz"], points["quality"], points["color"] = layer.points, layer.quality(), layer.colors()
    # The host deletes the selected vertices by its own filter.
    points["flags"] = np.where(layer.selected_points | layer.deleted, SELECTED, 0)
    header = ["ply", "format binary_little_endian 1.0"]
    if layer.textured:
        header.append("comment TextureFile none.png")
    header += [f"element vertex {len(points)}", *(f"property float {name}" for name in ("x", "y", "z", "quality")),
               *(f"property uchar {name}" for name in ("red", "green", "blue", "alpha")), "property int flags",
               f"element face {len(layer.faces)}", "property list uchar int vertex_indices"]
    if layer.textured:
        header.append("property list uchar float texcoord")
    header += ["property int flags", "end_header", ""]
    rows = []
    for face, selected in zip(layer.faces, layer.selected_faces):
        rows.append(np.uint8(len(face)).tobytes() + np.array(face, dtype="<i4").tobytes())
        if layer.textured:
            rows.append(np.uint8(6).tobytes() + np.array([0, 0, 1, 0, 0, 1], dtype="<f4").tobytes())
        rows.append(np.int32(SELECTED if selected else 0).tobytes())
    path.write_bytes("\n".join(header).encode() + points.tobytes() + b"".join(rows))
    return path
