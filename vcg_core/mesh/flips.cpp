// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/mesh/flips.h"

#include <algorithm>
#include <cmath>

#include "vcg_core/mesh/triangle.h"

namespace neuralmesh {

namespace {

/// \pre network.can_flip(a, b)
bool should_flip(const Network& network, VertexId a, VertexId b, const FlipRule& rule) {
    const Ring& ring = network.ring(a);
    const int i = ring.find(b);
    const VertexId c = ring.next(i);
    const VertexId d = ring.previous(i);
    const auto valence = [&](VertexId v) { return static_cast<int>(network.ring(v).valence); };
    if (valence(c) >= rule.max_valence || valence(d) >= rule.max_valence) return false;
    const auto excess = [&](VertexId v) {
        return valence(v) - (network.ring(v).open != 0 ? kRegularBoundaryValence : kRegularValence);
    };
    // a and b lose an edge, c and d gain one: the sum of the squared excesses falls by twice the difference
    // below minus 4.
    if (excess(a) + excess(b) - excess(c) - excess(d) <= 2) return false;
    const vcg::Point3f pa = network.position(a);
    const vcg::Point3f pb = network.position(b);
    const vcg::Point3f pc = network.position(c);
    const vcg::Point3f pd = network.position(d);
    return rule.is_flat({{area_vector(pa, pb, pc), area_vector(pb, pa, pd)},
                         {area_vector(pa, pd, pc), area_vector(pb, pc, pd)}});
}

/// A larger change, as a share of the new edge, may cut surface close by: of a scan of leaves 21 faces.
constexpr float kFlat = 0.01F;

/// \pre network.can_flip(a, b)
bool improves_shape(const Network& network, VertexId a, VertexId b, float most) {
    const Ring& ring = network.ring(a);
    const int i = ring.find(b);
    const Vector3 pa = to_eigen(network.position(a)), pb = to_eigen(network.position(b));
    const Vector3 pc = to_eigen(network.position(ring.next(i)));
    const Vector3 pd = to_eigen(network.position(ring.previous(i)));
    const Vector3 across = (pb - pa).cross(pd - pc);
    const float change = std::min(most, kFlat * (pd - pc).norm());
    if (!(std::abs((pc - pa).dot(across)) <= change * across.norm())) return false;
    const Vector3 before = area_vector(pa, pb, pc) + area_vector(pb, pa, pd);
    if (!(before.dot(area_vector(pa, pd, pc)) > 0 && before.dot(area_vector(pb, pc, pd)) > 0)) return false;
    return std::min(triangle_quality(pa, pd, pc), triangle_quality(pb, pc, pd)) >
           std::min(triangle_quality(pa, pb, pc), triangle_quality(pb, pa, pd));
}

}  // namespace

int flip_edges_for_valence(Network& network, VertexId v, const FlipRule& rule, VertexId least) {
    return flip_edges_if(network, v, least,
                         [&](VertexId a, VertexId b) { return should_flip(network, a, b, rule); });
}

int flip_edges_for_valence(Network& network, const FlipRule& rule) {
    int flips = 0;
    for (const VertexId v : network.vertices()) flips += flip_edges_for_valence(network, v, rule, v);
    return flips;
}

int flip_edges_for_shape(Network& network, float most) {
    // Each flip raises the smallest qualities, so flips end; far off, where rounding decides, they are ended.
    constexpr int kMostPasses = 20;
    int flips = 0;
    for (int pass = 0, before = -1; pass < kMostPasses && flips > before; ++pass) {
        before = flips;
        for (const VertexId v : network.vertices())
            flips += flip_edges_if(
                network, v, v, [&](VertexId a, VertexId b) { return improves_shape(network, a, b, most); });
    }
    return flips;
}

}  // namespace neuralmesh
