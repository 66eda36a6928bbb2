// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A regular lattice of nodes over a box: indices, adjacency and flood fill.
#pragma once

#include <vcg/space/box3.h>
#include <vcg/space/point3.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "vcg_core/base/indexed.h"
#include "vcg_core/base/platform.h"

namespace neuralmesh {

using NodeId = std::int32_t;
/// One value for every node of a lattice.
template <class T>
using PerNode = Indexed<T>;
/// 1 for the members, 0 for the other nodes.
using NodeSet = PerNode<std::uint8_t>;

/// Nodes at equal distances along three axes; node (x, y, z) has the id (z * ny + y) * nx + x. At most 2^31 -
/// 1 nodes.
struct Lattice {
    int nx = 0, ny = 0, nz = 0;
    float step = 1;                ///< distance between nodes
    vcg::Point3f corner{0, 0, 0};  ///< position of node (0, 0, 0)

    /// Covers \p box and \p margin further nodes on each side, centred on the box.
    Lattice(const vcg::Box3f& box, float node_step, int margin);

    NodeId size() const { return nx * ny * nz; }
    NodeId index(int x, int y, int z) const { return (z * ny + y) * nx + x; }
    /// The inverse of index().
    std::array<int, 3> coordinates(NodeId i) const {
        // Unsigned division is the faster one, and this is called for every node and neighbour.
        const auto width = static_cast<std::uint32_t>(nx), height = static_cast<std::uint32_t>(ny);
        const auto node = static_cast<std::uint32_t>(i), row = node / width;
        return {static_cast<int>(node - row * width), static_cast<int>(row % height),
                static_cast<int>(row / height)};
    }
    bool contains(int x, int y, int z) const {
        return x >= 0 && x < nx && y >= 0 && y < ny && z >= 0 && z < nz;
    }
    /// Whether a node is on a side of the box, and so has fewer neighbours than others.
    bool is_on_side(int x, int y, int z) const {
        return x == 0 || y == 0 || z == 0 || x + 1 == nx || y + 1 == ny || z + 1 == nz;
    }
    vcg::Point3f position(int x, int y, int z) const {
        return corner +
               vcg::Point3f(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)) * step;
    }
    vcg::Point3f position(NodeId i) const {
        const auto [x, y, z] = coordinates(i);
        return position(x, y, z);
    }
    /// The node nearest to \p p, or size() if no node is within half a step along each axis.
    NodeId node_of(const vcg::Point3f& p) const;
};

float longest_side(const vcg::Box3f& box);

/// Nodes are adjacent if an edge of the Freudenthal subdivision joins them (Kuhn's six tetrahedra per cube).
/// On it foreground and background have the same connectivity, so that marching tetrahedra give a mesh of
/// exactly the topology counted on the nodes.
inline constexpr int kNeighbourCount = 14;
using NodeOffset = std::array<int, 3>;
/// Along the edges of the cube, the diagonals of its faces and its own diagonal, in both directions.
inline constexpr std::array<NodeOffset, kNeighbourCount> kNeighbourOffsets = {
    NodeOffset{1, 0, 0}, {-1, 0, 0}, {0, 1, 0},   {0, -1, 0}, {0, 0, 1},   {0, 0, -1}, {1, 1, 0},
    {-1, -1, 0},         {1, 0, 1},  {-1, 0, -1}, {0, 1, 1},  {0, -1, -1}, {1, 1, 1},  {-1, -1, -1}};

/// Some of the neighbours of a node, as bits in the order of kNeighbourOffsets.
using NeighbourSet = std::uint32_t;
inline constexpr NeighbourSet kAllNeighbours = (NeighbourSet{1} << kNeighbourCount) - 1;

/// Some of the neighbours of a node.
struct NodeList {
    std::array<NodeId, kNeighbourCount> nodes{};
    std::size_t size = 0;  ///< what is behind counts for nothing

    const NodeId* begin() const { return nodes.data(); }
    const NodeId* end() const { return nodes.data() + size; }
};

/// The neighbours of nodes. For loops over many nodes: the differences of the ids are computed once.
class Neighbours {
public:
    explicit Neighbours(const Lattice& lattice) : lattice_(lattice) {
        for (std::size_t k = 0; k < kNeighbourCount; ++k) {
            const auto& [dx, dy, dz] = kNeighbourOffsets[k];
            differences_[k] = lattice.index(dx, dy, dz);
        }
    }
    /// The neighbour of node \p i at the place \p k in kNeighbourOffsets, if it has one.
    NodeId at(NodeId i, int k) const { return i + differences_[static_cast<std::size_t>(k)]; }
    /// The places in kNeighbourOffsets at which node \p i has a neighbour: all, but for nodes on a side.
    NeighbourSet places(NodeId i) const {
        const Lattice& l = lattice_;
        const auto [x, y, z] = l.coordinates(i);
        if (!l.is_on_side(x, y, z)) return kAllNeighbours;
        NeighbourSet set = 0;
        for (int k = 0; k < kNeighbourCount; ++k) {
            const auto& [dx, dy, dz] = kNeighbourOffsets[static_cast<std::size_t>(k)];
            if (l.contains(x + dx, y + dy, z + dz)) set |= NeighbourSet{1} << k;
        }
        return set;
    }
    /// Calls visit(j, k) for the neighbours j of node \p i at the places k of \p places.
    template <class Visit>
    void for_each_at(NodeId i, NeighbourSet places, const Visit& visit) const {
        if (places == kAllNeighbours) {
            for (int k = 0; k < kNeighbourCount; ++k) visit(at(i, k), k);
        } else {
            for (; places != 0; places &= places - 1) {
                const int k = lowest_bit(places);
                visit(at(i, k), k);
            }
        }
    }
    /// Calls visit(j, k) for the neighbours j of node \p i, where k is j's place in kNeighbourOffsets.
    template <class Visit>
    void for_each(NodeId i, const Visit& visit) const {
        for_each_at(i, places(i), visit);
    }
    /// The neighbours j of node \p i with member(j), in the order of kNeighbourOffsets. Without a branch for
    /// each, which would be hard to predict.
    template <class Member>
    NodeList of(NodeId i, const Member& member) const {
        NodeList result;
        for_each(i, [&](NodeId j, int) {
            result.nodes[result.size] = j;
            result.size += member(j) ? 1 : 0;
        });
        return result;
    }

private:
    Lattice lattice_;  // a copy, so that the compiler need not reload its numbers after each store of an id
    std::array<NodeId, kNeighbourCount> differences_{};
};

/// Calls visit(x, y, z) for all nodes in the order of their ids.
template <class Visit>
void for_each_node(const Lattice& l, const Visit& visit) {
    for (int z = 0; z < l.nz; ++z)
        for (int y = 0; y < l.ny; ++y)
            for (int x = 0; x < l.nx; ++x) visit(x, y, z);
}

/// Flood fill: puts \p seed into \p nodes and then, breadth first, each neighbour j of a node in it for which
/// enter(j) is true. enter() must be true at most once per node, so it marks the nodes it lets in.
template <class Enter>
void flood(const Neighbours& neighbours, NodeId seed, const Enter& enter, std::vector<NodeId>& nodes) {
    nodes.assign(1, seed);
    for (std::size_t k = 0; k < nodes.size(); ++k)
        neighbours.for_each(nodes[k], [&](NodeId j, int) {
            if (enter(j)) nodes.push_back(j);
        });
}

/// Calls visit(nodes) for each connected component of the nodes i with member(i), in order of their smallest
/// nodes. O(nodes), and one byte per node.
template <class Member, class Visit>
void for_each_component(const Lattice& lattice, const Member& member, const Visit& visit) {
    NodeSet seen(lattice.size(), 0);
    const auto enter = [&](NodeId i) {
        if (seen[i] != 0 || !member(i)) return false;
        seen[i] = 1;
        return true;
    };
    const Neighbours neighbours(lattice);
    std::vector<NodeId> nodes;
    for (NodeId seed = 0; seed < lattice.size(); ++seed) {
        if (!enter(seed)) continue;
        flood(neighbours, seed, enter, nodes);
        visit(nodes);
    }
}

}  // namespace neuralmesh
