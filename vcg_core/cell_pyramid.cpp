// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Hashed counters, and the children of a cell by their distance.
#include "cell_pyramid.h"

namespace neuralmesh {

namespace {

std::size_t hash_of(std::int32_t x, std::int32_t y, std::int32_t z, std::size_t size) {
    const auto hash = static_cast<std::uint32_t>(x) * 0x9e3779b1u ^
                      static_cast<std::uint32_t>(y) * 0x85ebca77u ^
                      static_cast<std::uint32_t>(z) * 0xc2b2ae3du;
    return ((hash * 0x27d4eb2fu) >> 7) & (size - 1);
}

/// How far s is from the interval of \p size cells from \p low on, made \p slack larger.
float gap(float s, float low, float size, float slack) {
    return std::max({low - slack - s, s - (low + size + slack), 0.0F});
}

}  // namespace

CellPyramid::CellPyramid(std::size_t inhabited, std::int32_t across) : across_(across) {
    for (std::int32_t cells = across; counters_.empty() || cells > 1; cells = (cells + 3) / 4) {
        std::size_t size = 64;
        while (size < 2 * inhabited) size *= 2;
        counters_.emplace_back(size, 0);
        // A cell of the next level holds about as many of this as lie in a surface through it.
        inhabited /= 8;
    }
}

std::int32_t& CellPyramid::counter(int level, FourInts cell) {
    auto& counters = counters_[static_cast<std::size_t>(level)];
    const int shift = 2 * level;
    return counters[hash_of(cell[0] >> shift, cell[1] >> shift, cell[2] >> shift, counters.size())];
}

bool CellPyramid::inhabited(int level, std::int32_t x, std::int32_t y, std::int32_t z) const {
    const auto& counters = counters_[static_cast<std::size_t>(level)];
    return counters[hash_of(x, y, z, counters.size())] != 0;
}

void CellPyramid::count(FourInts cell, int by) {
    for (int level = 0; level < static_cast<int>(counters_.size()); ++level) counter(level, cell) += by;
}

void CellPyramid::move(FourInts from, FourInts to) {
    for (int level = 0; level < static_cast<int>(counters_.size()); ++level) {
        const FourInts difference = (from >> (2 * level)) ^ (to >> (2 * level));
        if ((difference[0] | difference[1] | difference[2]) == 0) return;
        --counter(level, from);
        ++counter(level, to);
    }
}

int CellPyramid::children(const std::array<float, 3>& s, float slack, FourInts cell, int level, float bound,
                          std::array<Child, 64>& found) const {
    const auto size = static_cast<float>(std::int64_t{1} << (2 * (level - 1)));
    std::array<std::array<float, 4>, 3> squared{};
    for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i < 4; ++i) {
            const auto a = static_cast<std::size_t>(axis);
            const float d = gap(s[a], static_cast<float>(4 * cell[axis] + i) * size, size, slack);
            squared[a][static_cast<std::size_t>(i)] = d * d;
        }
    int n = 0;
    for (int i = 0; i < 64; ++i) {
        const auto x = static_cast<std::size_t>(i & 3);
        const auto y = static_cast<std::size_t>(i >> 2 & 3);
        const auto z = static_cast<std::size_t>(i >> 4);
        const float distance = squared[0][x] + squared[1][y] + squared[2][z];
        const Child child{distance, 4 * cell[0] + (i & 3), 4 * cell[1] + (i >> 2 & 3),
                          4 * cell[2] + (i >> 4)};
        if (distance < bound && inhabited(level - 1, child.x, child.y, child.z))
            found[static_cast<std::size_t>(n++)] = child;
    }
    std::sort(found.begin(), found.begin() + n,
              [](const Child& a, const Child& b) { return a.squared_distance < b.squared_distance; });
    return n;
}

std::size_t CellPyramid::bytes() const {
    std::size_t bytes = 0;
    for (const auto& level : counters_) bytes += level.size() * sizeof(std::int32_t);
    return bytes;
}

}  // namespace neuralmesh
