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

/// The median of each value, the two before and the two after it.
template <class Number>
std::vector<Number> running_median(const std::vector<Number>& values) {
    constexpr std::size_t kBeside = 2;  // two outliers do not change the median of five
    std::vector<Number> result;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto begin = values.begin() + static_cast<std::ptrdiff_t>(i - std::min(i, kBeside));
        const auto end =
            values.begin() + static_cast<std::ptrdiff_t>(std::min(values.size(), i + kBeside + 1));
        result.push_back(median<Number>({begin, end}));
    }
    return result;
}

}  // namespace neuralmesh
