// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/engine/cell_pyramid.h"

#include "vcg_core/base/platform.h"

namespace neuralmesh {

namespace {

/// Distance of s from the interval [low - slack, low + size + slack].
float gap(float s, float low, float size, float slack) {
    return std::max({low - slack - s, s - (low + size + slack), 0.0F});
}

}  // namespace

CellPyramid::CellPyramid(std::int32_t across) : across_(across) {
    std::int32_t cells = across;
    do {
        cells = (cells + 3) / 4;
        nodes_.emplace_back();
    } while (cells > 1);
}

void CellPyramid::count(FourInts cell, int by) {
    for (std::size_t level = 1; level <= nodes_.size(); ++level) count(cell, level, by);
}

void CellPyramid::count(FourInts cell, std::size_t level, int by) {
    const Cell at = coarser(cell, level);
    Node& node = nodes(level)[key_of(at)];
    const bool was_empty = node.count == 0;
    node.count += by;
    const bool is_empty = node.count == 0;
    if (was_empty != is_empty && level < nodes_.size()) {
        const std::uint64_t bit = std::uint64_t{1} << ((at[0] & 3) | (at[1] & 3) << 2 | (at[2] & 3) << 4);
        std::uint64_t& siblings = nodes(level + 1)[key_of(coarser(cell, level + 1))].children;
        siblings = is_empty ? siblings & ~bit : siblings | bit;
    }
    if (is_empty) nodes(level).erase(key_of(at));
}

void CellPyramid::move(FourInts from, FourInts to) {
    for (std::size_t level = 1; level <= nodes_.size() && coarser(from, level) != coarser(to, level);
         ++level) {
        count(from, level, -1);
        count(to, level, 1);
    }
}

CellPyramid::Slices CellPyramid::slices(const std::array<float, 3>& s, float slack, const Cell& cell,
                                        std::size_t level) {
    const auto size = static_cast<float>(std::int64_t{1} << (2 * (level - 1)));
    Slices squared{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::int32_t i = 0; i < 4; ++i) {
            const float d = gap(s[axis], static_cast<float>(4 * cell[axis] + i) * size, size, slack);
            squared[axis][static_cast<std::size_t>(i)] = d * d;
        }
    return squared;
}

/// The occupied children nearer than \p bound, in order of distance. \return their number.
int CellPyramid::near_children(const Slices& squared, const Cell& cell, std::size_t level, float bound,
                               std::array<Child, 64>& found) const {
    auto end = found.begin();
    for (std::uint64_t left = nodes(level).at(key_of(cell)).children; left != 0; left &= left - 1) {
        const int i = lowest_bit(left);
        const float distance = squared_distance(squared, i);
        if (distance < bound) *end++ = {distance, child_of(cell, i)};
    }
    std::sort(found.begin(), end,
              [](const Child& a, const Child& b) { return a.squared_distance < b.squared_distance; });
    return static_cast<int>(end - found.begin());
}

std::size_t CellPyramid::bytes() const {
    std::size_t bytes = 0;
    for (const auto& level : nodes_) {
        // Per node its key and a link, per bucket its head.
        bytes +=
            level.size() * (sizeof(Node) + 2 * sizeof(std::uint64_t)) + level.bucket_count() * sizeof(void*);
    }
    return bytes;
}

}  // namespace neuralmesh
