// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The median of a list of numbers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace neuralmesh {

/// The upper median of \p values, of which there must be at least one. O(values).
template <class Number>
Number median(std::vector<Number> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace neuralmesh
