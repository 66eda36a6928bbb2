// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/learning/memory_order.h"

#include "vcg_core/mesh/vertex_order.h"

namespace neuralmesh {

namespace {

constexpr int kLeastOrdered = 2048;  ///< vertices of a network that outgrows a core's first cache

}  // namespace

void MemoryOrder::update_while_growing() {
    if (state_.network.vertex_count() >= ordered_vertices_ + ordered_vertices_ / 4) reorder();
}

void MemoryOrder::finish() {
    if (ordered_changes_ != state_.splits + state_.collapses) reorder();
}

void MemoryOrder::reorder() {
    if (state_.network.vertex_count() < kLeastOrdered) return;
    ordered_vertices_ = state_.network.vertex_count();
    ordered_changes_ = state_.splits + state_.collapses;
    state_.renumber(morton_order(state_.network));
}

}  // namespace neuralmesh
