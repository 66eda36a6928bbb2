// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The signals that boundary vertices have won: they tell a notch in the boundary from an opening of the
// cloud.
#pragma once

#include <vcg/space/point3.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// Signals by their winners.
class BoundarySignals {
public:
    void add(VertexId winner, const vcg::Point3f& signal) {
        won_.emplace_back(winner, signal);
        sorted_ = false;
    }
    void clear() { won_.clear(); }

    /// Whether \p accepts any signal that \p winner has won. O(log n), and O(n log n) after signals were
    /// added.
    template <class Accepts>
    bool any_of(VertexId winner, const Accepts& accepts) {
        const auto earlier = [](const Won& a, const Won& b) { return a.first < b.first; };
        if (!sorted_) std::stable_sort(won_.begin(), won_.end(), earlier);
        sorted_ = true;
        const auto range = std::equal_range(won_.begin(), won_.end(), Won(winner, {}), earlier);
        return std::any_of(range.first, range.second, [&](const Won& won) { return accepts(won.second); });
    }

private:
    using Won = std::pair<VertexId, vcg::Point3f>;
    std::vector<Won> won_;
    bool sorted_ = true;
};

}  // namespace neuralmesh
