// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The network with everything that learning stores per vertex.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "vcg_core/engine/winner_search.h"
#include "vcg_core/learning/activity.h"
#include "vcg_core/learning/feature_counter.h"
#include "vcg_core/learning/learner_options.h"
#include "vcg_core/learning/utility_counter.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

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
    /// Network::renumber().
    void renumber(const std::vector<VertexId>& order);

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
};

}  // namespace neuralmesh
