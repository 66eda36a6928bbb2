// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/target/cell_groups.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace neuralmesh {
namespace {

using Place = NearestPoints::Place;
using Cell = OccupiedCell;

/// The code of the cell one step along \p axis (0: the lowest bit of each triple), by arithmetic on the bits
/// of that axis alone. At the border of the cube it is the cell at the opposite border.
std::uint64_t stepped(std::uint64_t code, int axis, int step, int level) {
    const std::uint64_t mask =
        (std::uint64_t{0x1249249249249249} << axis) & ((std::uint64_t{1} << 3 * level) - 1);
    const std::uint64_t one = std::uint64_t{1} << axis;
    if (step == 0) return code;
    const std::uint64_t moved = step > 0 ? (code | ~mask) + one : (code & mask) - one;
    return (moved & mask) | (code & ~mask);
}

/// Which cells of one level are connected. Nearly all neighbours are connected over other cells before all of
/// their points would have to be compared: a few of their points tell it for most, the others wait.
class Components {
public:
    Components(const NearestPoints& cloud, const std::vector<Cell>& cells, int level,
               const std::vector<std::uint8_t>& out)
        : cloud_(cloud),
          cells_(cells),
          level_(level),
          out_(out),
          squared_limit_(kConnected * cloud.cell_side(level) * kConnected * cloud.cell_side(level)),
          parent_(cells.size()),
          filter_(kFilterBits) {
        std::iota(parent_.begin(), parent_.end(), std::size_t{0});
        for (const Cell& cell : cells) filter_[cell.code % kFilterBits] = true;
    }

    /// The first cell of the component of each.
    std::vector<std::size_t> of_cells() {
        for (const auto& [begin, end] : {std::pair{0, 3}, std::pair{3, 13}})
            for (std::size_t c = 0; c < cells_.size(); ++c)
                for (int k = begin; k < end; ++k) join_if_seen(c, kSteps[k]);
        for (const auto& [a, b] : waiting_)
            if (root(a) != root(b) && are_close(cells_[a], cells_[b], 1)) join(a, b);
        for (std::size_t c = 0; c < cells_.size(); ++c) parent_[c] = root(c);
        return std::move(parent_);
    }

private:
    using Step = std::array<int, 3>;
    static constexpr std::size_t kFilterBits = std::size_t{1} << 21;
    static constexpr Place kFew = 4;  ///< points of a cell
    /// To half of the neighbours, the others look at this one: those at faces first, most of them are close.
    static constexpr Step kSteps[13] = {{-1, 0, 0},  {0, -1, 0},  {0, 0, -1},  {-1, -1, 0}, {1, -1, 0},
                                        {-1, 0, -1}, {1, 0, -1},  {0, -1, -1}, {0, 1, -1},  {-1, -1, -1},
                                        {1, -1, -1}, {-1, 1, -1}, {1, 1, -1}};

    /// By path halving.
    std::size_t root(std::size_t c) {
        while (parent_[c] != c) c = parent_[c] = parent_[parent_[c]];
        return c;
    }
    void join(std::size_t a, std::size_t b) {
        a = root(a);
        b = root(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

    void join_if_seen(std::size_t c, const Step& step) {
        std::uint64_t code = cells_[c].code;
        for (int axis = 0; axis < 3; ++axis)
            code = stepped(code, axis, step[static_cast<std::size_t>(axis)], level_);
        if (!filter_[code % kFilterBits]) return;  // of codes that may be occupied: most neighbours are not
        const auto at = std::lower_bound(cells_.begin(), cells_.end(), code,
                                         [](const Cell& cell, std::uint64_t key) { return cell.code < key; });
        if (at == cells_.end() || at->code != code) return;
        const auto other = static_cast<std::size_t>(at - cells_.begin());
        if (root(c) == root(other)) return;
        const Cell &a = cells_[c], &b = *at;
        if (std::size_t{a.end - a.begin} * (b.end - b.begin) > kMostPointPairs ||
            are_close(a, b, std::max<Place>(1, std::max(a.end - a.begin, b.end - b.begin) / kFew)))
            join(c, other);
        else
            waiting_.emplace_back(c, other);
    }

    /// Are two of every \p stride-th point of two cells closer than kConnected cell sides?
    bool are_close(const Cell& a, const Cell& b, Place stride) const {
        for (Place p = a.begin; p < a.end; p += stride)
            for (Place q = b.begin; q < b.end && out_[p] == 0; q += stride)
                if (out_[q] == 0 && (cloud_.point(p) - cloud_.point(q)).SquaredNorm() <= squared_limit_)
                    return true;
        return false;
    }

    const NearestPoints& cloud_;
    const std::vector<Cell>& cells_;
    int level_;
    const std::vector<std::uint8_t>& out_;
    float squared_limit_;
    std::vector<std::size_t> parent_;  ///< towards the first cell of the component
    std::vector<bool> filter_;
    std::vector<std::pair<std::size_t, std::size_t>> waiting_;  ///< neighbours, not yet known to be connected
};

}  // namespace

std::vector<OccupiedCell> occupied_cells(const NearestPoints& cloud, const std::vector<std::uint8_t>& out,
                                         int level) {
    std::vector<OccupiedCell> cells;
    for (Place p = 0; p < cloud.size(); ++p) {
        if (out[p] != 0) continue;
        const std::uint64_t code = cloud.cell(p, level);
        if (cells.empty() || cells.back().code != code) cells.push_back({code, p, p});
        cells.back().end = p + 1;
    }
    return cells;
}

std::vector<std::size_t> connected_cells(const NearestPoints& cloud, const std::vector<OccupiedCell>& cells,
                                         int level, const std::vector<std::uint8_t>& out) {
    return Components(cloud, cells, level, out).of_cells();
}

}  // namespace neuralmesh
