// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Which cells of a uniform grid hold something, in levels each four times coarser than the one below, so that
// whoever is far from everything need not look at all the empty cells between.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "lanes.h"

namespace neuralmesh {

/// Counts per cell and level, found by hashing without keys: cells that share a counter make each other look
/// inhabited, which costs a visit in vain and no more.
class CellPyramid {
public:
    CellPyramid() = default;
    /// For about \p inhabited cells with coordinates from 0 to \p across - 1 (up to 2^20).
    CellPyramid(std::size_t inhabited, std::int32_t across);

    bool holds(FourInts cell) const {
        return std::min({cell[0], cell[1], cell[2]}) >= 0 && std::max({cell[0], cell[1], cell[2]}) < across_;
    }

    /// O(levels).
    void add(FourInts cell) { count(cell, 1); }
    void remove(FourInts cell) { count(cell, -1); }
    /// O(1) expected.
    void move(FourInts from, FourInts to);

    /// Calls \p visit(x, y, z) for inhabited cells, near ones first, as long as their distance from \p s, in
    /// cells and given as if every cell were \p slack larger, is below the \p bound it returns (in cells,
    /// squared). O(levels) expected where cells lie on a surface.
    template <class Visit>
    void nearest(const std::array<float, 3>& s, float slack, const Visit& visit) const {
        float bound = std::numeric_limits<float>::infinity();
        descend(s, slack, FourInts{0, 0, 0, 0}, static_cast<int>(counters_.size()), bound, visit);
    }

    std::size_t bytes() const;

private:
    struct Child {
        float squared_distance;
        std::int32_t x, y, z;
    };

    void count(FourInts cell, int by);
    std::int32_t& counter(int level, FourInts cell);
    bool inhabited(int level, std::int32_t x, std::int32_t y, std::int32_t z) const;
    int children(const std::array<float, 3>& s, float slack, FourInts cell, int level, float bound,
                 std::array<Child, 64>& found) const;

    template <class Visit>
    void descend(const std::array<float, 3>& s, float slack, FourInts cell, int level, float& bound,
                 const Visit& visit) const {
        std::array<Child, 64> found;
        const int n = children(s, slack, cell, level, bound, found);
        for (int i = 0; i < n && found[static_cast<std::size_t>(i)].squared_distance < bound; ++i) {
            const Child& c = found[static_cast<std::size_t>(i)];
            if (level == 1) {
                bound = std::min(bound, visit(c.x, c.y, c.z));
            } else {
                descend(s, slack, FourInts{c.x, c.y, c.z, 0}, level - 1, bound, visit);
            }
        }
    }

    std::int32_t across_ = 0;
    /// Counters per level, from the grid's own cells to the children of the root.
    std::vector<std::vector<std::int32_t>> counters_;
};

}  // namespace neuralmesh
