// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The region a cloud encloses, on a lattice, for all ball sizes at once: which nodes can a ball of
// a given radius reach from outside without touching a point, and what is the topology of the rest?
//
// Everything is integer arithmetic on squared distances in lattice steps: exact, and the same everywhere.
#pragma once

#include <vcg/space/box3.h>
#include <vcg/space/point3.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace neuralmesh {

/// Squared distance in lattice steps.
using SquaredRadius = std::int16_t;

/// A box of nodes, \p step apart; node (x, y, z) has the index (z * ny + y) * nx + x.
/// Two nodes are adjacent if they share an edge of the Freudenthal subdivision (Kuhn's six tetrahedra per
/// cube, 14 neighbours per node). On it foreground and background have the same connectivity, so marching
/// tetrahedra mesh exactly the topology that is counted.
struct Lattice {
    int nx = 0, ny = 0, nz = 0;
    float step = 1;
    vcg::Point3f origin{0, 0, 0};  ///< position of node (0, 0, 0)

    /// The nodes that cover \p box with \p margin further ones on each side.
    Lattice(const vcg::Box3f& box, float node_step, int margin);

    std::size_t size() const {
        return static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny) * static_cast<std::size_t>(nz);
    }
    std::size_t index(int x, int y, int z) const {
        return (static_cast<std::size_t>(z) * static_cast<std::size_t>(ny) + static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(nx) +
               static_cast<std::size_t>(x);
    }
    /// The node nearest to \p p, or size() if p is outside the box.
    std::size_t node_of(const vcg::Point3f& p) const;
    vcg::Point3f position(int x, int y, int z) const {
        return origin +
               vcg::Point3f(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)) * step;
    }
};

/// The seven neighbours ahead of a node on the Freudenthal lattice; their opposites are the other seven.
inline constexpr std::array<std::array<int, 3>, 7> kNeighboursAhead = {
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}}};

/// Is the node at (dx, dy, dz) from (x, y, z) in the box?
inline bool in_box(const Lattice& l, int x, int y, int z, int dx, int dy, int dz) {
    return x + dx >= 0 && x + dx < l.nx && y + dy >= 0 && y + dy < l.ny && z + dz >= 0 && z + dz < l.nz;
}

/// Calls visit(j) for the neighbours j of node i, in a fixed order.
template <class Visit>
void for_each_neighbour(const Lattice& l, std::size_t i, const Visit& visit) {
    const std::uint32_t nx = static_cast<std::uint32_t>(l.nx), ny = static_cast<std::uint32_t>(l.ny);
    const std::uint32_t row = static_cast<std::uint32_t>(i) / nx;
    const int x = static_cast<int>(static_cast<std::uint32_t>(i) - row * nx);
    const int y = static_cast<int>(row % ny), z = static_cast<int>(row / ny);
    for (const auto& [dx, dy, dz] : kNeighboursAhead) {
        const std::size_t step = l.index(dx, dy, dz);
        if (in_box(l, x, y, z, dx, dy, dz)) visit(i + step);
        if (in_box(l, x, y, z, -dx, -dy, -dz)) visit(i - step);
    }
}

/// Squared distance of every node to the nearest node with occupied != 0; beyond \p reach steps it is
/// reach^2 + 1 ("far"). Exact. O(nodes x reach), in SIMD.
std::vector<SquaredRadius> squared_distances(const Lattice& lattice,
                                             const std::vector<std::uint32_t>& occupied, int reach);

/// For every node the level up to which balls get there: the largest over all paths from outside the box
/// of the smallest squared distance on the path. A ball of squared radius l, from outside, reaches the nodes
/// with clearance > l; the others, clearance <= l, are the solid at level l. It has no cavities.
/// Nodes with \p inside != 0 (empty: none) are solid at every level, and grow against the outside as in a
/// watershed transform (Vincent and Soille 1991): what they get to first is solid, too. O(nodes).
std::vector<SquaredRadius> clearances(const Lattice& lattice, const std::vector<SquaredRadius>& distances,
                                      int reach, const std::vector<std::uint8_t>& inside);

/// What sealing found.
struct SealedSpaces {
    std::vector<std::uint8_t> inside;  ///< 1: inside of a sealed space
    long long nodes = 0;               ///< their number
    int widest_opening = 0;            ///< largest squared radius of a hole that had to be closed
};

/// Spaces that are wide compared with the way in: connected nodes farther from the points than any ball that
/// gets there from outside, where the largest inscribed radius is at least \p width_ratio times the radius of
/// the way in, and its square at least \p least_depth. Such a space is the inside of a solid whose surface
/// has gaps between its points, or of a scan with holes. O(nodes).
SealedSpaces enclosed_spaces(const Lattice& lattice, const std::vector<SquaredRadius>& distances,
                             const std::vector<SquaredRadius>& clearance, double width_ratio,
                             int least_depth);

/// Topology of the solid at one level.
struct LevelTopology {
    int components = 0;          ///< those that hold enough points
    int specks = 0;              ///< the others
    long long speck_points = 0;  ///< points in them
    int genus = 0;               ///< handles, all components together
};

/// The solid's topology at every level from 0 to reach^2. A component counts if it holds at least
/// \p enough points, where counts[i] points lie at node i. O(nodes).
std::vector<LevelTopology> topology_of_levels(const Lattice& lattice,
                                              const std::vector<SquaredRadius>& clearance,
                                              const std::vector<std::uint32_t>& counts, int reach,
                                              long long enough);

/// Of the subcomplex that the nodes with solid != 0 span: components - handles + cavities. O(nodes).
int euler_characteristic(const Lattice& lattice, const std::vector<std::uint8_t>& solid);

}  // namespace neuralmesh
