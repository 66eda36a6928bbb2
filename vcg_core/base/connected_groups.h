// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Groups of few items that are connected.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace neuralmesh {

/// \p items in groups: \p connected(a, b) tells whether two are in one, which others may also bring together.
/// Each group begins with the first of its items. O(items^2)
template <class Connected>
std::vector<std::vector<int>> connected_groups(std::vector<int> items, const Connected& connected) {
    std::vector<std::vector<int>> groups;
    while (!items.empty()) {
        std::vector<int> group{items.front()};
        items.erase(items.begin());
        for (std::size_t i = 0; i < group.size(); ++i) {
            const int member = group[i];
            const auto rest = std::stable_partition(items.begin(), items.end(),
                                                    [&](int other) { return !connected(member, other); });
            group.insert(group.end(), rest, items.end());
            items.erase(rest, items.end());
        }
        groups.push_back(std::move(group));
    }
    return groups;
}

}  // namespace neuralmesh
