// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The network with everything that learning stores per vertex.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "vcg_core/engine/basic_step_batch.h"
#include "vcg_core/engine/batch_limit.h"
#include "vcg_core/engine/winner_search.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/paper/constants.h"
#include "vcg_core/paper/counters.h"

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

/// What the steps of the paper read and change. Change the connectivity only through the members below: they
/// keep the winner search and the counters consistent with the network.
struct LearningState {
    LearningState(const GrowthOptions& the_options, Network start);
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
    /// As UtilityCounters::renumber(), for everything.
    void renumber(const std::vector<VertexId>& order);

    /// True if options switch off all that the paper does not have: maturity, batches, edge flips.
    bool to_the_letter() const { return options.min_wins_per_split == 0; }

    const GrowthOptions options;
    Network network;
    WinnerSearch search;
    UtilityCounters utility_counters;
    FeatureCounters feature_counters;
    Activity activity;
    std::int64_t signals = 0;  ///< learned so far
    std::int64_t splits = 0;
    std::int64_t collapses = 0;
    std::int64_t splits_refused = 0;  ///< of vertices that may not be split
};

}  // namespace neuralmesh
