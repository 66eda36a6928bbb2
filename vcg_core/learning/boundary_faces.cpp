// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/learning/boundary_faces.h"

#include <cmath>

#include "vcg_core/mesh/triangle.h"

namespace neuralmesh {

namespace {

/// Cosine of the angle, 134 degrees, from which on the third corner joins the boundary.
constexpr float kWidestAngle = -0.7F;
/// Cosine of the angle, 73 degrees, below which an ear stays: there a tip with two neighbours is regular.
constexpr float kSharpEar = 0.3F;

/// The face at the boundary edge from a to b, with its third corner c.
struct BoundaryFace {
    VertexId a, b, c;
};

vcg::Point3f area_of(const Network& network, VertexId u, VertexId v, VertexId w) {
    return area_vector(network.position(u), network.position(v), network.position(w));
}

/// The sum of the area vectors of the other faces around c.
vcg::Point3f area_beside(const Network& network, const BoundaryFace& face) {
    const Ring& ring = network.ring(face.c);
    vcg::Point3f sum(0, 0, 0);
    for (int i = 0; i < ring.face_count(); ++i)
        if (ring[i] != face.a) sum += area_of(network, face.c, ring[i], ring.next(i));
    return sum;
}

float cosine_at(const Network& network, VertexId v, VertexId a, VertexId b) {
    const vcg::Point3f to_a = network.position(a) - network.position(v);
    const vcg::Point3f to_b = network.position(b) - network.position(v);
    return to_a * to_b / std::sqrt(to_a.SquaredNorm() * to_b.SquaredNorm());
}

/// Flips the inner edge u-v of the face (u, v, w) if neither new face is folded against \p side.
bool flip_unfolds(Network& network, VertexId u, VertexId v, VertexId w, const vcg::Point3f& side) {
    if (!network.can_flip(u, v)) return false;
    const Ring& ring = network.ring(u);
    const VertexId opposite = ring.previous(ring.find(v));
    if (area_of(network, u, opposite, w) * side <= 0 || area_of(network, v, w, opposite) * side <= 0)
        return false;
    network.flip(u, v);
    return true;
}

/// A face with two boundary edges, which meet at the tip.
struct Ear {
    VertexId tip, after, before;
};

bool mend_ear(LearningState& state, const Ear& ear, bool folded, const vcg::Point3f& side, bool may_remove) {
    Network& network = state.network;
    if (!folded && cosine_at(network, ear.tip, ear.after, ear.before) > kSharpEar) return false;
    if (flip_unfolds(network, ear.after, ear.before, ear.tip, side)) return true;
    if (!folded || !may_remove || !network.can_collapse(ear.tip, ear.after)) return false;
    state.collapse(ear.tip, ear.after);
    return true;
}

/// \return whether the face was changed
bool mend(LearningState& state, const BoundaryFace& face, bool may_remove) {
    Network& network = state.network;
    const vcg::Point3f side = area_beside(network, face);
    const bool folded = area_of(network, face.a, face.b, face.c) * side < 0;
    for (const Ear& ear : {Ear{face.a, face.b, face.c}, Ear{face.b, face.c, face.a}})
        if (network.ring(ear.tip).valence == 2) return mend_ear(state, ear, folded, side, may_remove);
    if (network.can_open_face(face.a) &&
        (folded || cosine_at(network, face.c, face.a, face.b) < kWidestAngle)) {
        network.open_face(face.a);
        return true;
    }
    return folded && (flip_unfolds(network, face.b, face.c, face.a, side) ||
                      flip_unfolds(network, face.c, face.a, face.b, side));
}

}  // namespace

int mend_boundary_faces(LearningState& state, bool may_remove) {
    int changed = 0;
    for (const VertexId v : state.network.vertices()) {
        const Ring& ring = state.network.ring(v);
        if (ring.open != 0 && mend(state, {v, ring[0], ring[1]}, may_remove)) ++changed;
    }
    return changed;
}

}  // namespace neuralmesh
