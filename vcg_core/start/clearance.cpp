// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Distances: a separable transform, one axis after the other (Saito and Toriwaki 1994). Clearances: a flood
// that takes the levels from the highest to the lowest.
#include "vcg_core/start/clearance.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace neuralmesh {
namespace {

SquaredRadius beyond(int max_radius) { return static_cast<SquaredRadius>(max_radius * max_radius + 1); }

/// Squared distances along x, by two sweeps per row.
void distances_along_rows(const Lattice& lattice, const PerNode<std::uint32_t>& occupied, int max_radius,
                          PerNode<SquaredRadius>& out) {
    const int far = max_radius + 1;
    for (NodeId row = 0; row < lattice.size(); row += lattice.nx) {
        int d = far;
        for (NodeId i = row; i < row + lattice.nx; ++i) {
            d = occupied[i] != 0 ? 0 : std::min(d + 1, far);
            out[i] = static_cast<SquaredRadius>(d);
        }
        d = far;
        for (NodeId i = row + lattice.nx; i-- > row;) {
            d = occupied[i] != 0 ? 0 : std::min(d + 1, far);
            const int best = std::min<int>(d, out[i]);
            out[i] = best > max_radius ? beyond(max_radius) : static_cast<SquaredRadius>(best * best);
        }
    }
}

}  // namespace

PerNode<SquaredRadius> squared_distances(const Lattice& lattice, const PerNode<std::uint32_t>& occupied,
                                         int max_radius) {
    PerNode<SquaredRadius> out(lattice.size());
    distances_along_rows(lattice, occupied, max_radius, out);
    const auto nearer = [](SquaredRadius here, SquaredRadius there, int rows) {
        const SquaredRadius sum = static_cast<SquaredRadius>(there + rows * rows);
        return sum < here ? sum : here;
    };
    combine_across_rows(lattice, max_radius, nearer, out);
    for (SquaredRadius& d : out) d = std::min(d, beyond(max_radius));
    return out;
}

PerNode<SquaredRadius> clearances(const Lattice& lattice, const PerNode<SquaredRadius>& distances,
                                  int max_radius, const NodeSet& inside, const std::vector<NodeId>& hollows) {
    const int far = beyond(max_radius);
    constexpr SquaredRadius kUnknown = -1, kInside = 0;
    PerNode<SquaredRadius> out(lattice.size(), kUnknown);
    // First in, first out on every level, so that inside and outside meet halfway.
    Indexed<std::vector<NodeId>> waiting(far + 1);
    const auto wait = [&](NodeId i, int level, bool in) {
        const int l = std::min<int>(level, distances[i]);
        out[i] = in ? kInside : static_cast<SquaredRadius>(l);
        waiting[l].push_back(i);
    };
    for (NodeId i = 0; i < inside.size(); ++i)
        if (inside[i] != 0) wait(i, far, true);
    for (const NodeId i : hollows) wait(i, far, false);
    for_each_node(lattice, [&](int x, int y, int z) {
        const NodeId i = lattice.index(x, y, z);
        if (lattice.is_on_side(x, y, z) && out[i] == kUnknown) wait(i, far, false);
    });
    const Neighbours neighbours(lattice);
    for (int level = far; level > 0; --level) {
        std::vector<NodeId>& front = waiting[level];
        for (std::size_t k = 0; k < front.size(); ++k) {
            const bool in = out[front[k]] == kInside;
            neighbours.for_each(front[k], [&](NodeId j, int) {
                if (out[j] == kUnknown) wait(j, level, in);
            });
        }
        std::vector<NodeId>().swap(front);
    }
    for (SquaredRadius& c : out) c = std::max(c, kInside);  // unknown: occupied nodes all around
    return out;
}

SealedSpaces enclosed_spaces(const Lattice& lattice, const PerNode<SquaredRadius>& distances,
                             const PerNode<SquaredRadius>& clearance, double width_ratio,
                             int min_squared_depth) {
    SealedSpaces result;
    result.inside.assign(lattice.size(), 0);
    const auto hidden = [&](NodeId i) { return distances[i] > clearance[i]; };
    for_each_component(lattice, hidden, [&](const std::vector<NodeId>& space) {
        int depth = 0;
        for (const NodeId i : space) depth = std::max<int>(depth, distances[i]);
        const int opening = clearance[space.front()];  // the same for all nodes of the space
        if (depth < min_squared_depth || depth < width_ratio * width_ratio * std::max(1, opening)) return;
        for (const NodeId i : space) result.inside[i] = 1;
        result.nodes += static_cast<long long>(space.size());
        result.widest_opening = std::max(result.widest_opening, opening);
    });
    return result;
}

Solid solid_of(const Lattice& lattice, const PerNode<SquaredRadius>& clearance,
               const PerNode<std::uint32_t>& counts, int level, long long min_points) {
    Solid result{NodeSet(lattice.size(), 0)};
    const auto solid = [&](NodeId i) { return clearance[i] <= level; };
    for_each_component(lattice, solid, [&](const std::vector<NodeId>& component) {
        long long points = 0;
        for (const NodeId i : component) points += counts[i];
        if (points < min_points) {
            result.points_in_specks += points;
            return;
        }
        ++result.components;
        for (const NodeId i : component) result.nodes[i] = 1;
    });
    return result;
}

}  // namespace neuralmesh
