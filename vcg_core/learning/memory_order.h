// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Keeps vertices that are near in space near in memory.
#pragma once

#include <cstdint>

#include "vcg_core/learning/learning_state.h"

namespace neuralmesh {

/// Renumbers the vertices of a growing network along a space-filling curve: the vertices that a Basic Step
/// visits then share cache lines and pages, and those that different threads visit do not. Results change
/// only where they depend on the order of ids, as ties and the order of collapses do. Small networks fit into
/// the cache and keep their order.
class MemoryOrder {
public:
    /// Keeps a reference to \p state.
    explicit MemoryOrder(LearningState& state) : state_(state) {}

    /// Renumbers whenever the network has grown by a quarter, and leaves free ids between the vertices for
    /// new ones. O(n log n) then, O(1) otherwise.
    void update_while_growing();
    /// Renumbers, without free ids, if there were splits or collapses since the last time. Call it before a
    /// long phase without them. O(n log n).
    void finish();

private:
    void reorder(int free_ids);

    LearningState& state_;
    int ordered_vertices_ = 0;           ///< when last renumbered
    std::int64_t ordered_changes_ = -1;  ///< splits and collapses when last renumbered
};

}  // namespace neuralmesh
