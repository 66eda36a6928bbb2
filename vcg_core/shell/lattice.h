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

/// Calls visit(j, k) for the neighbours j of node \p i, where k is j's place in kNeighbourOffsets.
template <class Visit>
void for_each_neighbour_offset(const Lattice& l, NodeId i, const Visit& visit) {
    const auto [x, y, z] = l.coordinates(i);
    const auto visit_if = [&](const auto& is_inside) {
        for (int k = 0; k < kNeighbourCount; ++k) {
            const auto& [dx, dy, dz] = kNeighbourOffsets[static_cast<std::size_t>(k)];
            if (is_inside(x + dx, y + dy, z + dz)) visit(i + l.index(dx, dy, dz), k);
        }
    };
    const bool on_side = x == 0 || y == 0 || z == 0 || x + 1 == l.nx || y + 1 == l.ny || z + 1 == l.nz;
    if (on_side) {
        visit_if([&l](int u, int v, int w) { return l.contains(u, v, w); });
    } else {
        visit_if([](int, int, int) { return true; });
    }
}

/// Calls visit(j) for the neighbours j of node \p i, in a fixed order.
template <class Visit>
void for_each_neighbour(const Lattice& l, NodeId i, const Visit& visit) {
    for_each_neighbour_offset(l, i, [&](NodeId j, int) { visit(j); });
}

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
void flood(const Lattice& lattice, NodeId seed, const Enter& enter, std::vector<NodeId>& nodes) {
    nodes.assign(1, seed);
    for (std::size_t k = 0; k < nodes.size(); ++k)
        for_each_neighbour(lattice, nodes[k], [&](NodeId j) {
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
    std::vector<NodeId> nodes;
    for (NodeId seed = 0; seed < lattice.size(); ++seed) {
        if (!enter(seed)) continue;
        flood(lattice, seed, enter, nodes);
        visit(nodes);
    }
}

}  // namespace neuralmesh
