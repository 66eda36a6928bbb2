// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// How the feature counter is shown as a colour.
#pragma once

#include <array>
#include <vector>

namespace neuralmesh {

using Color = std::array<unsigned char, 3>;  ///< red, green, blue

/// One colour per counter on the ramp "viridis" (van der Walt and Smith, 2015), even to the eye and readable
/// without colour vision: dark violet at the 2nd percentile and below, yellow at the 98th and above, so that
/// a few outliers do not hide the rest. O(counters).
std::vector<Color> counter_colors(const std::vector<float>& counters);

}  // namespace neuralmesh
