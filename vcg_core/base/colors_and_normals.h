// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// What points carry beside their coordinates: colours, and unit normals, in three bytes each.
#pragma once

#include <vcg/space/point3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace neuralmesh {

using Color = std::array<unsigned char, 3>;  ///< red, green, blue, as files and screens have them

/// The coordinates times 127; {0, 0, 0}: there is no normal.
using PackedNormal = std::array<std::int8_t, 3>;

constexpr PackedNormal kNoNormal{0, 0, 0};

/// The direction of \p n, of any length, to .4 degrees. Nothing if it is zero or not finite.
inline PackedNormal packed(const std::array<double, 3>& n) {
    double largest = 0;
    for (const double x : n) {
        if (!std::isfinite(x)) return kNoNormal;
        largest = std::max(largest, std::abs(x));
    }
    if (!(largest > 0)) return kNoNormal;
    // Divided first, because squares may overflow and underflow.
    const double x = n[0] / largest, y = n[1] / largest, z = n[2] / largest;
    const double length = std::sqrt(x * x + y * y + z * z);
    const auto whole = [&](double c) { return static_cast<std::int8_t>(std::lround(127 * c / length)); };
    return {whole(x), whole(y), whole(z)};
}

/// Of length 1, to 1 %; zero if there is none.
inline vcg::Point3f unpacked(const PackedNormal& n) {
    return {static_cast<float>(n[0]) / 127, static_cast<float>(n[1]) / 127, static_cast<float>(n[2]) / 127};
}

}  // namespace neuralmesh
