// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Keeps vertices that are near in space near in memory.
#pragma once

#include <cstdint>

#include "vcg_core/engine/basic_step_batch.h"
#include "vcg_core/learning/learning_state.h"

namespace neuralmesh {

/// Renumbers the vertices of a growing network along a space-filling curve: the vertices that a Basic Step
/// visits then share cache lines and pages, and those that different threads visit do not. This changes ids,
/// and of the results only what depends on the order of ids. Small networks fit into the cache anyway and
/// keep their order.
class MemoryOrder {
public:
    /// Keeps references to both.
    MemoryOrder(LearningState& state, BasicStepBatch& batch) : state_(state), batch_(batch) {}

    /// Renumbers whenever the network has grown by a quarter, and leaves free ids between the vertices for
    /// those to come. O(n log n) then, O(1) else.
    void update_while_growing();
    /// Renumbers, without free ids, if splits or collapses came after the last time. For before a long phase
    /// without them. O(n log n).
    void finish();

private:
    void reorder(int free_ids);

    LearningState& state_;
    BasicStepBatch& batch_;
    int ordered_vertices_ = 0;           ///< when last renumbered
    std::int64_t ordered_changes_ = -1;  ///< splits and collapses when last renumbered
};

}  // namespace neuralmesh
