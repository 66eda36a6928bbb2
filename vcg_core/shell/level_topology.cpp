// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Nodes join the solid in order of their clearance. Union-find counts the components on the way. The Euler
// characteristic gives the handles: it is components minus handles plus cavities.
#include "vcg_core/shell/level_topology.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "vcg_core/base/platform.h"
#include "vcg_core/shell/node_link.h"

namespace neuralmesh {
namespace {

/// The levels of a cube's corners; bits of the index: 1 = x, 2 = y, 4 = z.
using CubeLevels = std::array<SquaredRadius, 8>;

CubeLevels cube_levels(const Lattice& lattice, int x, int y, int z, const PerNode<SquaredRadius>& clearance,
                       SquaredRadius outside) {
    CubeLevels levels{};
    if (x + 1 < lattice.nx && y + 1 < lattice.ny && z + 1 < lattice.nz) {  // nearly all cubes
        const NodeId lines[4] = {lattice.index(x, y, z), lattice.index(x, y + 1, z),
                                 lattice.index(x, y, z + 1), lattice.index(x, y + 1, z + 1)};
        for (std::size_t k = 0; k < 4; ++k) {
            levels[2 * k] = clearance[lines[k]];
            levels[2 * k + 1] = clearance[lines[k] + 1];
        }
        return levels;
    }
    for (int k = 0; k < 8; ++k) {
        const int cx = x + (k & 1), cy = y + ((k >> 1) & 1), cz = z + (k >> 2);
        levels[static_cast<std::size_t>(k)] =
            lattice.contains(cx, cy, cz) ? clearance[lattice.index(cx, cy, cz)] : outside;
    }
    return levels;
}

/// Adds the signs of the simplices whose lowest corner is the cube's corner 0, each at the highest level of
/// its corners. They are the chains 0 < a < b < 7 of corner bits and all parts of a chain that contain 0.
void add_simplices(const CubeLevels& levels, PerLevel<int>& changes) {
    const auto level = [&](int corner) { return levels[static_cast<std::size_t>(corner)]; };
    ++changes[level(0)];
    for (int a = 1; a < 8; ++a) {
        const SquaredRadius edge = std::max(level(0), level(a));
        --changes[edge];
        for (int b = a + 1; b < 8; ++b) {
            if ((a & b) != a) continue;
            const SquaredRadius triangle = std::max(edge, level(b));
            ++changes[triangle];
            if (b != 7) --changes[std::max(triangle, level(7))];
        }
    }
}

/// For every level the change of the Euler characteristic when the solid grows to it; \p levels of them, and
/// one more entry for the nodes that belong to none.
PerLevel<int> euler_changes(const Lattice& lattice, const PerNode<SquaredRadius>& clearance, int levels) {
    PerLevel<int> changes(levels + 1, 0);
    const SquaredRadius outside = static_cast<SquaredRadius>(levels);
    for_each_node(lattice, [&](int x, int y, int z) {
        const CubeLevels corners = cube_levels(lattice, x, y, z, clearance, outside);
        // At one level the signs cancel out: 1 - 7 + 12 - 6.
        if (std::all_of(corners.begin(), corners.end(), [&](SquaredRadius l) { return l == corners[0]; }))
            return;
        add_simplices(corners, changes);
    });
    return changes;
}

/// The nodes of a solid as bits, 64 to a word, row by row along x. Beyond the lattice there is none.
class SolidBits {
public:
    using Word = std::uint64_t;
    static constexpr int kBits = 64;

    SolidBits(const Lattice& lattice, const NodeSet& solid)
        : rows_(lattice.ny),
          slices_(lattice.nz),
          words_(lattice.nx / kBits + 1),
          bits_((rows_ + 1) * (slices_ + 1) * (words_ + 1), 0) {
        for_each_node(lattice, [&](int x, int y, int z) {
            if (solid[lattice.index(x, y, z)] != 0)
                bits_[index(x / kBits, y, z)] |= Word{1} << static_cast<unsigned>(x % kBits);
        });
    }
    int words_per_row() const { return words_; }
    /// Corner by corner, those of the 64 cubes whose lowest corners are the nodes of word \p w of row (y, z).
    std::array<Word, 8> corners(int w, int y, int z) const {
        std::array<Word, 8> result{};
        for (int k = 0; k < 8; k += 2) {
            const int low = index(w, y + ((k >> 1) & 1), z + (k >> 2));
            result[static_cast<std::size_t>(k)] = bits_[low];
            result[static_cast<std::size_t>(k + 1)] = bits_[low] >> 1 | bits_[low + 1] << (kBits - 1);
        }
        return result;
    }

private:
    int index(int w, int y, int z) const { return (z * (rows_ + 1) + y) * (words_ + 1) + w; }

    int rows_, slices_, words_;
    Indexed<Word> bits_;  ///< with an empty word, row and slice at the ends
};

/// The signs of the simplices whose lowest corner is the corner 0 of their cube, for 64 cubes at once; see
/// add_simplices().
int sum_of_signs(const std::array<SolidBits::Word, 8>& corners) {
    const auto corner = [&](int k) { return corners[static_cast<std::size_t>(k)]; };
    int sum = bit_count(corner(0));
    for (int a = 1; a < 8; ++a) {
        const SolidBits::Word edges = corner(0) & corner(a);
        sum -= bit_count(edges);
        for (int b = a + 1; b < 8; ++b) {
            if ((a & b) != a) continue;
            const SolidBits::Word triangles = edges & corner(b);
            sum += bit_count(triangles);
            if (b != 7) sum -= bit_count(triangles & corner(7));
        }
    }
    return sum;
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
class DisjointSets {
public:
    explicit DisjointSets(const PerNode<std::uint32_t>& counts)
        : parent_(counts.size(), -1), points_(counts) {}

    bool contains(NodeId i) const { return parent_[i] >= 0; }
    void add(NodeId i) { parent_[i] = i; }
    long long points(NodeId root) const { return points_[root]; }
    NodeId find(NodeId i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    /// \return the root of the union of the sets with roots \p a and \p b
    NodeId join(NodeId a, NodeId b) {
        const auto [root, child] = std::minmax(a, b);
        parent_[child] = root;
        points_[root] += points_[child];
        return root;
    }

private:
    PerNode<NodeId> parent_;  ///< -1: not in any set
    PerNode<std::uint32_t> points_;
};

/// Components and specks of a solid that grows node by node.
class ComponentCount {
public:
    ComponentCount(const Lattice& lattice, const PerNode<std::uint32_t>& counts, long long min_points)
        : neighbours_(lattice), sets_(counts), min_points_(min_points) {}

    void add(NodeId i) {
        sets_.add(i);
        count(i, 1);
        const NeighbourSet beside =
            neighbours_in(neighbours_, i, [&](NodeId j) { return sets_.contains(j); });
        const bool in_one_set = link_connected_(beside);
        NodeId root = i;
        for (int k = 0; k < kNeighbourCount; ++k) {
            if ((beside >> k & 1U) == 0) continue;
            join(neighbours_.at(i, k), root);
            if (in_one_set) return;
        }
    }
    /// All but the genus.
    const LevelTopology& topology() const { return topology_; }

private:
    /// Joins the set of node \p j, if it is another, with that of \p root, which becomes the root of both.
    void join(NodeId j, NodeId& root) {
        const NodeId other = sets_.find(j);
        if (other == root) return;
        count(root, -1);
        count(other, -1);
        root = sets_.join(root, other);
        count(root, 1);
    }
    void count(NodeId root, int sign) {
        const long long points = sets_.points(root);
        (points >= min_points_ ? topology_.components : topology_.specks) += sign;
        if (points < min_points_) topology_.speck_points += sign * points;
    }

    Neighbours neighbours_;
    const LinkConnected& link_connected_ = LinkConnected::table();
    DisjointSets sets_;
    long long min_points_;
    LevelTopology topology_;
};

}  // namespace

PerLevel<LevelTopology> topology_of_levels(const Lattice& lattice, const PerNode<SquaredRadius>& clearance,
                                           const PerNode<std::uint32_t>& counts, int max_radius,
                                           long long min_points, const std::vector<NodeId>& hollows) {
    const int levels = max_radius * max_radius + 1;  // a clearance of this much is outside at every level
    const PerLevel<int> changes = euler_changes(lattice, clearance, levels);
    const NodesByLevel order = nodes_by_level(clearance, levels);
    ComponentCount components(lattice, counts, min_points);
    PerLevel<LevelTopology> result(levels);
    int euler = 0;
    for (int l = 0; l < levels; ++l) {
        for (int k = order.first[l]; k < order.first[l + 1]; ++k)
            components.add(order.nodes[static_cast<std::size_t>(k)]);
        euler += changes[l];
        result[l] = components.topology();
        for (const NodeId i : hollows) result[l].cavities += clearance[i] > l ? 1 : 0;
        result[l].genus = result[l].surfaces() + result[l].specks - euler;
    }
    return result;
}

int euler_characteristic(const Lattice& lattice, const NodeSet& solid) {
    const SolidBits bits(lattice, solid);
    int sum = 0;
    for (int z = 0; z < lattice.nz; ++z)
        for (int y = 0; y < lattice.ny; ++y)
            for (int w = 0; w < bits.words_per_row(); ++w) {
                const std::array<SolidBits::Word, 8> corners = bits.corners(w, y, z);
                if (corners[0] != 0) sum += sum_of_signs(corners);
            }
    return sum;
}

}  // namespace neuralmesh
