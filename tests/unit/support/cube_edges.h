// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The edges of the cube [-1, 1]^3: creases whose place is known.
#pragma once

#include <vcg/space/point3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace neuralmesh {

/// Of a point near the cube's surface from the nearest edge of the cube.
inline double distance_from_edge(const vcg::Point3f& p) {
    std::array<double, 3> off{};
    for (int k = 0; k < 3; ++k)
        off[static_cast<std::size_t>(k)] = std::abs(std::abs(static_cast<double>(p[k])) - 1);
    std::sort(off.begin(), off.end());
    return std::hypot(off[0], off[1]);
}

}  // namespace neuralmesh
