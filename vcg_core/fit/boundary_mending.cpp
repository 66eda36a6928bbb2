// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/boundary_mending.h"

#include <algorithm>

#include "vcg_core/base/ablation.h"
#include "vcg_core/fit/boundary_targets.h"
#include "vcg_core/fit/face_rules.h"

namespace neuralmesh {

namespace {

// Chosen by tests/experiments/accuracy/open_table.py.
constexpr float kWidest = -0.2F;      ///< cosine of the widest angle of a notch
constexpr float kNarrowNotch = 0.7F;  ///< cosine of the angle below which a notch need not hold points ...
constexpr float kFewInNotch = 4;      ///< ... if no more than these are expected
constexpr float kLeastShare = 0.5F;   ///< of the points expected
constexpr float kFlatNotch = 0.5F;    ///< least cosine between the normals of the new face and its neighbours

/// The face that would fill the notch at v: v and its neighbours before and after it.
struct Notch {
    Vector3 here, to_before, to_after, area;

    Notch(const Surface& surface, const Ring& ring, VertexId v)
        : here(surface.positions[v]),
          to_before(surface.positions[ring[ring.valence - 1]] - here),
          to_after(surface.positions[ring[0]] - here),
          area(to_before.cross(to_after)) {}

    float cosine() const { return to_before.dot(to_after) / (to_before.norm() * to_after.norm()); }

    bool holds(const Vector3& point) const {
        const Vector3 p = point - here;
        const float before = p.cross(to_after).dot(area);
        const float after = to_before.cross(p).dot(area);
        return before >= 0 && after >= 0 && before + after <= area.squaredNorm();
    }

    bool is_sound(const Surface& surface, const Ring& ring) const {
        const auto at = [&](int i) { return surface.positions[ring[i]]; };
        const int last = ring.valence - 1;
        const Vector3 normal = area.normalized();
        return normal.dot(unit_normal(here, at(0), at(1))) > kFlatNotch &&
               normal.dot(unit_normal(here, at(last - 1), at(last))) > kFlatNotch &&
               triangle_quality(here, at(last), at(0)) > kFlipRules.sliver;
    }
};

bool is_notch(const Network& network, const Surface& surface, const PointsByFace& points, float density,
              VertexId v) {
    if (!network.can_fill_notch(v)) return false;
    const Notch notch(surface, network.ring(v), v);
    if (!(notch.cosine() > kWidest) || !notch.is_sound(surface, network.ring(v))) return false;
    const float expected = density * notch.area.norm() / 2;
    if (notch.cosine() > kNarrowNotch && expected < kFewInNotch) return true;
    int count = 0;
    for (int f : surface.faces_around(v))
        for (const PointsByFace::Assignment& assigned : points.of(f))
            if (is_beyond_boundary(surface, {f, assigned.foot}) && notch.holds(assigned.point)) ++count;
    return count > 0 && static_cast<float>(count) >= kLeastShare * expected;
}

// Tried with tests/experiments/accuracy/open_table.py, one value each.
constexpr int kRingsOfWeb = 3;        ///< of the density, over the rings
constexpr float kFewestExpected = 8;  ///< fewer say nothing
constexpr float kMostShare = 0.1F;    ///< of the points expected

/// Points per area around every vertex. Faces without points do not count, since those of a web have none.
PerVertex<float> supported_density(const Network& network, const Surface& surface,
                                   const PointsByFace& points) {
    PerFace<float> counts = points.counts();
    for (float& count : counts)
        if (count == 0) count = -1;
    return point_density(network, surface, counts, kRingsOfWeb);
}

/// Whether the face lacks the points that the least dense of its corners lets expect. Points whose foot is on
/// an edge lie beyond it, on other surface.
bool is_web(const Surface& surface, const PointsByFace& points, const PerVertex<float>& density, int f) {
    const Triangle& corners = surface.faces[f];
    const float least = std::min({density[corners[0]], density[corners[1]], density[corners[2]]});
    const float expected = least * area_vector(surface, f).norm() / 2;
    if (!(expected >= kFewestExpected)) return false;
    int count = 0;
    for (const PointsByFace::Assignment& assigned : points.of(f)) {
        const auto& w = assigned.foot.weights;
        if (w[0] > 0 && w[1] > 0 && w[2] > 0) ++count;
    }
    return static_cast<float>(count) <= kMostShare * expected;
}

}  // namespace

std::vector<VertexId> find_notches(const Network& network, const Surface& surface,
                                   const PointsByFace& points) {
    std::vector<VertexId> notches;
    if (!surface.has_boundary() || skips("notches")) return notches;
    const PerVertex<float> density = inner_density(network, surface, points);
    for (VertexId v : network.vertices())
        if (is_notch(network, surface, points, density[v], v)) notches.push_back(v);
    return notches;
}

int fill_notches(Network& network, const std::vector<VertexId>& notches, const PerVertex<char>& barred) {
    PerVertex<char> touched = barred;
    int filled = 0;
    for (VertexId v : notches) {
        if (!network.can_fill_notch(v)) continue;
        const Ring& ring = network.ring(v);
        const Triangle corners{v, ring[0], ring[ring.valence - 1]};
        if (touched[corners[0]] + touched[corners[1]] + touched[corners[2]] > 0) continue;
        for (VertexId u : corners) touched[u] = 1;
        network.fill_notch(v);
        ++filled;
    }
    return filled;
}

int open_webs(Network& network, const Surface& surface, const PointsByFace& points,
              const PerVertex<char>& barred) {
    if (!surface.has_boundary() || skips("webs")) return 0;
    const PerVertex<float> density = supported_density(network, surface, points);
    std::vector<VertexId> starts;  // of the boundary edges to look at
    for (const VertexId v : network.vertices())
        if (network.ring(v).open != 0) starts.push_back(v);
    int opened = 0;
    for (std::size_t i = 0; i < starts.size(); ++i) {
        const VertexId v = starts[i];
        if (!network.can_open_face(v)) continue;
        const VertexId after = network.ring(v)[0], corner = network.ring(v)[1];
        if (barred[v] + barred[after] + barred[corner] > 0) continue;
        const int f = corner_of_edge(surface, v, after).face;
        if (f < 0 || !is_web(surface, points, density, f)) continue;
        network.open_face(v);
        ++opened;
        starts.push_back(v);
        starts.push_back(corner);
    }
    return opened;
}

}  // namespace neuralmesh
