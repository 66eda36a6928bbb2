// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The occupied cells of a uniform grid as a 64-ary tree, for nearest-neighbour searches that start far from
// every occupied cell.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <vector>

#include "vcg_core/base/simd.h"

namespace neuralmesh {

/// Levels of cells, each four times coarser per axis than the one below. A node stores the number of entries
/// in its cell and which of its 64 children are occupied. The finest level, 0, has no nodes: of its cells
/// only the occupied blocks of 4 x 4 x 4 are known.
class CellPyramid {
public:
    CellPyramid() : CellPyramid(1) {}
    /// For cells with coordinates from 0 to \p across - 1 (up to 2^20).
    explicit CellPyramid(std::int32_t across);

    bool holds(FourInts cell) const {
        return std::min({cell[0], cell[1], cell[2]}) >= 0 && std::max({cell[0], cell[1], cell[2]}) < across_;
    }
    /// Adds or removes one entry in \p cell. O(levels).
    void add(FourInts cell) { count(cell, 1); }
    void remove(FourInts cell) { count(cell, -1); }
    /// Moves one entry. O(1) expected for neighbouring cells.
    void move(FourInts from, FourInts to);

    /// Branch and bound: calls \p visit(x, y, z) for cells of occupied blocks, near blocks first, that are
    /// nearer to \p s than the bound. \p visit returns the new bound. Units: \p s and \p slack in cells, the
    /// bound in squared cells. Each cell is enlarged by \p slack on every side to allow for rounding.
    /// O(levels) expected if the cells lie on a surface.
    template <class Visit>
    void nearest(const std::array<float, 3>& s, float slack, const Visit& visit) const {
        float bound = std::numeric_limits<float>::infinity();
        if (!nodes_.back().empty()) descend(s, slack, {0, 0, 0}, nodes_.size(), bound, visit);
    }

    std::size_t bytes() const;

private:
    using Cell = std::array<std::int32_t, 3>;
    struct Node {
        std::uint64_t children = 0;  ///< bit x + 4 y + 16 z
        std::int32_t count = 0;
    };
    struct Child {
        float squared_distance;
        Cell cell;
    };

    /// Squared distances along x, y and z to the four slices of a cell's children.
    using Slices = std::array<std::array<float, 4>, 3>;

    static std::uint64_t key_of(const Cell& cell) {
        return static_cast<std::uint64_t>(cell[0]) | static_cast<std::uint64_t>(cell[1]) << 21 |
               static_cast<std::uint64_t>(cell[2]) << 42;
    }
    static Cell coarser(FourInts cell, std::size_t level) {
        return {cell[0] >> (2 * level), cell[1] >> (2 * level), cell[2] >> (2 * level)};
    }
    static Slices slices(const std::array<float, 3>& s, float slack, const Cell& cell, std::size_t level);
    static float squared_distance(const Slices& squared, int child) {
        const auto i = static_cast<std::size_t>(child);
        return squared[0][i & 3] + squared[1][i >> 2 & 3] + squared[2][i >> 4];
    }
    static Cell child_of(const Cell& cell, int child) {
        return {4 * cell[0] + (child & 3), 4 * cell[1] + (child >> 2 & 3), 4 * cell[2] + (child >> 4)};
    }
    std::unordered_map<std::uint64_t, Node>& nodes(std::size_t level) { return nodes_[level - 1]; }
    const std::unordered_map<std::uint64_t, Node>& nodes(std::size_t level) const {
        return nodes_[level - 1];
    }
    void count(FourInts cell, int by);
    void count(FourInts cell, std::size_t level, int by);
    int near_children(const Slices& squared, const Cell& cell, std::size_t level, float bound,
                      std::array<Child, 64>& found) const;

    template <class Visit>
    void descend(const std::array<float, 3>& s, float slack, const Cell& cell, std::size_t level,
                 float& bound, const Visit& visit) const {
        const Slices squared = slices(s, slack, cell, level);
        if (level == 1) {
            // Visiting a cell is cheaper than sorting the cells.
            for (int i = 0; i < 64; ++i) {
                if (squared_distance(squared, i) >= bound) continue;
                const Cell at = child_of(cell, i);
                bound = std::min(bound, visit(at[0], at[1], at[2]));
            }
            return;
        }
        std::array<Child, 64> found;
        const auto end = found.begin() + near_children(squared, cell, level, bound, found);
        for (auto c = found.begin(); c != end && c->squared_distance < bound; ++c)
            descend(s, slack, c->cell, level - 1, bound, visit);
    }

    std::int32_t across_;
    std::vector<std::unordered_map<std::uint64_t, Node>> nodes_;  ///< level 1 first, the root last
};

}  // namespace neuralmesh
