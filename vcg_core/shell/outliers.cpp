// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// By the groups they lie in.
#include "vcg_core/shell/outliers.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "vcg_core/shell/node_groups.h"

namespace neuralmesh {
namespace {

using vcg::Box3f;
using vcg::Point3f;

/// Deeper in the solid than this times the widest gap of its surface lies nothing of the surface.
constexpr double kDeep = 2;

/// The squared depth in lattice steps from which on a point that is alone is inside, not of the surface.
int depth_of_inside(const Region& region, int level) {
    const double gap = std::sqrt(static_cast<double>(level)) +
                       region.widest_opening / static_cast<double>(region.lattice.step);
    const double depth = kDeep * std::max(gap, 1.0);
    return static_cast<int>(std::min(depth * depth, 1e6));
}

/// 1 for the nodes whose points are outliers.
std::vector<std::uint8_t> outlying_nodes(const Region& region, const std::vector<std::uint8_t>& solid,
                                         int level) {
    const std::vector<std::uint8_t> together =
        solid_of(region.lattice, region.distances, region.counts, level, region.enough);
    std::vector<std::uint8_t> outlying(together.size());
    for (std::size_t i = 0; i < outlying.size(); ++i)
        outlying[i] = region.counts[i] != 0 && together[i] == 0 ? 1 : 0;
    if (std::count(outlying.begin(), outlying.end(), 1) == 0) return outlying;
    const int inside = depth_of_inside(region, level);
    std::vector<std::uint32_t> outside(solid.size());
    for (std::size_t i = 0; i < solid.size(); ++i) outside[i] = solid[i] == 0 ? 1 : 0;
    const std::vector<SquaredRadius> depths = squared_distances(region.lattice, outside, Region::kReach);
    for (std::size_t i = 0; i < outlying.size(); ++i)
        if (solid[i] != 0 && depths[i] <= inside) outlying[i] = 0;
    return outlying;
}

}  // namespace

Box3f main_box(const std::vector<Point3f>& points) {
    constexpr int kCells = 32, kRounds = 8;
    Box3f box;
    for (const Point3f& p : points) box.Add(p);
    for (int round = 0; round < kRounds; ++round) {
        const float side = longest_side(box);
        double cells = kCells;
        std::vector<std::uint32_t> counts;
        Lattice lattice(box, side / static_cast<float>(cells), 1);
        for (counts = count_points(lattice, points); points_per_occupied_node(counts) < 4 && cells > 4;) {
            cells *= 0.75;  // connected groups need cells wider than the gaps between points
            lattice = Lattice(box, side / static_cast<float>(cells), 1);
            counts = count_points(lattice, points);
        }
        const Box3f kept = box_of_large_groups(lattice, counts, 0.01, 0.9);
        if (kept.IsNull() || longest_side(kept) > 0.5F * side) break;
        box = kept;
    }
    return box;
}

std::vector<std::uint8_t> outliers_of(const std::vector<Point3f>& points, const Region& region,
                                      const std::vector<std::uint8_t>& solid, int level) {
    const std::vector<std::uint8_t> outlying = outlying_nodes(region, solid, level);
    std::vector<std::uint8_t> result;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::size_t node = region.lattice.node_of(points[i]);
        if (node < outlying.size() && outlying[node] == 0) continue;
        result.resize(points.size(), 0);
        result[i] = 1;
    }
    return result;
}

}  // namespace neuralmesh
