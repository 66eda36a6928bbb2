// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A node may join the solid if its neighbours in the solid are connected among themselves. Then it neither
// joins components nor closes a loop.
#include "vcg_core/shell/bridgeless_growth.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "vcg_core/base/parallel_for.h"
#include "vcg_core/shell/node_groups.h"
#include "vcg_core/shell/node_link.h"

namespace neuralmesh {
namespace {

constexpr int kRadiusFactor = 2;  // a handle has to persist over this range of radii
// The radius of level 0 is 0 and cannot be doubled. Its solid grows by the diagonal of a lattice square.
constexpr int kGrownLevelOfOccupied = 2;
/// Dense for small radii, where gaps between points and narrow handles appear and vanish.
constexpr std::array<int, 8> kGrownFromLevels = {0, 1, 2, 3, 4, 6, 9, 16};

constexpr std::uint8_t kInSolid = 1;

/// A solid to which nodes are added, and how that changes its Euler characteristic: by 1 - that of the part
/// of the node's link in the solid.
class GrowingSolid {
public:
    GrowingSolid(const Lattice& lattice, NodeSet& solid) : neighbours_(lattice), solid_(solid) {}

    /// Adds node \p i if its neighbours in the solid are connected, and calls visit(j) for the others.
    template <class Visit>
    void add_if_connected(NodeId i, const Visit& visit) {
        const NeighbourSet places = neighbours_.places(i), link = link_of(i, places);
        if (!topology_.is_connected(link)) return;
        add(i, link);
        neighbours_.for_each_at(i, places & ~link, [&](NodeId j, int) { visit(j); });
    }
    void add(NodeId i) { add(i, link_of(i, neighbours_.places(i))); }
    int euler_change() const { return euler_change_; }

private:
    NeighbourSet link_of(NodeId i, NeighbourSet places) const {
        return neighbours_in(neighbours_, i, places, [&](NodeId j) { return solid_[j] == kInSolid; });
    }
    void add(NodeId i, NeighbourSet link) {
        solid_[i] = kInSolid;
        euler_change_ += 1 - topology_.euler_characteristic(link);
    }

    const LinkTopology& topology_ = LinkTopology::table();
    Neighbours neighbours_;
    NodeSet& solid_;
    int euler_change_ = 0;
};

/// Adds the components of the nodes left out of \p solid that touch no node with clearance > level.
/// \p left_out holds all nodes of clearance <= level that were outside before growth.
void fill_cavities(const Lattice& lattice, const std::vector<NodeId>& left_out,
                   const PerNode<SquaredRadius>& clearance, int level, NodeSet& solid,
                   GrowingSolid& growing) {
    constexpr std::uint8_t kVisited = 2;  // in solid: visited, but not in it
    const Neighbours neighbours(lattice);
    std::vector<NodeId> component;
    for (const NodeId seed : left_out) {
        if (solid[seed] != 0) continue;
        bool open = false;
        solid[seed] = kVisited;
        const auto enter = [&](NodeId j) {
            open = open || clearance[j] > level;
            if (solid[j] != 0 || clearance[j] > level) return false;
            solid[j] = kVisited;
            return true;
        };
        flood(neighbours, seed, enter, component);
        for (const NodeId i : component) open = open || neighbours.places(i) != kAllNeighbours;
        if (open) continue;
        for (const NodeId i : component) growing.add(i);
    }
    for (const NodeId i : left_out) solid[i] = solid[i] == kInSolid ? kInSolid : 0;
}

/// A solid grown by grow_without_bridges().
struct Grown {
    NodeSet solid;
    int euler = 0;  ///< its Euler characteristic
};

Grown grown(const Region& region, int level) {
    const LevelTopology& plain = region.topologies[level];
    Grown result;
    if (plain.specks > 0) {
        result.solid = solid_of(region.lattice, region.clearance, region.counts, level, region.min_points);
        result.euler = euler_characteristic(region.lattice, result.solid);
    } else {  // the same, without a search for components
        result.solid.resize(region.clearance.size());
        for (NodeId i = 0; i < result.solid.size(); ++i)
            result.solid[i] = region.clearance[i] <= level ? kInSolid : 0;
        result.euler = plain.euler_characteristic();
    }
    result.euler += grow_without_bridges(region.lattice, region.clearance, grown_level(level), result.solid);
    return result;
}

}  // namespace

int grow_without_bridges(const Lattice& lattice, const PerNode<SquaredRadius>& clearance, int level,
                         NodeSet& solid) {
    Indexed<std::vector<NodeId>> waiting(level + 1);
    std::vector<NodeId> outside;
    for (NodeId i = 0; i < solid.size(); ++i)
        if (solid[i] == 0 && clearance[i] <= level) {
            waiting[clearance[i]].push_back(i);
            outside.push_back(i);
        }
    GrowingSolid growing(lattice, solid);
    for (int l = 0; l <= level; ++l) {
        std::vector<NodeId>& front = waiting[l];
        for (std::size_t k = 0; k < front.size(); ++k)
            if (solid[front[k]] == 0)
                growing.add_if_connected(front[k], [&](NodeId j) {
                    // It may have been left out, and be connected to the solid in another way now.
                    if (clearance[j] <= l) front.push_back(j);
                });
    }
    fill_cavities(lattice, outside, clearance, level, solid, growing);
    return growing.euler_change();
}

int grown_level(int level) {
    if (level == 0) return kGrownLevelOfOccupied;
    return std::min(Region::kMaxLevel, level * kRadiusFactor * kRadiusFactor);
}

NodeSet grown_solid(const Region& region, int level) { return grown(region, level).solid; }

std::vector<TopologyAt> grown_topologies(const Region& region, ThreadTeam& team) {
    std::vector<TopologyAt> result;
    for (const int level : kGrownFromLevels) {
        const LevelTopology& plain = region.topologies[level];
        if (is_fragmented(region, level) || (level == 0 && plain.specks > 0)) continue;
        result.push_back({level, plain.components + region.topologies[grown_level(level)].cavities, 0});
    }
    for_chunks(result.size(), 1, team, [&](std::size_t i, std::size_t, std::size_t) {
        result[i].genus = result[i].components - grown(region, result[i].level).euler;
    });
    return result;
}

}  // namespace neuralmesh
