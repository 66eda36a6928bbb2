// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The learning algorithm of the paper's section 2: Basic Step, Vertex Split, Half-Edge Collapse, stop.
#pragma once

#include <vcg/space/point3.h>

#include <cstdint>
#include <vector>

#include "vcg_core/base/progress.h"
#include "vcg_core/base/random.h"
#include "vcg_core/cloud/target_space.h"
#include "vcg_core/engine/basic_step_batch.h"
#include "vcg_core/engine/batch_limit.h"
#include "vcg_core/learning/crease_measure.h"
#include "vcg_core/learning/growth_schedule.h"
#include "vcg_core/learning/learner_options.h"
#include "vcg_core/learning/learning_state.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// A network that learns a target space. Each step of the paper is a public member; run() calls them in the
/// paper's order.
class Learner {
public:
    /// Starts from the network \p start. Keeps a reference to \p target.
    /// \throws SettingError if \p start has more than options.grow_to vertices
    Learner(const TargetSpace& target, const LearnerOptions& options, Network start);

    Learner(const Learner&) = delete;
    Learner& operator=(const Learner&) = delete;

    /// Settles the start mesh for \p landing_signals signals per vertex, grows it to options.grow_to vertices
    /// and settles it again for options.settling_signals_per_vertex. Ends early if the normals turn less than
    /// options.stop_below_turn, if \p progress asks to stop, or if growth reaches signal_bound(). The network
    /// is valid whatever the reason.
    StopReason run(int landing_signals, Progress& progress);

    /// Basic Step for a batch of \p count signals (1 to BasicStepBatch::kMostSignals): moves winners and
    /// their rings. All steps of a batch start from the same network state; a batch of one is the paper's
    /// step. \return for each signal its winner and delta, until the next call. Pass each to
    /// learn_counters(), in order. O(count) expected.
    const std::vector<StepResult>& basic_steps(const vcg::Point3f* signals, int count);
    /// Updates all counters by one signal. Amortised O(1).
    void learn_counters(const StepResult& step);
    /// Basic Step and counters of one signal.
    void basic_step(const vcg::Point3f& s) { learn_counters(basic_steps(&s, 1).front()); }
    /// Number of signals in a batch of run(): vertices / kVerticesPerSignal, or fewer while the steps of a
    /// batch overlap. 1 if options.min_wins_per_split is 0, or the rates of the steps are too high to add
    /// them up.
    int batch_size() const;
    static constexpr int kVerticesPerSignal = 32;  ///< so many that the steps of a batch rarely overlap
    /// Vertex Split, see connectivity_steps.h. False if the network has options.grow_to vertices already, or
    /// if no vertex can be split. O(log n).
    bool vertex_split();
    /// Half-Edge Collapse of all vertices that have been inactive since its last call, see
    /// connectivity_steps.h. Before, mends the faces along boundaries, see boundary_faces.h. \return the
    /// number of inactive vertices removed. O(n).
    int half_edge_collapse();
    /// Takes membranes out of the network, see topology/learned_topology.h, in rounds until none gains any
    /// more, four at most, and if this is the \p last time opens those that LearnerOptions::topology_rules
    /// allow. Does nothing if the network has a boundary. \return false if \p progress asked to stop.
    /// O(signals x log n)
    bool learn_topology(bool last, Progress& progress);
    /// Learns settling_signals(per_vertex, vertices) signals without splits and collapses, so that counters
    /// describe the final connectivity. In the end mends faces along boundaries, which keeps all vertices.
    /// \param observe false: no crease measure. It needs fixed connectivity, so pass false before growth.
    /// \return false if \p progress, which gets the share of the signals done, asked to stop
    bool settle(int per_vertex, Progress& progress, bool observe = true);
    /// The same for \p count signals, without mending.
    bool learn_at_rest(std::int64_t count, Progress& progress, bool observe = true);
    /// Moves every vertex to its place in \p places, and keeps all counters. O(vertices).
    void move_to(const PerVertex<vcg::Point3f>& places);

    const Network& network() const { return state_.network; }
    const UtilityCounters& utility_counters() const { return state_.utility_counters; }
    const FeatureCounters& feature_counters() const { return state_.feature_counters; }
    /// Observed by the last settle(); without moments if that did not observe.
    const CreaseMeasure& crease_measure() const { return crease_measure_; }
    std::int64_t signals() const { return state_.signals; }
    std::int64_t splits() const { return state_.splits; }
    std::int64_t collapses() const { return state_.collapses; }
    /// Mean angle, in degrees, by which a Basic Step turns the winner's normal: see NormalTurn.
    double mean_turn() const { return normal_turn_.degrees(); }
    /// run() learns at most this many signals while it grows: see growth_schedule.h.
    std::int64_t signal_bound() const { return neuralmesh::signal_bound(state_.options); }
    /// Changes of the topology while it grew.
    int topology_changes() const { return topology_changes_; }
    /// True if growth had to be forced: see growth_budget().
    bool forced() const { return forced_; }

private:
    void keep_boundary_signals(const std::vector<StepResult>& steps, const vcg::Point3f* signals);
    template <class AfterSignal>
    void learn_batch(int count, const AfterSignal& after_signal);
    /// The paper's loop: signals, splits and collapses until there are options.grow_to vertices.
    StopReason grow(Progress& progress);
    /// From now on every C_vs signals add a vertex: see growth_budget().
    void force_growth();
    /// After collapses: the noise of the points lets the network grow no more.
    bool is_saturated();
    bool report_due();
    bool report(const char* doing, double fraction, Progress& progress) const;

    const TargetSpace& target_;
    LearningState state_;
    const StepRates rates_;
    WindowMean mean_delta_;
    NormalTurn normal_turn_;
    CreaseMeasure crease_measure_;
    GrowthSchedule schedule_;
    bool forced_ = false;
    bool mends_notches_ = false;  ///< needs the signals that boundary vertices win

    Random random_;                    ///< of the signals
    std::vector<vcg::Point3f> drawn_;  ///< those of the last batch
    BasicStepBatch batch_;
    BatchLimit batch_limit_;
    Saturation saturation_;
    std::int64_t last_report_ = 0;
    Random topology_random_;
    int topology_changes_ = 0;
};

}  // namespace neuralmesh
