// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The network's geometry as an indexed triangle mesh, with the faces around each vertex: for computations
// over faces that leave the connectivity alone.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "vcg_core/base/indexed.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/mesh/triangle.h"

namespace neuralmesh {

/// A copy: later changes of the network do not show in it. Its positions may be changed freely.
class Surface {
public:
    /// O(vertices).
    explicit Surface(const Network& network);

    PerVertex<Vector3> positions;  ///< by slot of the network
    PerFace<Triangle> faces;       ///< Network::faces()
    std::optional<Vector3> viewer;  ///< Network::viewer()

    int face_count() const { return faces.size(); }
    bool has_boundary() const { return !boundary_.empty(); }
    /// Whether the edge from corner \p k to the next one, of \p face, lies on the boundary.
    bool on_boundary(int face, std::size_t k) const {
        return has_boundary() && (boundary_[face] >> k & 1) != 0;
    }
    /// Positive if a face at \p p with such a \p normal shows its front to the viewer, or if there is none;
    /// grows with the cosine between the normal and the line of sight.
    float facing(const Vector3& normal, const Vector3& p) const {
        return viewer ? normal.dot(*viewer - p) : 1.0F;
    }
    /// Whether a face at \p p is turned away from the viewer \p after a change, further than it was \p
    /// before. Of normals of length 1.
    bool turns_away(const Vector3& before, const Vector3& after, const Vector3& p) const {
        return facing(after, p) < std::min(0.0F, facing(before, p));
    }
    /// Position of corner \p k, 0 to 2, of \p face.
    const Vector3& corner(int face, int k) const {
        return positions[faces[face][static_cast<std::size_t>(k)]];
    }
    /// The faces that have \p v as a corner, in rising order.
    Span<const int> faces_around(VertexId v) const {
        return {face_of_.data() + first_face_[v], face_of_.data() + first_face_[v + 1]};
    }

private:
    void mark_boundary(const Network& network);

    PerFace<std::uint8_t> boundary_;  ///< bit k: on_boundary(face, k); empty for closed surfaces
    PerVertex<int> first_face_;       ///< where those of a slot begin in face_of_; one more entry at the end
    std::vector<int> face_of_;
};

/// A face, and its point that is nearest to a given point.
struct Hit {
    int face;
    Foot foot;
};

inline Vector3 area_vector(const Triangle& face, const PerVertex<Vector3>& positions) {
    return area_vector(positions[face[0]], positions[face[1]], positions[face[2]]);
}
inline Vector3 area_vector(const Surface& surface, int face) {
    return area_vector(surface.faces[face], surface.positions);
}
inline Vector3 unit_normal(const Surface& surface, int face) {
    return area_vector(surface, face).normalized();
}

/// A face and one of its corners, 0 to 2; face -1: there is none.
struct FaceCorner {
    int face = -1;
    std::size_t corner = 0;
};

/// The face with the edge from \p a to \p b in its sense of rotation, and the corner of \p a there.
FaceCorner corner_of_edge(const Surface& surface, VertexId a, VertexId b);

/// Replaces \p faces by those at any of \p vertices, each once, in rising order.
template <class Vertices>
void collect_faces(const Surface& surface, const Vertices& vertices, std::vector<int>& faces) {
    faces.clear();
    for (const VertexId v : vertices)
        for (const int f : surface.faces_around(v)) faces.push_back(f);
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
}

/// Unit normal of the face beyond the edge \p a to \p b of a face, which has it as b to a; 0 on a boundary.
/// O(valence).
Vector3 normal_beyond(const Surface& surface, VertexId a, VertexId b);

/// Whether the foot lies on a boundary edge or at its end: the point is beyond the boundary.
inline bool is_beyond_boundary(const Surface& surface, const Hit& hit) {
    const auto& w = hit.foot.weights;
    for (std::size_t k = 0; surface.has_boundary() && k < 3; ++k)
        if (surface.on_boundary(hit.face, k) && !(w[(k + 2) % 3] > 0)) return true;
    return false;
}

/// Squared, of \p p from the nearest of \p faces; the largest float if there are none. O(faces).
float squared_distance_from(const Surface& surface, Span<const int> faces, const Vector3& p);

/// Mean length of the edges; those on a boundary have half the weight. O(faces). \pre the surface has a face
float mean_edge_length(const Surface& surface);

/// Mean length of the edges at \p v, whose ring is \p ring. O(valence).
float mean_edge_length_at(const PerVertex<Vector3>& positions, const Ring& ring, VertexId v);

/// Moves the vertices of \p network to \p positions. O(vertices).
void place_vertices(Network& network, const PerVertex<Vector3>& positions);

/// Adds the values of its neighbours to the value of every vertex, and repeats this \p times times. The
/// results are sums over neighbourhoods of that many rings, in which near vertices weigh more. O(times x
/// vertices).
template <class Value>
void spread_over_rings(const Network& network, PerVertex<Value>& values, int times) {
    for (int time = 0; time < times; ++time) {
        const PerVertex<Value> before = values;
        for (VertexId v : network.vertices())
            for (VertexId u : network.ring(v)) values[v] += before[u];
    }
}

/// Rings over which the noise is averaged out of normals, mostly.
constexpr int kRingsOfNormals = 2;

/// Around every vertex the area vectors of the faces, summed over \p rings rings as by spread_over_rings(): a
/// normal of any length. O(rings x vertices).
PerVertex<Vector3> area_vectors_around(const Network& network, const Surface& surface, int rings);

/// Points per area around every vertex: \p points on the faces over the areas of these, both summed over \p
/// rings rings as by spread_over_rings(). Faces with a negative number do not count; 0 where none counts.
/// O(rings x vertices).
PerVertex<float> point_density(const Network& network, const Surface& surface, const PerFace<float>& points,
                               int rings);

/// Where a walk begins: at a vertex, with the given one of the faces around it.
struct WalkStart {
    VertexId vertex = 0;
    int turn = 0;  ///< index into faces_around(vertex); one out of range has no effect
};

/// Start of the next walk for the same point: the corner of the hit face nearest to the foot, and that face.
WalkStart walk_start_of(const Surface& surface, const Hit& hit);

/// The nearest face of \p p that a walk finds: it looks at the faces around \p start, goes to the corner
/// nearest to the best foot, and repeats that while the distance falls. May miss the nearest face across a
/// thin gap, where FaceTree does not. Expected O(1) if the start is near.
Hit walk_to_nearest(const Surface& surface, const Vector3& p, WalkStart start);

}  // namespace neuralmesh
