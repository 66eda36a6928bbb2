// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/engine/basic_step_batch.h"

#include <algorithm>
#include <array>

#include "vcg_core/base/platform.h"

namespace neuralmesh {

namespace {

constexpr int kLeastPerThread = 48;  ///< signals: with fewer, synchronisation costs more than a thread saves
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

void ComputedSteps::reserve(int count) {
    if (winners_.size() >= count) return;
    winners_.resize(count);
    deltas_.resize(count);
    displacements_.resize(count * kStride);
    by_valence_.resize(count);
}

void ComputedSteps::compute(const BatchInput& input, int first, int count) {
    const Network& network = input.network;
    const vcg::Point3f* signals = input.signals + first;
    count_ = count;
    find_winners(input, signals);
    sort_by_valence(network);

    const int* const order = by_valence_.data();
    const auto valence = [&](int k) { return network.ring(winners_[k]).valence; };
    for (int from = 0; from < count_;) {
        int to = from + 1;
        while (to < std::min(from + EightSteps::kLanes, count_) && valence(order[to]) == valence(order[from]))
            ++to;
        for (int next = to; input.out_of_cache && next < std::min(to + EightSteps::kLanes, count_); ++next)
            prefetch_ring_of(network, winners_[order[next]]);
        compute_group(input, signals, order + from, to - from);
        from = to;
    }
}

void ComputedSteps::find_winners(const BatchInput& input, const vcg::Point3f* signals) {
    const WinnerSearch& search = input.search;
    for (int k = 0; k < count_; ++k) {
        if (k + kHeadsAhead < count_) search.prefetch_heads(signals[k + kHeadsAhead]);
        if (input.out_of_cache && k + kVerticesAhead < count_)
            search.prefetch_vertices(signals[k + kVerticesAhead]);
        winners_[k] = search.winner(signals[k]);
    }
}

/// A counting sort.
void ComputedSteps::sort_by_valence(const Network& network) {
    std::array<int, Ring::kMaxValence + 2> place{};
    const auto valence = [&](int k) { return std::size_t{network.ring(winners_[k]).valence}; };
    for (int k = 0; k < count_; ++k) ++place[valence(k) + 1];
    for (std::size_t v = 1; v < place.size(); ++v) place[v] += place[v - 1];
    for (int k = 0; k < count_; ++k) by_valence_[place[valence(k)]++] = k;
}

void ComputedSteps::compute_group(const BatchInput& input, const vcg::Point3f* signals, const int* group,
                                  int size) {
    VertexId winners[EightSteps::kLanes];
    vcg::Point3f their_signals[EightSteps::kLanes];
    Four* displacements[EightSteps::kLanes];
    for (int lane = 0; lane < EightSteps::kLanes; ++lane) {
        const int k = group[lane < size ? lane : 0];
        winners[lane] = winners_[k];
        their_signals[lane] = signals[k];
        displacements[lane] = displacements_.data() + k * kStride;
    }
    EightVectors n;
    EightVectors n_after;
    eight_.gather(input.network, winners, size);
    eight_.normals(n);
    eight_.move_winners(their_signals, input.rates.learning_rate);
    eight_.smooth(input.rates.smoothing_steps, input.rates.smoothing_rate);
    eight_.normals(n_after);
    eight_.displacements(displacements);
    for (int lane = 0; lane < size; ++lane) {
        const float x = n_after.x[lane] - n.x[lane];
        const float y = n_after.y[lane] - n.y[lane];
        const float z = n_after.z[lane] - n.z[lane];
        deltas_[group[lane]] = 0.5F * (x * x + y * y + z * z);  // eq 2: 1 - n.n', without cancellation
    }
}

const std::vector<StepResult>& BasicStepBatch::take(const vcg::Point3f* signals, int count,
                                                    const StepRates& rates, Network& network,
                                                    WinnerSearch& search) {
    const int threads = std::clamp(count / kLeastPerThread, 1, team_.members());
    // With several threads, one has moved all vertices, and they are in the cache of its core.
    const bool out_of_cache = threads > 1 || network.vertex_count() >= kLeastOutOfCache;
    const BatchInput input{signals, rates, network, search, out_of_cache};
    for (int part = 0; part < threads; ++part)
        parts_[static_cast<std::size_t>(part)].reserve((count + threads - 1) / threads);
    team_.parallel(threads, [&](int /*member*/, int part) {
        const int first = count * part / threads;
        parts_[static_cast<std::size_t>(part)].compute(input, first, count * (part + 1) / threads - first);
    });
    results_.clear();
    for (int part = 0; part < threads; ++part) apply(parts_[static_cast<std::size_t>(part)], network, search);
    return results_;
}

/// Moves vertices by all displacements, in the order of the signals.
void BasicStepBatch::apply(const ComputedSteps& steps, const Network& network, WinnerSearch& search) {
    for (int k = 0; k < steps.count(); ++k) {
        const Four* by = steps.displacements(k);
        const VertexId winner = steps.winner(k);
        results_.push_back({winner, steps.delta(k)});
        search.move(winner, load_xyz(&network.slots()[winner]) + by[0]);
        for (const VertexId v : network.ring(winner)) search.move(v, load_xyz(&network.slots()[v]) + *++by);
    }
}

}  // namespace neuralmesh
