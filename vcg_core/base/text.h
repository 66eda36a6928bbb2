// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Numbers as text for warnings, the same in every locale.
#pragma once

#include <cmath>
#include <string>

namespace neuralmesh {

/// \p share as a percentage with one decimal: "3.4 %". \pre share >= 0
inline std::string percent(double share) {
    const long long tenths = std::llround(share * 1000);
    return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " %";
}

}  // namespace neuralmesh
