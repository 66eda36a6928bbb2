// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The learning algorithm of the paper's section 2: Basic Step, Vertex Split, Half-Edge Collapse, stop.
#pragma once

#include <cstdint>
#include <vector>

#include "vcg_core/base/progress.h"
#include "vcg_core/engine/basic_step_batch.h"
#include "vcg_core/engine/batch_limit.h"
#include "vcg_core/engine/winner_search.h"
#include "vcg_core/learning/crease_measure.h"
#include "vcg_core/learning/feature_counter.h"
#include "vcg_core/learning/normal_turn.h"
#include "vcg_core/learning/utility_counter.h"
#include "vcg_core/learning/window_mean.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/neural_mesh.h"
#include "vcg_core/settings.h"
#include "vcg_core/target/signal_stream.h"
#include "vcg_core/target/target_space.h"

namespace neuralmesh {

/// A network that learns a target space. Every step of the paper is a public member; run() is their order.
class Learner {
public:
    /// Starts from \p start. References to the arguments are kept.
    /// \throws SettingError if the start mesh has more than settings.target_vertices vertices
    Learner(const TargetSpace& target, const Settings& settings, Network start);

    Learner(const Learner&) = delete;
    Learner& operator=(const Learner&) = delete;

    /// Lets the start mesh learn \p per_vertex signals a vertex, then learns until the network has
    /// settings.target_vertices vertices and has settled, the mean counter falls below its bound (eq 8), \p
    /// progress asks to stop, or signal_bound() is reached.
    StopReason run(int per_vertex, Progress& progress);

    /// The winners of \p count signals (1 to BasicStepBatch::kMostSignals) move towards them and their rings
    /// are smoothed (eq 1), all from the network as it is; learn_counters() is to follow for each. O(count)
    /// expected.
    void basic_steps(const vcg::Point3f* signals, int count);
    /// What signal \p i of these steps does to the counters (eq 2 to 4, 6). Amortised O(1).
    void learn_counters(int i);
    /// One signal whole.
    void basic_step(const vcg::Point3f& s) {
        basic_steps(&s, 1);
        learn_counters(0);
    }
    /// Signals that run() takes from one state of the network: one for every kVerticesPerSignal vertices, so
    /// that they seldom meet, fewer where they do meet; one by one to the letter of the paper.
    int batch_size() const;
    static constexpr int kVerticesPerSignal = 32;
    /// Splits the mature vertex with the highest utility counter along its longest edge, halving its star;
    /// the twins share the counter (eq 5). False if the network has its target_vertices, if no vertex is
    /// mature, or if none of the 32 highest can be split. O(log n).
    bool vertex_split();
    /// Removes the vertices that existed but did not win since the last call, each along the edge whose
    /// collapse leaves the best valences. \return how many. O(n).
    int half_edge_collapse();
    /// \p per_vertex signals a vertex, and at least 60,000 unless that is 0, without change of connectivity,
    /// so that the counters speak of the final mesh. If settings.feature_measure asks for it, the feature
    /// statistic observes it, unless it is not \p to_be_observed, as what grows on will be of another
    /// connectivity. False if \p progress, which gets the share of the signals done, asked to stop.
    bool settle(int per_vertex, Progress& progress, bool to_be_observed = true);

    /// Learning is cut short after this many signals of growth. Growth that has not come to its target
    /// after growth_budget() signals is forced: no more collapses, no more maturity, so that every C_vs
    /// signals add a vertex. (It stalls where more vertices are asked for than the target space has places to
    /// win: a handful of points, say.) So growth ends; the bound leaves twice what forcing needs.
    std::int64_t growth_budget() const;
    std::int64_t signal_bound() const;
    /// True once growth had to be forced.
    bool forced() const { return forced_; }

    const Network& network() const { return network_; }
    const FeatureCounters& feature_counters() const { return feature_counters_; }
    const CreaseMeasure& crease_measure() const { return crease_measure_; }
    const UtilityCounters& utility_counters() const { return utility_counters_; }
    std::int64_t signals() const { return signals_; }
    std::int64_t splits() const { return splits_; }
    std::int64_t collapses() const { return collapses_; }
    /// By how much the winner's normal turns in one Basic Step, in degrees. This is what eq 8 stops at.
    double mean_turn() const { return turn_mean_.degrees(); }

private:
    struct Halving {
        int first;
        int count;
    };

    bool to_the_letter() const { return settings_.min_wins_per_split == 0; }
    void reorder_if_grown();
    void reorder(int more);
    bool due_for_report();
    bool report(const char* doing, double fraction, Progress& progress) const;
    static std::int64_t settling_signals(int per_vertex, int vertices);
    StopReason grow(Progress& progress);
    bool due_for_collapse() const;
    void force_growth();
    Halving halve_star(VertexId v, int longest) const;
    bool try_split(VertexId v);
    VertexId best_collapse(VertexId gone) const;
    void register_new(VertexId u, VertexId v);

    const Settings& settings_;
    Network network_;
    WinnerSearch search_;
    UtilityCounters utility_counters_;
    FeatureCounters feature_counters_;
    CreaseMeasure crease_measure_;
    WindowMean mean_delta_;
    NormalTurn turn_mean_;
    BasicStepBatch steps_;
    SignalStream drawn_;
    BatchLimit crowding_;
    /// Per vertex the signal of its last win, or of its birth.
    PerVertex<std::int64_t> last_active_;
    std::int64_t signals_ = 0;
    std::int64_t batch_begin_ = 0;
    std::int64_t batch_end_ = 0;
    std::int64_t splits_ = 0;
    std::int64_t collapses_ = 0;
    std::int64_t last_collapse_ = 0;
    std::int64_t last_report_ = 0;
    int vertices_at_collapse_ = 0;
    int vertices_in_order_ = 0;
    std::int64_t changes_in_order_ = -1;  ///< splits and collapses until then
    bool forced_ = false;
};

}  // namespace neuralmesh
