// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/mesh/shape_flips.h"

#include <algorithm>
#include <cmath>

#include "vcg_core/mesh/triangle.h"
#include "vcg_core/mesh/valence_flips.h"

namespace neuralmesh {

namespace {

/// A larger change, as a share of the new edge, may cut surface close by: of a scan of leaves 21 faces.
constexpr float kFlat = 0.01F;

/// \pre network.can_flip(a, b)
bool should_flip(const Network& network, VertexId a, VertexId b, float most) {
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

int flip_edges_for_shape(Network& network, float most) {
    // Each flip raises the smallest qualities, so flips end; far off, where rounding decides, they are ended.
    constexpr int kMostPasses = 20;
    int flips = 0;
    for (int pass = 0, before = -1; pass < kMostPasses && flips > before; ++pass) {
        before = flips;
        for (const VertexId v : network.vertices())
            flips += flip_edges_if(network, v, v,
                                   [&](VertexId a, VertexId b) { return should_flip(network, a, b, most); });
    }
    return flips;
}

}  // namespace neuralmesh
