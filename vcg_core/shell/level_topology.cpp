// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Nodes join the solid in order of their clearance. Their lower links tell how that changes components and
// the Euler characteristic, which gives the handles: it is components minus handles plus cavities.
#include "vcg_core/shell/level_topology.h"

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "vcg_core/base/platform.h"
#include "vcg_core/shell/node_link.h"

namespace neuralmesh {
namespace {

/// For every level the change of the Euler characteristic when the solid grows to it; \p levels of them.
PerLevel<int> euler_changes(const PerNode<SquaredRadius>& clearance, const PerNode<std::uint16_t>& links,
                            int levels) {
    const LinkTopology& topology = LinkTopology::table();
    PerLevel<int> changes(levels, 0);
    for (NodeId i = 0; i < clearance.size(); ++i)
        if (clearance[i] < levels) changes[clearance[i]] += 1 - topology.euler_characteristic(links[i]);
    return changes;
}

/// The nodes of all levels, those of level l from first[l] to first[l + 1] in rising order.
struct NodesByLevel {
    std::vector<NodeId> nodes;
    PerLevel<int> first;
};

/// A counting sort of the nodes with clearance < levels.
NodesByLevel nodes_by_level(const PerNode<SquaredRadius>& clearance, int levels) {
    NodesByLevel result{{}, PerLevel<int>(levels + 2, 0)};
    for (const SquaredRadius c : clearance) ++result.first[c + 1];
    std::partial_sum(result.first.begin(), result.first.end(), result.first.begin());
    Indexed<NodeId> nodes(result.first[levels]);
    PerLevel<int> place = result.first;
    for (NodeId i = 0; i < clearance.size(); ++i)
        if (clearance[i] < levels) nodes[place[clearance[i]]++] = i;
    result.nodes = std::move(nodes.vector());
    return result;
}

/// Disjoint sets of nodes by union-find, with the number of points in each.
class CountedSets {
public:
    /// Each node is a set of its own.
    explicit CountedSets(const PerNode<std::uint32_t>& counts) : parent_(counts.size()), points_(counts) {
        std::iota(parent_.begin(), parent_.end(), 0);
    }

    long long points(NodeId root) const { return points_[root]; }
    NodeId find(NodeId i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    /// Unites the sets with roots \p a and \p b. \p a is the root of the union.
    void join(NodeId a, NodeId b) {
        parent_[b] = a;
        points_[a] += points_[b];
    }

private:
    PerNode<NodeId> parent_;
    PerNode<std::uint32_t> points_;
};

/// Components and specks of a solid that grows node by node.
class ComponentCount {
public:
    ComponentCount(const Lattice& lattice, const PerNode<std::uint32_t>& counts, long long min_points)
        : neighbours_(lattice), sets_(counts), min_points_(min_points) {}

    /// \param link the neighbours of node \p i in the solid
    void add(NodeId i, NeighbourSet link) {
        count(i, 1);
        if (link == 0) return;
        const NodeId root = sets_.find(neighbours_.at(i, lowest_bit(link)));
        join(i, root);
        if (link_topology_.is_connected(link)) return;  // all in one set
        for (link &= link - 1; link != 0; link &= link - 1)
            join(sets_.find(neighbours_.at(i, lowest_bit(link))), root);
    }
    /// All but the genus.
    const LevelTopology& topology() const { return topology_; }

private:
    /// Unites two sets, if they are two. \p root becomes the root of both.
    void join(NodeId other, NodeId root) {
        if (other == root) return;
        count(root, -1);
        count(other, -1);
        sets_.join(root, other);
        count(root, 1);
    }
    void count(NodeId root, int sign) {
        const long long points = sets_.points(root);
        (points >= min_points_ ? topology_.components : topology_.specks) += sign;
        if (points < min_points_) topology_.speck_points += sign * points;
    }

    Neighbours neighbours_;
    const LinkTopology& link_topology_ = LinkTopology::table();
    CountedSets sets_;
    long long min_points_;
    LevelTopology topology_;
};

}  // namespace

PerLevel<LevelTopology> topology_of_levels(const Lattice& lattice, const PerNode<SquaredRadius>& clearance,
                                           const PerNode<std::uint32_t>& counts, int max_radius,
                                           long long min_points, const std::vector<NodeId>& hollows) {
    const int levels = max_radius * max_radius + 1;  // a clearance of this much is outside at every level
    const PerNode<std::uint16_t> links = lower_links(lattice, clearance);
    const PerLevel<int> changes = euler_changes(clearance, links, levels);
    const NodesByLevel order = nodes_by_level(clearance, levels);
    ComponentCount components(lattice, counts, min_points);
    PerLevel<LevelTopology> result(levels);
    int euler = 0;
    for (int l = 0; l < levels; ++l) {
        for (int k = order.first[l]; k < order.first[l + 1]; ++k) {
            const NodeId i = order.nodes[static_cast<std::size_t>(k)];
            components.add(i, links[i]);
        }
        euler += changes[l];
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
