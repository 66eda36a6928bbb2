// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Steps are computed in groups of up to eight winners of one valence.
#include "vcg_core/engine/slab_steps.h"

#include <algorithm>
#include <array>

#include "vcg_core/base/platform.h"

namespace neuralmesh {

namespace {

/// Networks of this size do not fit into a core's second cache.
constexpr int kLeastOutOfCache = 16384;
/// Signals between the prefetch of a cell's list head, or of its first vertex, and the search.
constexpr int kHeadsAhead = 8;
constexpr int kVerticesAhead = 4;

/// Prefetches what EightSteps::gather() reads first around a winner.
void prefetch_ring_of(const Network& network, VertexId winner) {
    for (const VertexId v : network.ring(winner)) {
        prefetch(&network.ring(v));
        prefetch(&network.slots()[v]);
    }
}

}  // namespace

void SlabSteps::reserve(int count) {
    if (signals_.size() >= count) return;
    signals_.resize(count);
    winners_.resize(count);
    deltas_.resize(count);
    displacements_.resize(count * kStride);
    by_valence_.resize(count);
    inside_.resize(count);
}

void SlabSteps::compute(const BatchInput& input, const SlabSchedule& schedule, int slab) {
    const Network& network = input.network;
    count_ = schedule.signals_in(slab, input.signals, input.count, signals_);
    // With several slabs, some vertices were last moved by another thread and are in the cache of its core.
    const bool out_of_cache = schedule.slabs() > 1 || network.vertex_count() >= kLeastOutOfCache;
    find_winners(input, out_of_cache);
    sort_by_valence(network);

    const int* const order = by_valence_.data();
    const auto valence = [&](int k) { return network.ring(winners_[k]).valence; };
    const int slab_to_check = schedule.slabs() > 1 ? slab : -1;
    moves_ = 0;
    for (int from = 0; from < count_;) {
        int to = from + 1;
        while (to < std::min(from + EightSteps::kLanes, count_) && valence(order[to]) == valence(order[from]))
            ++to;
        for (int next = to; out_of_cache && next < std::min(to + EightSteps::kLanes, count_); ++next)
            prefetch_ring_of(network, winners_[order[next]]);
        compute_group(input, slab_to_check, order + from, to - from);
        from = to;
    }
}

void SlabSteps::find_winners(const BatchInput& input, bool out_of_cache) {
    const WinnerSearch& search = input.search;
    const auto signal = [&](int k) { return input.signals[signals_[k]]; };
    for (int k = 0; k < count_; ++k) {
        if (k + kHeadsAhead < count_) search.prefetch_heads(signal(k + kHeadsAhead));
        if (out_of_cache && k + kVerticesAhead < count_) search.prefetch_vertices(signal(k + kVerticesAhead));
        winners_[k] = search.winner(signal(k));
    }
}

/// A counting sort.
void SlabSteps::sort_by_valence(const Network& network) {
    std::array<int, Ring::kMaxValence + 2> place{};
    const auto valence = [&](int k) { return std::size_t{network.ring(winners_[k]).valence}; };
    for (int k = 0; k < count_; ++k) ++place[valence(k) + 1];
    for (std::size_t v = 1; v < place.size(); ++v) place[v] += place[v - 1];
    for (int k = 0; k < count_; ++k) by_valence_[place[valence(k)]++] = k;
}

/// \p slab: that of the steps; -1 if there is only one.
void SlabSteps::compute_group(const BatchInput& input, int slab, const int* group, int size) {
    VertexId winners[EightSteps::kLanes];
    vcg::Point3f signals[EightSteps::kLanes];
    Four* displacements[EightSteps::kLanes];
    for (int lane = 0; lane < EightSteps::kLanes; ++lane) {
        const int k = group[lane < size ? lane : 0];
        winners[lane] = winners_[k];
        signals[lane] = input.signals[signals_[k]];
        displacements[lane] = displacements_.data() + k * kStride;
    }
    EightVectors n;
    EightVectors n_after;
    eight_.gather(input.network, winners, size);
    eight_.normals(n);
    eight_.move_winners(signals, input.rates.learning_rate);
    eight_.smooth(input.rates.smoothing_steps, input.rates.smoothing_rate);
    eight_.normals(n_after);
    eight_.displacements(displacements);
    moves_ += size * (1 + eight_.valence());
    for (int lane = 0; lane < size; ++lane) {
        const float x = n_after.x[lane] - n.x[lane];
        const float y = n_after.y[lane] - n.y[lane];
        const float z = n_after.z[lane] - n.z[lane];
        deltas_[group[lane]] = 0.5F * (x * x + y * y + z * z);  // eq 2: 1 - n.n', without cancellation
        inside_[group[lane]] = slab < 0 || moves_only_in(input.network, winners[lane], slab) ? 1 : 0;
    }
}

}  // namespace neuralmesh
