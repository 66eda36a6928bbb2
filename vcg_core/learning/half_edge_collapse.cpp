// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/learning/half_edge_collapse.h"

#include <limits>

namespace neuralmesh {

namespace {

/// The neighbour into which \p gone collapses at the least cost; -1 if no collapse is legal.
VertexId best_collapse(const Network& network, VertexId gone) {
    const Ring& ring = network.ring(gone);
    VertexId best = -1;
    int least = std::numeric_limits<int>::max();
    const auto valence = [&](VertexId v) { return static_cast<int>(network.ring(v).valence); };
    const auto square = [](int x) { return x * x; };
    for (int i = 0; i < ring.valence; ++i) {
        // Without the root and the factor, which do not change the order.
        const int cost = square(ring.valence + valence(ring[i]) - 10) + square(valence(ring.next(i)) - 7) +
                         square(valence(ring.previous(i)) - 7);
        if (cost >= least || !network.can_collapse(gone, ring[i])) continue;
        least = cost;
        best = ring[i];
    }
    return best;
}

}  // namespace

int half_edge_collapse(LearningState& state, std::int64_t since) {
    int removed = 0;
    for (const VertexId v : state.network.vertices()) {
        if (state.activity.active_since(v, since) || state.network.ring(v).open != 0) continue;
        const VertexId kept = best_collapse(state.network, v);
        if (kept < 0) continue;
        state.collapse(v, kept);
        state.regularise(kept);
        ++removed;
    }
    state.search.rebuild_if_outgrown();
    return removed;
}

}  // namespace neuralmesh
