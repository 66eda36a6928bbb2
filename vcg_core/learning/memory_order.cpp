// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/learning/memory_order.h"

#include <algorithm>

namespace neuralmesh {

namespace {

constexpr int kLeastOrdered = 2048;  ///< vertices of a network that outgrows a core's first cache

}  // namespace

void MemoryOrder::update_while_growing() {
    const int n = state_.network.vertex_count();
    if (n >= kLeastOrdered && n >= ordered_vertices_ + ordered_vertices_ / 4)
        reorder(std::min(n / 4, state_.options.grow_to - n));
}

void MemoryOrder::finish() {
    if (state_.network.vertex_count() >= kLeastOrdered &&
        ordered_changes_ != state_.splits + state_.collapses)
        reorder(0);
}

void MemoryOrder::reorder(int free_ids) {
    ordered_vertices_ = state_.network.vertex_count();
    ordered_changes_ = state_.splits + state_.collapses;
    state_.renumber(interleave_free(morton_order(state_.network), free_ids));
}

}  // namespace neuralmesh
