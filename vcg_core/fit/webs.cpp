// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/webs.h"

#include <algorithm>
#include <vector>

#include "vcg_core/base/ablation.h"

namespace neuralmesh {

namespace {

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
