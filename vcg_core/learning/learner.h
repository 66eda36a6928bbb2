// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The whole of the learning: landing, growth as in paper/paper_learner.h, settling, and what the paper does
// not have: boundaries, changes of the topology, noise, growth that stalls.
#pragma once

#include <vcg/space/point3.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "vcg_core/learning/boundary_faces.h"
#include "vcg_core/learning/crease_measure.h"
#include "vcg_core/learning/growth_limits.h"
#include "vcg_core/learning/learner_options.h"
#include "vcg_core/learning/memory_order.h"
#include "vcg_core/paper/paper_learner.h"

namespace neuralmesh {

class Learner : public PaperLearner {
public:
    /// As PaperLearner.
    Learner(const TargetSpace& target, const LearnerOptions& options, Network start);

    /// Settles the start mesh for \p landing_signals signals per vertex, grows it to options.grow_to vertices
    /// and settles it again for options.settling_signals_per_vertex. Ends early as grow(), or if growth
    /// reaches signal_bound(). The network is valid whatever the reason.
    StopReason run(int landing_signals, Progress& progress);

    /// PaperLearner::half_edge_collapse(). Before, mends the faces along boundaries, see boundary_faces.h.
    int half_edge_collapse() override;
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

    /// Observed by the last settle(); without moments if that did not observe.
    const CreaseMeasure& crease_measure() const { return crease_measure_; }
    /// run() learns at most this many signals while it grows: see growth_limits.h.
    std::int64_t signal_bound() const { return neuralmesh::signal_bound(options_); }
    /// Changes of the topology while it grew.
    int topology_changes() const { return topology_changes_; }
    /// True if growth had to be forced: see growth_budget().
    bool forced() const { return schedule_.has_ended_collapses(); }

private:
    void look_at(const std::vector<StepResult>& steps, const vcg::Point3f* signals) override;
    bool may_split(VertexId v) const override;
    std::optional<StopReason> between_steps(bool collapsed, Progress& progress) override;
    StopReason begin_and_grow(Progress& progress);
    void look_for_notches();
    /// After collapses: the noise of the points lets the network grow no more.
    bool is_saturated();

    const LearnerOptions options_;
    CreaseMeasure crease_measure_;
    MemoryOrder memory_order_;
    BoundarySignals boundary_signals_;  ///< won since the boundaries were last mended
    bool mends_notches_ = false;        ///< needs the signals that boundary vertices win
    std::int64_t growth_begin_ = 0;     ///< in signals
    Saturation saturation_;
    std::optional<TopologyStages> topology_stages_;
    Random topology_random_;
    int topology_changes_ = 0;
};

}  // namespace neuralmesh
