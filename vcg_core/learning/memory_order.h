// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Keeps vertices that are near in space near in memory while a network learns.
#pragma once

#include <algorithm>
#include <cstdint>

#include "vcg_core/paper/learning_state.h"

namespace neuralmesh {

/// Renumbers the vertices along a space-filling curve now and then. The vertices that a Basic Step visits
/// then share cache lines and pages, and those that different threads visit do not. Results change only where
/// they depend on the order of ids, as ties and the order of collapses do. Small networks fit into the cache
/// and keep their order.
class MemoryOrder {
public:
    /// Whenever the network has grown by a quarter. Leaves free ids for new vertices between the others.
    /// \return whether vertices have other ids now. O(n log n) then, O(1) otherwise.
    bool renew_while_growing(LearningState& state) {
        const int n = state.network.vertex_count();
        if (n < kLeastOrdered || n < ordered_vertices_ + ordered_vertices_ / 4) return false;
        renew(state, std::min(n / 4, state.options.grow_to - n));
        return true;
    }
    /// The same, without free ids, if there were splits or collapses since the last time: for a long phase
    /// without them.
    bool renew_at_rest(LearningState& state) {
        const bool changed = ordered_changes_ != state.splits + state.collapses;
        if (state.network.vertex_count() < kLeastOrdered || !changed) return false;
        renew(state, 0);
        return true;
    }

private:
    void renew(LearningState& state, int free_ids) {
        ordered_vertices_ = state.network.vertex_count();
        ordered_changes_ = state.splits + state.collapses;
        state.renumber(interleave_free(morton_order(state.network), free_ids));
    }

    static constexpr int kLeastOrdered = 2048;  ///< vertices: they outgrow a core's first cache

    int ordered_vertices_ = 0;           ///< when last renewed
    std::int64_t ordered_changes_ = -1;  ///< splits and collapses when last renewed
};

}  // namespace neuralmesh
