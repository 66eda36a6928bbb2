// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Which cells of a uniform grid hold something, in levels each four times coarser than the one below, so that
// whoever is far from everything need not look at all the empty cells between.
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

/// Counts what lies in the cells of every level from the first coarser one on, and knows of every cell which
/// of its 64 children are inhabited. Of the finest level it knows blocks of 4 x 4 x 4 cells only.
class CellPyramid {
public:
    CellPyramid() : CellPyramid(1) {}
    /// For cells with coordinates from 0 to \p across - 1 (up to 2^20).
    explicit CellPyramid(std::int32_t across);

    bool holds(FourInts cell) const {
        return std::min({cell[0], cell[1], cell[2]}) >= 0 && std::max({cell[0], cell[1], cell[2]}) < across_;
    }
    /// One more, one less in \p cell. O(levels).
    void add(FourInts cell) { count(cell, 1); }
    void remove(FourInts cell) { count(cell, -1); }
    /// O(1) expected.
    void move(FourInts from, FourInts to);

    /// Calls \p visit(x, y, z) for cells of inhabited blocks, near blocks first, whose distance from \p s,
    /// squared, in cells and given as if every cell were \p slack larger, is below the least bound that
    /// visit() has returned. O(levels) expected where cells lie on a surface.
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
            // To look into a cell is cheaper than to put the cells in order.
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
    std::vector<std::unordered_map<std::uint64_t, Node>> nodes_;  ///< from level 1 to that of the one root
};

}  // namespace neuralmesh
