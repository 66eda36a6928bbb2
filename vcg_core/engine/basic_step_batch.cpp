// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/engine/basic_step_batch.h"

#include <vcg/space/box3.h>

#include <algorithm>
#include <array>
#include <vector>

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

void Slabs::adapt(const vcg::Point3f* signals, int count, int parts) {
    constexpr int kAdaptEvery = 64;  // batches
    if (parts == parts_ && (parts == 1 || ++batches_ % kAdaptEvery != 0)) return;
    parts_ = parts;
    vcg::Box3f box;
    for (int i = 0; i < count; ++i) box.Add(signals[i]);
    axis_ = box.MaxDim();
    std::vector<float> along;
    for (int i = 0; i < count; ++i) along.push_back(signals[i][axis_]);
    std::sort(along.begin(), along.end());
    for (int part = 0; part + 1 < parts; ++part)
        ends_[part] = along[static_cast<std::size_t>(count * (part + 1) / parts)];
}

void ComputedSteps::reserve(int count) {
    if (winners_.size() >= count) return;
    chosen_.resize(count);
    signals_.assign(count, vcg::Point3f(0, 0, 0));
    winners_.resize(count);
    deltas_.resize(count);
    displacements_.resize(count * kStride);
    by_valence_.resize(count);
    crosses_.resize(count);
    slabs_.resize(count * kStride);
}

void ComputedSteps::compute(const BatchInput& input, const Slabs& slabs, int part) {
    const Network& network = input.network;
    count_ = 0;
    for (int i = 0; i < input.count; ++i) {
        if (slabs.part_of(input.signals[i]) != part) continue;
        chosen_[count_] = i;
        signals_[count_++] = input.signals[i];
    }
    find_winners(input);
    sort_by_valence(network);

    const int* const order = by_valence_.data();
    const auto valence = [&](int k) { return network.ring(winners_[k]).valence; };
    for (int from = 0; from < count_;) {
        int to = from + 1;
        while (to < std::min(from + EightSteps::kLanes, count_) && valence(order[to]) == valence(order[from]))
            ++to;
        for (int next = to; input.out_of_cache && next < std::min(to + EightSteps::kLanes, count_); ++next)
            prefetch_ring_of(network, winners_[order[next]]);
        compute_group(input, order + from, to - from);
        from = to;
    }
    find_slabs(network, slabs, part);
}

void ComputedSteps::find_winners(const BatchInput& input) {
    const WinnerSearch& search = input.search;
    for (int k = 0; k < count_; ++k) {
        if (k + kHeadsAhead < count_) search.prefetch_heads(signals_[k + kHeadsAhead]);
        if (input.out_of_cache && k + kVerticesAhead < count_)
            search.prefetch_vertices(signals_[k + kVerticesAhead]);
        winners_[k] = search.winner(signals_[k]);
    }
}

void ComputedSteps::find_slabs(const Network& network, const Slabs& slabs, int part) {
    for (int k = 0; k < count_; ++k) {
        std::uint8_t* slab = slabs_.data() + k * kStride;
        const auto note = [&](VertexId v) {
            const int its = slabs.part_of(network.position(v));
            *slab++ = static_cast<std::uint8_t>(its);
            return its != part;
        };
        bool crosses = false;
        if (slabs.parts() > 1) {
            crosses = note(winners_[k]);
            for (const VertexId v : network.ring(winners_[k])) crosses = note(v) || crosses;
        }
        crosses_[k] = crosses ? 1 : 0;
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

void ComputedSteps::compute_group(const BatchInput& input, const int* group, int size) {
    VertexId winners[EightSteps::kLanes];
    vcg::Point3f their_signals[EightSteps::kLanes];
    Four* displacements[EightSteps::kLanes];
    for (int lane = 0; lane < EightSteps::kLanes; ++lane) {
        const int k = group[lane < size ? lane : 0];
        winners[lane] = winners_[k];
        their_signals[lane] = signals_[k];
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
    const bool out_of_cache = network.vertex_count() >= kLeastOutOfCache;
    const BatchInput input{signals, count, rates, network, search, out_of_cache};
    slabs_.adapt(signals, count, threads);
    steps_.resize(static_cast<std::size_t>(count));
    results_.resize(static_cast<std::size_t>(count));
    for (int part = 0; part < threads; ++part) {
        parts_[static_cast<std::size_t>(part)].reserve(count);
        changed_[static_cast<std::size_t>(part)].reserve(static_cast<std::size_t>(count) *
                                                         (1 + Ring::kMaxValence));
    }
    team_.parallel(threads, [&](int /*member*/, int part) { compute(input, part); });
    team_.parallel(threads, [&](int /*member*/, int part) { move_vertices(part, network, search); });
    for (int part = 0; part < threads; ++part) {
        for (const auto& changed : changed_[static_cast<std::size_t>(part)]) search.relink(changed);
        changed_[static_cast<std::size_t>(part)].clear();
    }
    return results_;
}

void BasicStepBatch::compute(const BatchInput& input, int part) {
    ComputedSteps& steps = parts_[static_cast<std::size_t>(part)];
    steps.compute(input, slabs_, part);
    for (int k = 0; k < steps.count(); ++k) {
        const auto signal = static_cast<std::size_t>(steps.signal(k));
        steps_[signal] = {static_cast<std::uint16_t>(k), static_cast<std::uint8_t>(part)};
        results_[signal] = {steps.winner(k), steps.delta(k)};
    }
}

/// Moves the vertices in slab \p part by all displacements, in the order of the signals.
void BasicStepBatch::move_vertices(int part, const Network& network, WinnerSearch& search) {
    std::vector<WinnerSearch::ChangedCell>& changed = changed_[static_cast<std::size_t>(part)];
    for (const Step& step : steps_) {
        const ComputedSteps& steps = parts_[step.part];
        const std::uint8_t* slab = steps.crosses(step.k) ? steps.slabs_of(step.k) : nullptr;
        if (step.part != part && slab == nullptr) continue;
        const Four* by = steps.displacements(step.k);
        const auto move_if_here = [&](VertexId v) {
            if (slab == nullptr || *slab++ == part)
                search.place(v, load_xyz(&network.slots()[v]) + *by, changed);
            ++by;
        };
        const VertexId winner = steps.winner(step.k);
        move_if_here(winner);
        for (const VertexId v : network.ring(winner)) move_if_here(v);
    }
}

}  // namespace neuralmesh
