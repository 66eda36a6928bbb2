// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Numbers as text for warnings, the same in every locale.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <locale>
#include <sstream>
#include <string>

namespace neuralmesh {

/// An empty stream that writes numbers with \p digits significant digits.
inline std::ostringstream stream_with(int digits) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text.precision(digits);
    return text;
}

/// \p share as a percentage with one decimal: "3.4 %". \pre share >= 0
inline std::string percent(double share) {
    const long long tenths = std::llround(share * 1000);
    return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " %";
}

/// "30 of 5030 points (0.6 %)". \pre all > 0
inline std::string share_of_points(std::size_t part, std::size_t all) {
    const double share = std::max(0.001, static_cast<double>(part) / static_cast<double>(all));
    return std::to_string(part) + " of " + std::to_string(all) + " points (" + percent(share) + ")";
}

}  // namespace neuralmesh
