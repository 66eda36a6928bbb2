// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Nodes join the solid in order of their clearance. The neighbours of each that have joined before, its lower
// link, tell how that changes components and the Euler characteristic, by 1 - that of the link (Banchoff
// 1967). It gives the handles: it is components minus handles plus cavities.
#include "vcg_core/shell/level_topology.h"

#include <cstddef>
#include <cstdint>
#include <vector>

#include "vcg_core/base/disjoint_sets.h"
#include "vcg_core/base/platform.h"
#include "vcg_core/shell/node_link.h"

namespace neuralmesh {
namespace {

/// Components and specks of a solid that grows node by node.
class ComponentCount {
public:
    ComponentCount(const Lattice& lattice, const PerNode<std::uint32_t>& counts, long long min_points)
        : neighbours_(lattice), sets_(counts.size()), points_(counts), min_points_(min_points) {}

    /// \param link the neighbours of node \p i in the solid
    void add(NodeId i, NeighbourSet link) {
        count(i, 1);
        if (link == 0) return;
        join(i, neighbours_.at(i, lowest_bit(link)));
        if (link_topology_.is_connected(link)) return;  // all in one set
        for (link &= link - 1; link != 0; link &= link - 1) join(i, neighbours_.at(i, lowest_bit(link)));
    }
    /// All but the genus.
    const LevelTopology& topology() const { return topology_; }

private:
    void join(NodeId a, NodeId b) {
        a = sets_.find(a);
        b = sets_.find(b);
        if (!sets_.join(a, b)) return;
        count(a, -1);
        count(b, -1);
        points_[sets_.find(a)] = points_[a] + points_[b];
        count(sets_.find(a), 1);
    }
    void count(NodeId root, int sign) {
        const long long points = points_[root];
        (points >= min_points_ ? topology_.components : topology_.specks) += sign;
        if (points < min_points_) topology_.speck_points += sign * points;
    }

    Neighbours neighbours_;
    const LinkTopology& link_topology_ = LinkTopology::table();
    DisjointSets sets_;
    PerNode<std::uint32_t> points_;  ///< by root
    long long min_points_;
    LevelTopology topology_;
};

}  // namespace

PerLevel<LevelTopology> topology_of_levels(const Lattice& lattice, const PerNode<SquaredRadius>& clearance,
                                           const PerNode<std::uint32_t>& counts, int max_radius,
                                           long long min_points, const std::vector<NodeId>& hollows) {
    const int levels = max_radius * max_radius + 1;  // a clearance of this much is outside at every level
    PerLevel<std::vector<NodeId>> nodes(levels);
    for (NodeId i = 0; i < clearance.size(); ++i)
        if (clearance[i] < levels) nodes[clearance[i]].push_back(i);
    const Neighbours neighbours(lattice);
    const LinkTopology& links = LinkTopology::table();
    ComponentCount components(lattice, counts, min_points);
    PerLevel<LevelTopology> result(levels);
    int euler = 0;
    for (int l = 0; l < levels; ++l) {
        for (const NodeId i : nodes[l]) {
            const NeighbourSet link = neighbours_in(neighbours, i, neighbours.places(i), [&](NodeId j) {
                return clearance[j] < l || (clearance[j] == l && j < i);
            });
            components.add(i, link);
            euler += 1 - links.euler_characteristic(link);
        }
        result[l] = components.topology();
        for (const NodeId i : hollows) result[l].cavities += clearance[i] > l ? 1 : 0;
        result[l].genus = result[l].surfaces() + result[l].specks - euler;
    }
    return result;
}

int euler_characteristic(const Lattice& lattice, const NodeSet& solid) {
    const LinkTopology& topology = LinkTopology::table();
    const Neighbours neighbours(lattice);
    const auto in_solid = [&](NodeId i) { return solid[i] != 0; };
    int sum = 0;
    for (NodeId i = 0; i < solid.size(); ++i) {
        if (!in_solid(i)) continue;
        const NeighbourSet before = neighbours.places(i) & kSmallerIds;
        sum += 1 - topology.euler_characteristic(neighbours_in(neighbours, i, before, in_solid));
    }
    return sum;
}

}  // namespace neuralmesh
