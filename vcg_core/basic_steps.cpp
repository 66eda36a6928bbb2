// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Winners, groups of eight of one valence, and the sum of what they move.
#include "basic_steps.h"

#include <algorithm>
#include <array>
#include <chrono>

#include "fit_parallel.h"

namespace neuralmesh {

namespace {

/// Fewer signals than this are not worth a second thread.
constexpr int kLeastPerThread = 48;
/// Batches of each kind in a trial, and from one trial to the next.
constexpr int kTrial = 32;
constexpr int kBetweenTrials = 2048;
/// Signals whose cells, and whose cells' vertices, are on their way into the cache.
constexpr int kHeadsAhead = 8;
constexpr int kVerticesAhead = 4;

/// Brings into the cache what gather() will read first around a winner.
void prefetch_ring_of(const Network& network, VertexId winner) {
    const Ring& ring = network.ring(winner);
    for (int i = 0; i < ring.valence; ++i) {
        __builtin_prefetch(&network.ring(ring[i]));
        __builtin_prefetch(&network.slots()[ring[i]]);
    }
}

}  // namespace

bool Pace::together() const { return batch_ < 2 * kTrial ? batch_ >= kTrial : together_ < alone_; }

void Pace::took(double nanoseconds) {
    if (batch_ < 2 * kTrial) (batch_ < kTrial ? alone_ : together_) += nanoseconds;
    if (++batch_ == kBetweenTrials) *this = Pace();
}

BasicSteps::BasicSteps(int threads)
    : team_(thread_count(threads)), scratch_(static_cast<std::size_t>(team_.members())) {}

void BasicSteps::take(const vcg::Point3f* signals, int count, const StepRates& rates, Network& network,
                      WinnerSearch& search) {
    const auto size = static_cast<std::size_t>(count);
    if (winners_.size() < size) {
        winners_.resize(size);
        deltas_.resize(size);
        displacements_.resize(size * kStride);
        for (Scratch& s : scratch_) s.order.resize(size);
    }
    const int most = std::clamp(count / kLeastPerThread, 1, team_.members());
    const int chunks = most > 1 && pace_.together() ? most : 1;
    const auto begin = std::chrono::steady_clock::now();
    team_.run(chunks, [&](int member, int chunk) {
        compute(signals, count * chunk / chunks, count * (chunk + 1) / chunks, rates, network, search,
                scratch_[static_cast<std::size_t>(member)]);
    });
    apply(count, network, search);
    // With the application, which pays for what another core has to be asked for.
    const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - begin;
    if (most > 1) pace_.took(taken.count() / count);
}

void BasicSteps::compute(const vcg::Point3f* signals, int begin, int end, const StepRates& rates,
                         const Network& network, const WinnerSearch& search, Scratch& scratch) {
    const bool out_of_cache = network.vertex_count() >= kLeastOutOfCache;
    for (int j = begin; j < end; ++j) {
        if (j + kHeadsAhead < end) search.prefetch_heads(signals[j + kHeadsAhead]);
        if (out_of_cache && j + kVerticesAhead < end) search.prefetch_vertices(signals[j + kVerticesAhead]);
        winners_[static_cast<std::size_t>(j)] = search.winner(signals[j]);
    }
    sort_by_valence(begin, end, network, scratch.order);
    const int* const order = scratch.order.data();
    const auto valence = [&](int j) { return network.ring(winner(j)).valence; };
    for (int from = 0; from < end - begin;) {
        int to = from + 1;
        while (to < std::min(from + Patches::kLanes, end - begin) &&
               valence(order[to]) == valence(order[from]))
            ++to;
        for (int next = to; out_of_cache && next < std::min(to + Patches::kLanes, end - begin); ++next)
            prefetch_ring_of(network, winner(order[next]));
        step_group(signals, order + from, to - from, rates, network, scratch.patches);
        from = to;
    }
}

/// The signals [begin, end) into \p order, by the valence of their winners.
void BasicSteps::sort_by_valence(int begin, int end, const Network& network, std::vector<int>& order) const {
    std::array<int, Ring::kMaxValence + 2> place{};
    for (int j = begin; j < end; ++j) ++place[static_cast<std::size_t>(network.ring(winner(j)).valence) + 1];
    for (std::size_t k = 1; k < place.size(); ++k) place[k] += place[k - 1];
    for (int j = begin; j < end; ++j)
        order[static_cast<std::size_t>(place[network.ring(winner(j)).valence]++)] = j;
}

void BasicSteps::step_group(const vcg::Point3f* signals, const int* group, int count, const StepRates& rates,
                            const Network& network, Patches& patches) {
    VertexId winners[Patches::kLanes];
    vcg::Point3f towards[Patches::kLanes];
    Four* moved[Patches::kLanes];
    for (int lane = 0; lane < Patches::kLanes; ++lane) {
        const int j = group[lane < count ? lane : 0];
        winners[lane] = winner(j);
        towards[lane] = signals[j];
        moved[lane] = &displacements_[static_cast<std::size_t>(j) * kStride];
    }
    EightVectors n;
    EightVectors n_after;
    patches.gather(network, winners, count);
    patches.take_normals(n);
    patches.move_winners(towards, rates.learning);
    patches.smooth(rates.sweeps, rates.smoothing);
    patches.take_normals(n_after);
    patches.displacements(moved);
    for (int lane = 0; lane < count; ++lane) {
        const auto j = static_cast<std::size_t>(group[lane]);
        // 1 - n.n', written so that it keeps its digits where the normals are nearly equal.
        const float x = n_after.x[lane] - n.x[lane];
        const float y = n_after.y[lane] - n.y[lane];
        const float z = n_after.z[lane] - n.z[lane];
        deltas_[j] = 0.5F * (x * x + y * y + z * z);
    }
}

void BasicSteps::apply(int count, const Network& network, WinnerSearch& search) const {
    for (int j = 0; j < count; ++j) {
        const Four* moved = &displacements_[static_cast<std::size_t>(j) * kStride];
        const VertexId w = winner(j);
        const Ring& ring = network.ring(w);
        const auto move = [&](VertexId v, Four by) { search.move(v, load_xyz(&network.slots()[v]) + by); };
        move(w, moved[0]);
        for (int i = 0; i < ring.valence; ++i) move(ring[i], moved[1 + i]);
    }
}

}  // namespace neuralmesh
