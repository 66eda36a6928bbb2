// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Winners, groups of eight of one valence, and the sum of what they move, region by region.
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

/// Whether all that a step of this winner moves is of one region.
bool lies_in(const Network& network, VertexId winner, int region) {
    const Ring& ring = network.ring(winner);
    int others = ring.region ^ region;
    for (int i = 0; i < ring.valence; ++i) others |= network.ring(ring[i]).region ^ region;
    return others == 0;
}

}  // namespace

bool Pace::together() const { return batch_ < 2 * kTrial ? batch_ < kTrial : together_ < alone_; }

void Pace::took(double nanoseconds) {
    if (batch_ < 2 * kTrial && batch_ % kTrial >= kWarming) (together() ? together_ : alone_) += nanoseconds;
    if (++batch_ == kBetweenTrials) *this = Pace();
}

BasicSteps::BasicSteps(int threads, const std::vector<vcg::Point3f>& typical)
    : team_(thread_count(threads)), slabs_(typical), parts_(static_cast<std::size_t>(team_.members())) {}

void BasicSteps::make_room(int count) {
    const auto size = static_cast<std::size_t>(count);
    if (winners_.size() >= size) return;
    winners_.resize(size);
    deltas_.resize(size);
    for (Part& part : parts_) {
        // All signals of a batch may be of one region.
        part.signals.resize(size);
        part.winners.resize(size);
        part.deltas.resize(size);
        part.displacements.resize(size * kStride);
        part.order.resize(size);
        part.inside.resize(size);
        part.across.reserve(size);
    }
}

/// How many regions the batch is worth; sees to it that every vertex has one.
int BasicSteps::regions_for(int count, Network& network, WinnerSearch& search) {
    const int most = std::clamp(count / kLeastPerThread, 1, team_.members());
    if (most == 1) return 1;
    const bool too_few = most > slabs_.count();
    if (too_few) {
        slabs_.cut(most);
        const Slabs::Range half = slabs_.range(most / 2);
        search.divide(half.axis, half.begin);
    }
    if (too_few || !assigned_) {
        assigned_ = true;
        pace_ = Pace();
        for (VertexId v = 0; v < network.slot_count(); ++v)
            if (network.alive(v)) network.set_region(v, slabs_.of(network.position(v)));
    }
    return slabs_.count();
}

void BasicSteps::take(const vcg::Point3f* signals, int count, const StepRates& rates, Network& network,
                      WinnerSearch& search) {
    make_room(count);
    count_ = count;
    const int most = regions_for(count, network, search);
    regions_ = most > 1 && pace_.together() ? most : 1;
    const auto begin = std::chrono::steady_clock::now();
    const Batch batch{signals, count, regions_, rates, network, search};
    team_.run(regions_, [&](int, int region) { compute(batch, region); });
    hand_over(batch);
    team_.run(regions_, [&](int, int region) { apply(batch, region); });
    collect(batch);
    // With the application, which pays for what another core has to be asked for.
    const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - begin;
    if (most > 1) pace_.took(taken.count() / count);
}

void BasicSteps::compute(const Batch& batch, int region) {
    Part& part = part_of(region);
    take_signals(batch, region);
    // What another thread has moved is in the cache of its core.
    const bool out_of_cache = batch.regions > 1 || batch.network.vertex_count() >= kLeastOutOfCache;
    find_winners(batch, out_of_cache, part);
    sort_by_valence(batch.network, part);
    const int count = static_cast<int>(part.signals.size());
    const int* const order = part.order.data();
    const auto winner_of = [&](int k) { return part.winners[static_cast<std::size_t>(k)]; };
    const auto valence = [&](int k) { return batch.network.ring(winner_of(k)).valence; };
    part.moves = 0;
    for (int from = 0; from < count;) {
        int to = from + 1;
        while (to < std::min(from + Patches::kLanes, count) && valence(order[to]) == valence(order[from]))
            ++to;
        for (int next = to; out_of_cache && next < std::min(to + Patches::kLanes, count); ++next)
            prefetch_ring_of(batch.network, winner_of(order[next]));
        step_group(batch, region, order + from, to - from);
        from = to;
    }
    part.across.clear();
    for (int k = 0; batch.regions > 1 && k < count; ++k)
        if (part.inside[static_cast<std::size_t>(k)] == 0) part.across.push_back(k);
}

void BasicSteps::find_winners(const Batch& batch, bool out_of_cache, Part& part) {
    const WinnerSearch& search = batch.search;
    const int count = static_cast<int>(part.signals.size());
    const auto signal = [&](int k) { return batch.signals[part.signals[static_cast<std::size_t>(k)]]; };
    for (int k = 0; k < count; ++k) {
        if (k + kHeadsAhead < count) search.prefetch_heads(signal(k + kHeadsAhead));
        if (out_of_cache && k + kVerticesAhead < count) search.prefetch_vertices(signal(k + kVerticesAhead));
        part.winners[static_cast<std::size_t>(k)] = search.winner(signal(k));
    }
}

/// Those that lie in the region, without a branch for where each one lies.
void BasicSteps::take_signals(const Batch& batch, int region) {
    Part& part = part_of(region);
    part.signals.resize(static_cast<std::size_t>(batch.count));
    if (batch.regions == 1) {
        std::iota(part.signals.begin(), part.signals.end(), 0);
        return;
    }
    std::size_t taken = 0;
    int* const to = part.signals.data();
    const Slabs::Range range = slabs_.range(region);
    for (int j = 0; j < batch.count; ++j) {
        to[taken] = j;
        taken += range.holds(batch.signals[j]) ? 1 : 0;
    }
    part.signals.resize(taken);
}

/// The steps of \p part by the valence of their winners.
void BasicSteps::sort_by_valence(const Network& network, Part& part) {
    std::array<int, Ring::kMaxValence + 2> place{};
    const std::size_t count = part.signals.size();
    for (std::size_t k = 0; k < count; ++k)
        ++place[static_cast<std::size_t>(network.ring(part.winners[k]).valence) + 1];
    for (std::size_t v = 1; v < place.size(); ++v) place[v] += place[v - 1];
    for (std::size_t k = 0; k < count; ++k)
        part.order[static_cast<std::size_t>(place[network.ring(part.winners[k]).valence]++)] =
            static_cast<int>(k);
}

void BasicSteps::step_group(const Batch& batch, int region, const int* group, int count) {
    Part& part = part_of(region);
    VertexId winners[Patches::kLanes];
    vcg::Point3f towards[Patches::kLanes];
    Four* moved[Patches::kLanes];
    for (int lane = 0; lane < Patches::kLanes; ++lane) {
        const auto k = static_cast<std::size_t>(group[lane < count ? lane : 0]);
        winners[lane] = part.winners[k];
        towards[lane] = batch.signals[part.signals[k]];
        moved[lane] = &part.displacements[k * kStride];
    }
    EightVectors n;
    EightVectors n_after;
    part.patches.gather(batch.network, winners, count);
    part.patches.take_normals(n);
    part.patches.move_winners(towards, batch.rates.learning);
    part.patches.smooth(batch.rates.sweeps, batch.rates.smoothing);
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
        if (batch.regions > 1) part.inside[k] = lies_in(batch.network, winners[lane], region) ? 1 : 0;
    }
}

/// Tells every region which steps of the others may concern it, and makes room for what apply() notes down.
void BasicSteps::hand_over(const Batch& batch) {
    std::size_t moves = 0;
    for (int r = 0; r < batch.regions; ++r) moves += static_cast<std::size_t>(part_of(r).moves);
    for (int r = 0; r < batch.regions; ++r) {
        Part& part = part_of(r);
        part.crossings.clear();
        part.crossings.reserve(moves);
        part.from_others.clear();
        for (int other = 0; other < batch.regions; ++other) {
            if (other == r) continue;
            const Part& from = part_of(other);
            for (const int k : from.across)
                part.from_others.push_back({from.signals[static_cast<std::size_t>(k)], other, k});
        }
        if (batch.regions > 2)
            std::sort(part.from_others.begin(), part.from_others.end(),
                      [](const Step& a, const Step& b) { return a.signal < b.signal; });
    }
}

/// Moves the vertices of the region, each by the displacements in the order of their signals.
void BasicSteps::apply(const Batch& batch, int region) {
    const Network& network = batch.network;
    Part& own = part_of(region);
    const auto move = [&](VertexId v, Four by) {
        batch.search.move(v, load_xyz(&network.slots()[v]) + by, own.crossings);
    };
    const auto step = [&](const Part& part, int index, bool all) {
        const auto k = static_cast<std::size_t>(index);
        const Four* moved = &part.displacements[k * kStride];
        const Ring& ring = network.ring(part.winners[k]);
        if (all || ring.region == region) move(part.winners[k], moved[0]);
        for (int i = 0; i < ring.valence; ++i)
            if (all || network.ring(ring[i]).region == region) move(ring[i], moved[1 + i]);
    };
    auto other = own.from_others.begin();
    const auto others_until = [&](int signal) {
        for (; other != own.from_others.end() && other->signal < signal; ++other)
            step(part_of(other->region), other->index, false);
    };
    const int count = static_cast<int>(own.signals.size());
    for (int k = 0; k < count; ++k) {
        others_until(own.signals[static_cast<std::size_t>(k)]);
        step(own, k, batch.regions == 1 || own.inside[static_cast<std::size_t>(k)] != 0);
    }
    others_until(batch.count);
}

/// What the regions have found, in the order of the signals, and the grid brought up to date.
void BasicSteps::collect(const Batch& batch) {
    for (int r = 0; r < batch.regions; ++r) {
        const Part& part = part_of(r);
        for (std::size_t k = 0; k < part.signals.size(); ++k) {
            const auto j = static_cast<std::size_t>(part.signals[k]);
            winners_[j] = part.winners[k];
            deltas_[j] = part.deltas[k];
        }
        // In any order: which vertex is nearest does not depend on it.
        batch.search.follow(part.crossings);
    }
}

}  // namespace neuralmesh
