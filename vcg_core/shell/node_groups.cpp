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

vcg::Box3f box_of_large_groups(const Lattice& lattice, const PerNode<std::uint32_t>& counts,
                               double component_share, double total_share) {
    double total = 0, held = 0;
    for (const std::uint32_t c : counts) total += c;
    const float half_step = lattice.step * 0.5F;
    const vcg::Point3f half(half_step, half_step, half_step);
    const auto occupied = [&](NodeId i) { return counts[i] != 0; };
    vcg::Box3f box;
    for_each_component(lattice, occupied, [&](const std::vector<NodeId>& component) {
        const double points = static_cast<double>(points_in(component, counts));
        if (points < component_share * total) return;
        held += points;
        for (const NodeId i : component) {
            box.Add(lattice.position(i) - half);
            box.Add(lattice.position(i) + half);
        }
    });
    return held >= total_share * total ? box : vcg::Box3f();
}

}  // namespace neuralmesh
