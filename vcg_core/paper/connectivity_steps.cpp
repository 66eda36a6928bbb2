// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/paper/connectivity_steps.h"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "vcg_core/mesh/flips.h"

namespace neuralmesh {

namespace {

constexpr int kMostTried = 32;  ///< vertices whose star cannot be halved, before the step gives up

/// The edges of a star that go to the new vertex, by position in the ring: \p count of them from \p first on.
struct Half {
    int first;
    int count;  ///< 0: the star cannot be halved
};

int longest_edge(const Network& network, VertexId v) {
    const Ring& ring = network.ring(v);
    int longest = 0;
    float length = -1;
    for (int i = 0; i < ring.valence; ++i) {
        const float l = (network.position(ring[i]) - network.position(v)).SquaredNorm();
        if (l <= length) continue;
        length = l;
        longest = i;
    }
    return longest;
}

/// Sum of valence_irregularity() over the four vertices whose valence the split changes.
int irregularity_after(const Network& network, VertexId v, const Half& half) {
    const Ring& ring = network.ring(v);
    const auto end_valence = [&](int i) { return network.ring(ring[i % ring.valence]).valence + 1; };
    return valence_irregularity(half.count + 1) + valence_irregularity(ring.valence - half.count + 3) +
           valence_irregularity(end_valence(half.first)) +
           valence_irregularity(end_valence(half.first + half.count - 1));
}

/// The two walks from the longest edge may differ by one edge in length, and so may the two halves. Of these
/// choices, takes the one with the most regular valences.
Half halve_star(const Network& network, VertexId v, int longest) {
    const Ring& ring = network.ring(v);
    const int k = ring.valence;
    Half best{0, 0};
    int least = std::numeric_limits<int>::max();
    for (int back = 1; back <= k / 2; ++back) {
        for (int ahead = 1; ahead <= k / 2; ++ahead) {
            if (std::abs(back - ahead) > 1 || std::abs(2 * (back + ahead) - std::max(k, 3)) > 1) continue;
            Half half{(longest - back + k) % k, back + ahead + 1};
            if (ring.open != 0) {  // an open star ends at its boundary edges
                half.first = std::max(longest - back, 0);
                half.count = std::min(longest + ahead, k - 1) - half.first + 1;
            }
            if (!network.can_split(v, half.first, half.count)) continue;
            const int irregularity = irregularity_after(network, v, half);
            if (irregularity >= least) continue;
            least = irregularity;
            best = half;
        }
    }
    return best;
}

bool split_along_longest_edge(LearningState& state, VertexId v) {
    const Network& network = state.network;
    const int longest = longest_edge(network, v);
    const Half half = halve_star(network, v, longest);
    if (half.count == 0) return false;
    const Ring& ring = network.ring(v);
    const VertexId e1 = ring[(half.first + half.count - 1) % ring.valence];
    const VertexId e2 = ring[half.first];
    const vcg::Point3f midpoint = (network.position(v) + network.position(ring[longest])) / 2;
    const VertexId u = state.split(v, half.first, half.count, midpoint);
    for (const VertexId w : {v, u, e1, e2}) state.regularise(w);
    return true;
}

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

bool vertex_split(LearningState& state, const std::function<bool(VertexId)>& may_split) {
    bool any_refused = false;
    for (int tried = 0; tried < kMostTried; ++tried) {
        const VertexId v = state.utility_counters.highest();
        if (v < 0) break;
        const bool refused = !may_split(v);
        if (!refused && split_along_longest_edge(state, v)) return true;
        any_refused = any_refused || refused;
        state.utility_counters.defer(v);
    }
    state.splits_refused += any_refused ? 1 : 0;
    return false;
}

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
