// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/start/outliers.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace neuralmesh {
namespace {

using vcg::Point3f;

// For outliers_of(). Gaps of a surface let points sink in: deeper than this many times the radius of the
// widest gap, a point is not of the surface.
constexpr double kDepthOverGap = 2;
constexpr double kMaxSquaredDepth = 1e6;  // so that it fits into an int

/// The squared depth in lattice steps up to which an isolated point still counts as one of the surface.
int max_squared_depth(const Region& region, int level) {
    const double gap = std::sqrt(static_cast<double>(level)) +
                       region.widest_opening / static_cast<double>(region.lattice.step);
    const double depth = kDepthOverGap * std::max(gap, 1.0);
    return static_cast<int>(std::min(depth * depth, kMaxSquaredDepth));
}

/// The occupied nodes, without the fringe, that are far from all large groups.
NodeSet isolated_nodes(const Region& region, int level) {
    const NodeSet large =
        solid_of(region.lattice, region.distances, region.counts, level, region.min_points).nodes;
    NodeSet isolated(large.size());
    for (NodeId i = 0; i < isolated.size(); ++i) isolated[i] = region.counts[i] != 0 && large[i] == 0 ? 1 : 0;
    return isolated;
}

/// Removes from \p nodes those in the outer layer of \p solid.
void remove_surface_nodes(const Region& region, const NodeSet& solid, int level, NodeSet& nodes) {
    const int max_depth = max_squared_depth(region, level);
    PerNode<std::uint32_t> outside(solid.size());
    for (NodeId i = 0; i < solid.size(); ++i) outside[i] = solid[i] == 0 ? 1 : 0;
    const PerNode<SquaredRadius> depths = squared_distances(region.lattice, outside, Region::kMaxRadius);
    for (NodeId i = 0; i < nodes.size(); ++i)
        if (solid[i] != 0 && depths[i] <= max_depth) nodes[i] = 0;
}

}  // namespace

std::vector<std::uint8_t> outliers_of(const std::vector<Point3f>& points, const Region& region,
                                      const NodeSet& solid, int level) {
    NodeSet outlying = isolated_nodes(region, level);
    if (std::find(outlying.begin(), outlying.end(), 1) != outlying.end())
        remove_surface_nodes(region, solid, level, outlying);
    std::vector<std::uint8_t> result;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const NodeId node = region.lattice.node_of(points[i]);
        if (node < outlying.size() && outlying[node] == 0) continue;
        result.resize(points.size(), 0);
        result[i] = 1;
    }
    return result;
}

}  // namespace neuralmesh
