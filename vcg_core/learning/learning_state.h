// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The network with everything that learning stores per vertex.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "vcg_core/engine/basic_step_batch.h"
#include "vcg_core/engine/batch_limit.h"
#include "vcg_core/engine/winner_search.h"
#include "vcg_core/learning/counters.h"
#include "vcg_core/learning/learner_options.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// The number of the signal that each vertex won last, or after which it was born.
class Activity {
public:
    void resize(int slots) { last_active_.resize(slots, 0); }

    /// Records the winners of a batch that starts after \p begin signals, and lets \p limit know which of
    /// them won repeatedly. O(1) per step, O(valence) per repeated winner.
    void record(const std::vector<StepResult>& steps, std::int64_t begin, const Network& network,
                BatchLimit& limit) {
        const auto count = static_cast<int>(steps.size());
        const auto winner = [&](int i) { return steps[static_cast<std::size_t>(i)].winner; };
        for (int i = 0; i < count; ++i) {
            prefetch_for_write(&last_active_[winner(std::min(i + kAhead, count - 1))]);
            std::int64_t& last_active = last_active_[winner(i)];
            if (last_active > begin) limit.repeated(winner(i));
            last_active = begin + i + 1;
        }
        const std::vector<VertexId>& repeated = limit.repeated_winners();
        const auto is_crowded = [&](VertexId v) {
            return active_neighbours(network, v, begin) >= BatchLimit::kCrowd;
        };
        limit.end_batch(count, static_cast<int>(std::count_if(repeated.begin(), repeated.end(), is_crowded)));
    }
    void set(VertexId v, std::int64_t signal) { last_active_[v] = signal; }
    bool active_since(VertexId v, std::int64_t signal) const { return last_active_[v] > signal; }
    /// As UtilityCounters::renumber().
    void renumber(const std::vector<VertexId>& order) {
        last_active_ = permuted(last_active_, order, std::int64_t{0});
    }

private:
    int active_neighbours(const Network& network, VertexId v, std::int64_t signal) const {
        const Ring& ring = network.ring(v);
        return static_cast<int>(
            std::count_if(ring.begin(), ring.end(), [&](VertexId u) { return active_since(u, signal); }));
    }

    static constexpr int kAhead = 8;  ///< steps between the prefetch and the use of an entry

    PerVertex<std::int64_t> last_active_;
};

/// The signals that boundary vertices have won, by their winners: they tell a notch in the boundary from an
/// opening of the cloud.
class BoundarySignals {
public:
    void add(VertexId winner, const vcg::Point3f& signal) {
        won_.emplace_back(winner, signal);
        sorted_ = false;
    }
    void clear() { won_.clear(); }

    /// Whether \p accepts any signal that \p winner has won. O(log n), and O(n log n) after signals were
    /// added.
    template <class Accepts>
    bool any_of(VertexId winner, const Accepts& accepts) {
        const auto earlier = [](const Won& a, const Won& b) { return a.first < b.first; };
        if (!sorted_) std::stable_sort(won_.begin(), won_.end(), earlier);
        sorted_ = true;
        const auto range = std::equal_range(won_.begin(), won_.end(), Won(winner, {}), earlier);
        return std::any_of(range.first, range.second, [&](const Won& won) { return accepts(won.second); });
    }

private:
    using Won = std::pair<VertexId, vcg::Point3f>;
    std::vector<Won> won_;
    bool sorted_ = true;
};

/// What the steps of the paper read and change. Change the connectivity only through the members below: they
/// keep the winner search and the counters consistent with the network.
struct LearningState {
    LearningState(const LearnerOptions& the_options, Network start);
    LearningState(const LearningState&) = delete;
    LearningState& operator=(const LearningState&) = delete;

    /// Network::split(). Both vertices share the utility counter (see eq 5); the new one inherits the feature
    /// counter.
    VertexId split(VertexId v, int first, int count, const vcg::Point3f& where);
    /// Network::collapse().
    void collapse(VertexId gone, VertexId kept);
    /// Network::exchange_faces(). The vertices that stay keep their counters. \return false, with nothing
    /// changed, if the network cannot
    bool exchange_faces(const std::vector<Triangle>& gone, const std::vector<Triangle>& added);
    /// Flips edges of \p v where that brings valences closer to 6 and hardly changes the surface. Does
    /// nothing to the letter of the paper.
    void regularise(VertexId v);
    /// Keeps vertices that are near in space near in memory: renumbers them along a space-filling curve
    /// whenever the network has grown by a quarter, and leaves free ids between them for new ones. The
    /// vertices that a Basic Step visits then share cache lines and pages, and those that different threads
    /// visit do not. Results change only where they depend on the order of ids, as ties and the order of
    /// collapses do. Small networks fit into the cache and keep their order. O(n log n) then, O(1) otherwise.
    void reorder_while_growing();
    /// The same, without free ids, if there were splits or collapses since the last time: for a long phase
    /// without them. O(n log n).
    void reorder_at_rest();

    /// True if options switch off all that the paper does not have: maturity, batches, edge flips.
    bool to_the_letter() const { return options.min_wins_per_split == 0; }

    const LearnerOptions options;
    Network network;
    WinnerSearch search;
    UtilityCounters utility_counters;
    FeatureCounters feature_counters;
    Activity activity;
    BoundarySignals boundary_signals;  ///< won since the boundaries were last mended
    std::int64_t signals = 0;          ///< learned so far
    std::int64_t splits = 0;
    std::int64_t collapses = 0;
    std::int64_t splits_refused = 0;  ///< because the points carry no shorter edges

private:
    void reorder(int free_ids);

    int ordered_vertices_ = 0;           ///< when last renumbered
    std::int64_t ordered_changes_ = -1;  ///< splits and collapses when last renumbered
};

}  // namespace neuralmesh
