// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/shell/node_groups.h"

#include <vector>

namespace neuralmesh {
namespace {

long long points_in(const std::vector<NodeId>& nodes, const PerNode<std::uint32_t>& counts) {
    long long points = 0;
    for (const NodeId i : nodes) points += counts[i];
    return points;
}

}  // namespace

NodeSet solid_of(const Lattice& lattice, const PerNode<SquaredRadius>& clearance,
                 const PerNode<std::uint32_t>& counts, int level, long long min_points) {
    NodeSet result(lattice.size(), 0);
    const auto solid = [&](NodeId i) { return clearance[i] <= level; };
    for_each_component(lattice, solid, [&](const std::vector<NodeId>& component) {
        if (points_in(component, counts) < min_points) return;
        for (const NodeId i : component) result[i] = 1;
    });
    return result;
}

}  // namespace neuralmesh
