// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Disjoint sets by union-find with path halving.
#pragma once

#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace neuralmesh {

/// Sets of the numbers 0 to count - 1, each alone at first.
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

}  // namespace neuralmesh
