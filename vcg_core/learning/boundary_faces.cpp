// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/learning/boundary_faces.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "vcg_core/base/ablation.h"
#include "vcg_core/mesh/triangle.h"

namespace neuralmesh {

namespace {

/// Cosine of the angle, 134 degrees, from which on the third corner joins the boundary.
constexpr float kWidestAngle = -0.7F;
/// Cosine of the angle, 73 degrees, below which an ear stays: there a tip with two neighbours is regular.
constexpr float kSharpEar = 0.3F;
// The next three chosen by tests/experiments/accuracy/open_table.py.
/// Cosine of the angle between boundary edges, 90 degrees, below which a notch is filled, and of the one, 46
/// degrees, below which its sides are joined.
constexpr float kNotch = 0;
constexpr float kSlit = 0.7F;
/// A boundary of fewer edges turns so fast that its corners look like notches: mending would close it.
constexpr int kShortLoop = 40;
/// Cosine of the least angle, 240 degrees, of the faces around a notch. Around a spike it is less.
constexpr float kCosineAroundNotch = -.5F;
/// The mouth of a notch: the points of the face that fills it, by their weights (barycentric coordinates) at
/// the notch and at its neighbours. No signal from beyond a boundary that is a little too far in gets there.
constexpr float kMostAtNotch = 0.33F;
constexpr float kLeastBeside = 0.2F;
/// Signals farther from the plane of that face than this share of its mouth belong to other surface.
constexpr float kAside = 0.5F;

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

/// A boundary vertex that lies inside of its neighbours along the boundary.
struct Notch {
    VertexId v, after, before;
    float cosine;  ///< of the angle between its boundary edges
};

/// \return whether the sides of the notch meet or overlap
bool is_slit(const Network& network, const Notch& notch) {
    if (notch.cosine > kSlit) return true;
    const Ring& ring = network.ring(notch.v);
    vcg::Point3f side(0, 0, 0);
    for (int i = 0; i < ring.face_count(); ++i) side += area_of(network, notch.v, ring[i], ring.next(i));
    return area_of(network, notch.v, notch.before, notch.after) * side <= 0;
}

/// \return whether the faces of boundary vertex \p v together turn by more than 240 degrees around it. Their
/// angles are added as a product of unit complex numbers: an arc cosine would differ between systems.
bool is_widely_surrounded(const Network& network, VertexId v) {
    const Ring& ring = network.ring(v);
    float cosine = 1, sine = 0;
    bool past_half = false;
    for (int i = 0; i < ring.face_count(); ++i) {
        const float c = std::clamp(cosine_at(network, v, ring[i], ring.next(i)), -1.0F, 1.0F);
        const float s = std::sqrt(1 - c * c);
        const float turned = cosine * c - sine * s;
        sine = sine * c + cosine * s;
        cosine = turned;
        if (past_half && sine >= 0) return true;
        past_half = past_half || sine < 0;
    }
    return past_half && cosine > kCosineAroundNotch;
}

/// Whether a signal lies in the mouth of the notch: then the surface goes on there.
bool is_signalled(const Network& network, BoundarySignals& won, const Notch& notch) {
    const vcg::Point3f& before = network.position(notch.before);
    const vcg::Point3f& after = network.position(notch.after);
    const vcg::Point3f& here = network.position(notch.v);
    const vcg::Point3f area = area_of(network, notch.v, notch.before, notch.after);
    const float squared = area.SquaredNorm();
    const float most_aside = kAside * (after - before).Norm() * std::sqrt(squared);
    const auto in_mouth = [&](const vcg::Point3f& s) {
        const float at_before = area_vector(here, s, after) * area;
        const float at_after = area_vector(here, before, s) * area;
        return at_before > kLeastBeside * squared && at_after > kLeastBeside * squared &&
               squared - at_before - at_after < kMostAtNotch * squared &&
               squared - at_before - at_after > 0 && std::abs((s - here) * area) < most_aside;
    };
    const VertexId corners[] = {notch.v, notch.before, notch.after};
    return std::any_of(std::begin(corners), std::end(corners),
                       [&](VertexId u) { return won.any_of(u, in_mouth); });
}

/// Joins the neighbours of the notch along the boundary, at the one farther from it.
bool close_slit(LearningState& state, const Notch& notch) {
    Network& network = state.network;
    const auto distance = [&](VertexId u) {
        return (network.position(u) - network.position(notch.v)).SquaredNorm();
    };
    VertexId gone = notch.before, kept = notch.after;
    if (distance(gone) > distance(kept)) std::swap(gone, kept);
    network.fill_notch(notch.v);
    if (!network.can_collapse(gone, kept)) {
        network.open_face(notch.before);
        return false;
    }
    state.collapse(gone, kept);
    return true;
}

bool is_in_short_loop(const Network& network, VertexId v) {
    VertexId u = v;
    for (int i = 0; i < kShortLoop - 1; ++i) {
        u = network.ring(u)[0];
        if (u == v) return true;
    }
    return false;
}

/// \return whether the boundary at \p v was changed
bool mend_notch(LearningState& state, BoundarySignals& won, VertexId v, bool may_remove) {
    Network& network = state.network;
    if (!network.can_fill_notch(v) || skips("learned_notches")) return false;
    const Ring& ring = network.ring(v);
    const VertexId after = ring[0], before = ring[ring.valence - 1];
    const Notch notch{v, after, before, cosine_at(network, v, after, before)};
    if (!(notch.cosine > kNotch) || !is_widely_surrounded(network, v)) return false;
    const bool in_short_loop = is_in_short_loop(network, v);
    if (is_slit(network, notch)) return may_remove && !in_short_loop && close_slit(state, notch);
    if (in_short_loop && !is_signalled(network, won, notch)) return false;
    network.fill_notch(v);
    return true;
}

}  // namespace

int mend_boundary_faces(LearningState& state, BoundarySignals& won, bool may_remove) {
    int changed = 0;
    const auto on_boundary = [&](VertexId v) {
        return state.network.alive(v) && state.network.ring(v).open != 0 && !skips("boundary_faces");
    };
    for (const VertexId v : state.network.vertices()) {
        const Ring& ring = state.network.ring(v);
        if (on_boundary(v) && mend(state, {v, ring[0], ring[1]}, may_remove)) ++changed;
        if (on_boundary(v) && mend_notch(state, won, v, may_remove)) ++changed;
    }
    return changed;
}

}  // namespace neuralmesh
