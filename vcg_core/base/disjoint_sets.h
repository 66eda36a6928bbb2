// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Sets of numbers that are connected.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace neuralmesh {

/// Disjoint sets of the numbers 0 to count - 1, each alone at first: union-find with path halving.
class DisjointSets {
public:
    explicit DisjointSets(int count) : parent_(static_cast<std::size_t>(count)) {
        std::iota(parent_.begin(), parent_.end(), 0);
    }

    /// The least number of the set of \p i.
    int find(int i) {
        while (parent(i) != i) i = parent(i) = parent(parent(i));
        return i;
    }
    /// Unites the sets of \p a and \p b. \return false if they are one already
    bool join(int a, int b) {
        a = find(a);
        b = find(b);
        if (a == b) return false;
        if (a > b) std::swap(a, b);
        parent(b) = a;
        return true;
    }

private:
    int& parent(int i) { return parent_[static_cast<std::size_t>(i)]; }
    std::vector<int> parent_;
};

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
