// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Winners, groups of eight of one valence, and the sum of what they move, slab by slab.
#include "vcg_core/engine/basic_step_batch.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <numeric>

namespace neuralmesh {

namespace {

/// Fewer signals than this are not worth a second thread.
constexpr int kLeastPerThread = 48;
/// Batches of each kind in a trial, of these at first those that only fill the other core's cache, and
/// batches from one trial to the next.
constexpr int kTrial = 24;
constexpr int kWarming = 8;
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

/// Whether all that a step of this winner moves is of one slab.
bool lies_in(const Network& network, VertexId winner, int slab) {
    const Ring& ring = network.ring(winner);
    int others = ring.tag ^ slab;
    for (int i = 0; i < ring.valence; ++i) others |= network.ring(ring[i]).tag ^ slab;
    return others == 0;
}

}  // namespace

bool ThreadTiming::together() const { return batch_ < 2 * kTrial ? batch_ < kTrial : together_ < alone_; }

void ThreadTiming::took(double nanoseconds) {
    if (batch_ < 2 * kTrial && batch_ % kTrial >= kWarming) (together() ? together_ : alone_) += nanoseconds;
    if (++batch_ == kBetweenTrials) *this = ThreadTiming();
}

BasicStepBatch::BasicStepBatch(int threads, const std::vector<vcg::Point3f>& typical)
    : team_(thread_count(threads)), partition_(typical), parts_(static_cast<std::size_t>(team_.members())) {}

void BasicStepBatch::make_room(int count) {
    const auto size = static_cast<std::size_t>(count);
    if (winners_.size() >= size) return;
    winners_.resize(size);
    deltas_.resize(size);
    for (Part& part : parts_) {
        // All signals of a batch may be of one slab.
        part.signals.resize(size);
        part.winners.resize(size);
        part.deltas.resize(size);
        part.displacements.resize(size * kStride);
        part.order.resize(size);
        part.inside.resize(size);
        part.across.reserve(size);
    }
}

/// How many slabs the batch is worth; sees to it that every vertex has one.
int BasicStepBatch::slabs_for(int count, Network& network, WinnerSearch& search) {
    const int most = std::clamp(count / kLeastPerThread, 1, team_.members());
    if (most == 1) return 1;
    const bool too_few = most > partition_.count();
    if (too_few) {
        partition_.split(most);
        const AxisPartition::Range half = partition_.range(most / 2);
        search.split_table(half.axis, half.begin);
    }
    if (too_few || !assigned_) {
        assigned_ = true;
        pace_ = ThreadTiming();
        for (VertexId v = 0; v < network.slot_count(); ++v)
            if (network.alive(v)) network.set_tag(v, partition_.of(network.position(v)));
    }
    return partition_.count();
}

void BasicStepBatch::take(const vcg::Point3f* signals, int count, const StepRates& rates, Network& network,
                          WinnerSearch& search) {
    make_room(count);
    count_ = count;
    const int most = slabs_for(count, network, search);
    slab_count_ = most > 1 && pace_.together() ? most : 1;
    const auto begin = std::chrono::steady_clock::now();
    const Batch batch{signals, count, slab_count_, rates, network, search};
    team_.parallel(slab_count_, [&](int, int slab) { compute(batch, slab); });
    hand_over(batch);
    team_.parallel(slab_count_, [&](int, int slab) { apply(batch, slab); });
    collect(batch);
    // With the application, which pays for what another core has to be asked for.
    const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - begin;
    if (most > 1) pace_.took(taken.count() / count);
}

void BasicStepBatch::compute(const Batch& batch, int slab) {
    Part& part = part_of(slab);
    take_signals(batch, slab);
    // What another thread has moved is in the cache of its core.
    const bool out_of_cache = batch.slabs > 1 || batch.network.vertex_count() >= kLeastOutOfCache;
    find_winners(batch, out_of_cache, part);
    sort_by_valence(batch.network, part);
    const int count = static_cast<int>(part.signals.size());
    const int* const order = part.order.data();
    const auto winner_of = [&](int k) { return part.winners[static_cast<std::size_t>(k)]; };
    const auto valence = [&](int k) { return batch.network.ring(winner_of(k)).valence; };
    part.moves = 0;
    for (int from = 0; from < count;) {
        int to = from + 1;
        while (to < std::min(from + EightSteps::kLanes, count) && valence(order[to]) == valence(order[from]))
            ++to;
        for (int next = to; out_of_cache && next < std::min(to + EightSteps::kLanes, count); ++next)
            prefetch_ring_of(batch.network, winner_of(order[next]));
        step_group(batch, slab, order + from, to - from);
        from = to;
    }
    part.across.clear();
    for (int k = 0; batch.slabs > 1 && k < count; ++k)
        if (part.inside[static_cast<std::size_t>(k)] == 0) part.across.push_back(k);
}

void BasicStepBatch::find_winners(const Batch& batch, bool out_of_cache, Part& part) {
    const WinnerSearch& search = batch.search;
    const int count = static_cast<int>(part.signals.size());
    const auto signal = [&](int k) { return batch.signals[part.signals[static_cast<std::size_t>(k)]]; };
    for (int k = 0; k < count; ++k) {
        if (k + kHeadsAhead < count) search.prefetch_heads(signal(k + kHeadsAhead));
        if (out_of_cache && k + kVerticesAhead < count) search.prefetch_vertices(signal(k + kVerticesAhead));
        part.winners[static_cast<std::size_t>(k)] = search.winner(signal(k));
    }
}

/// Those that lie in the slab, without a branch for where each one lies.
void BasicStepBatch::take_signals(const Batch& batch, int slab) {
    Part& part = part_of(slab);
    part.signals.resize(static_cast<std::size_t>(batch.count));
    if (batch.slabs == 1) {
        std::iota(part.signals.begin(), part.signals.end(), 0);
        return;
    }
    std::size_t taken = 0;
    int* const to = part.signals.data();
    const AxisPartition::Range range = partition_.range(slab);
    for (int j = 0; j < batch.count; ++j) {
        to[taken] = j;
        taken += range.holds(batch.signals[j]) ? 1 : 0;
    }
    part.signals.resize(taken);
}

/// The steps of \p part by the valence of their winners.
void BasicStepBatch::sort_by_valence(const Network& network, Part& part) {
    std::array<int, Ring::kMaxValence + 2> place{};
    const std::size_t count = part.signals.size();
    for (std::size_t k = 0; k < count; ++k)
        ++place[static_cast<std::size_t>(network.ring(part.winners[k]).valence) + 1];
    for (std::size_t v = 1; v < place.size(); ++v) place[v] += place[v - 1];
    for (std::size_t k = 0; k < count; ++k)
        part.order[static_cast<std::size_t>(place[network.ring(part.winners[k]).valence]++)] =
            static_cast<int>(k);
}

void BasicStepBatch::step_group(const Batch& batch, int slab, const int* group, int count) {
    Part& part = part_of(slab);
    VertexId winners[EightSteps::kLanes];
    vcg::Point3f towards[EightSteps::kLanes];
    Four* moved[EightSteps::kLanes];
    for (int lane = 0; lane < EightSteps::kLanes; ++lane) {
        const auto k = static_cast<std::size_t>(group[lane < count ? lane : 0]);
        winners[lane] = part.winners[k];
        towards[lane] = batch.signals[part.signals[k]];
        moved[lane] = &part.displacements[k * kStride];
    }
    EightVectors n;
    EightVectors n_after;
    part.patches.gather(batch.network, winners, count);
    part.patches.take_normals(n);
    part.patches.move_winners(towards, batch.rates.learning_rate);
    part.patches.smooth(batch.rates.smoothing_steps, batch.rates.smoothing_rate);
    part.patches.take_normals(n_after);
    part.patches.displacements(moved);
    part.moves += count * (1 + part.patches.valence());
    for (int lane = 0; lane < count; ++lane) {
        const auto k = static_cast<std::size_t>(group[lane]);
        // 1 - n.n', written so that it keeps its digits where the normals are nearly equal.
        const float x = n_after.x[lane] - n.x[lane];
        const float y = n_after.y[lane] - n.y[lane];
        const float z = n_after.z[lane] - n.z[lane];
        part.deltas[k] = 0.5F * (x * x + y * y + z * z);
        if (batch.slabs > 1) part.inside[k] = lies_in(batch.network, winners[lane], slab) ? 1 : 0;
    }
}

/// Tells every slab which steps of the others may concern it, and makes room for what apply() notes down.
void BasicStepBatch::hand_over(const Batch& batch) {
    std::size_t moves = 0;
    for (int r = 0; r < batch.slabs; ++r) moves += static_cast<std::size_t>(part_of(r).moves);
    for (int r = 0; r < batch.slabs; ++r) {
        Part& part = part_of(r);
        part.cell_changes.clear();
        part.cell_changes.reserve(moves);
        part.from_others.clear();
        for (int other = 0; other < batch.slabs; ++other) {
            if (other == r) continue;
            const Part& from = part_of(other);
            for (const int k : from.across)
                part.from_others.push_back({from.signals[static_cast<std::size_t>(k)], other, k});
        }
        if (batch.slabs > 2)
            std::sort(part.from_others.begin(), part.from_others.end(),
                      [](const Step& a, const Step& b) { return a.signal < b.signal; });
    }
}

/// Moves the vertices of the slab, each by the displacements in the order of their signals.
void BasicStepBatch::apply(const Batch& batch, int slab) {
    const Network& network = batch.network;
    Part& own = part_of(slab);
    const auto move = [&](VertexId v, Four by) {
        batch.search.move(v, load_xyz(&network.slots()[v]) + by, own.cell_changes);
    };
    const auto step = [&](const Part& part, int index, bool all) {
        const auto k = static_cast<std::size_t>(index);
        const Four* moved = &part.displacements[k * kStride];
        const Ring& ring = network.ring(part.winners[k]);
        if (all || ring.tag == slab) move(part.winners[k], moved[0]);
        for (int i = 0; i < ring.valence; ++i)
            if (all || network.ring(ring[i]).tag == slab) move(ring[i], moved[1 + i]);
    };
    auto other = own.from_others.begin();
    const auto others_until = [&](int signal) {
        for (; other != own.from_others.end() && other->signal < signal; ++other)
            step(part_of(other->slab), other->index, false);
    };
    const int count = static_cast<int>(own.signals.size());
    for (int k = 0; k < count; ++k) {
        others_until(own.signals[static_cast<std::size_t>(k)]);
        step(own, k, batch.slabs == 1 || own.inside[static_cast<std::size_t>(k)] != 0);
    }
    others_until(batch.count);
}

/// What the slabs have found, in the order of the signals, and the grid brought up to date.
void BasicStepBatch::collect(const Batch& batch) {
    for (int r = 0; r < batch.slabs; ++r) {
        const Part& part = part_of(r);
        for (std::size_t k = 0; k < part.signals.size(); ++k) {
            const auto j = static_cast<std::size_t>(part.signals[k]);
            winners_[j] = part.winners[k];
            deltas_[j] = part.deltas[k];
        }
        // In any order: which vertex is nearest does not depend on it.
        batch.search.follow(part.cell_changes);
    }
}

}  // namespace neuralmesh
