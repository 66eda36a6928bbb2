// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The Z-order curve (Morton 1966): cells that are near along it are near in space.
#pragma once

#include <cstdint>

namespace neuralmesh {

/// Spreads the low 21 bits of \p x: bit i moves to bit 3 i.
inline std::uint64_t spread_bits(std::uint64_t x) {
    x &= 0x1fffff;
    x = (x | x << 32) & 0x1f00000000ffff;
    x = (x | x << 16) & 0x1f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
}

/// The place along the curve of the cell \p x, \p y, \p z of a grid of at most 2^21 cells along an axis.
inline std::uint64_t z_order(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
    return spread_bits(x) | spread_bits(y) << 1 | spread_bits(z) << 2;
}

}  // namespace neuralmesh
