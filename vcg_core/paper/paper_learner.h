// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Sections 2 and 3 of the paper: Basic Step, counters, Vertex Split, Half-Edge Collapse, and the loop that
// calls them. Begin to read here.
#pragma once

#include <vcg/space/point3.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "vcg_core/base/progress.h"
#include "vcg_core/base/random.h"
#include "vcg_core/cloud/target_space.h"
#include "vcg_core/engine/basic_step_batch.h"
#include "vcg_core/engine/batch_limit.h"
#include "vcg_core/paper/growth_schedule.h"
#include "vcg_core/paper/learning_state.h"

namespace neuralmesh {

/// A network that learns a target space as the paper says. What the paper does not have, a class derived from
/// this one does in the virtual members: they do nothing here.
class PaperLearner {
public:
    /// Starts from the network \p start. Keeps a reference to \p target.
    /// \throws SettingError if \p start has more than options.grow_to vertices
    PaperLearner(const TargetSpace& target, const GrowthOptions& options, Network start);
    virtual ~PaperLearner() = default;

    PaperLearner(const PaperLearner&) = delete;
    PaperLearner& operator=(const PaperLearner&) = delete;

    /// Signals, splits and collapses until there are options.grow_to vertices. Ends early if the normals turn
    /// less than options.stop_below_turn, if \p progress asks to stop, or if between_steps() says so. The
    /// network is valid whatever the reason.
    StopReason grow(Progress& progress);

    /// Basic Step for a batch of \p count signals (1 to BasicStepBatch::kMostSignals): moves winners and
    /// their rings. All steps of a batch start from the same network state; a batch of one is the paper's
    /// step. \return for each signal its winner and delta, until the next call. Pass each to
    /// learn_counters(), in order. O(count) expected.
    const std::vector<StepResult>& basic_steps(const vcg::Point3f* signals, int count);
    /// Updates all counters by one signal. Amortised O(1).
    void learn_counters(const StepResult& step);
    /// Basic Step and counters of one signal.
    void basic_step(const vcg::Point3f& s) { learn_counters(basic_steps(&s, 1).front()); }
    /// Number of signals in a batch of grow(): vertices / kVerticesPerSignal, or fewer while the steps of a
    /// batch overlap. 1 if options.min_wins_per_split is 0, or the rates of the steps are too high to add
    /// them up.
    int batch_size() const;
    static constexpr int kVerticesPerSignal = 32;  ///< so many that the steps of a batch rarely overlap
    /// Vertex Split, see connectivity_steps.h. False if the network has options.grow_to vertices already, or
    /// if no vertex can be split. O(log n).
    bool vertex_split();
    /// Half-Edge Collapse of all vertices that have been inactive since its last call, see
    /// connectivity_steps.h. \return the number of inactive vertices removed. O(n).
    virtual int half_edge_collapse();

    const Network& network() const { return state_.network; }
    const UtilityCounters& utility_counters() const { return state_.utility_counters; }
    const FeatureCounters& feature_counters() const { return state_.feature_counters; }
    std::int64_t signals() const { return state_.signals; }
    std::int64_t splits() const { return state_.splits; }
    std::int64_t collapses() const { return state_.collapses; }
    /// Mean angle, in degrees, by which a Basic Step turns the winner's normal: see NormalTurn.
    double mean_turn() const { return normal_turn_.degrees(); }

protected:
    /// After the Basic Steps of \p signals, before their counters.
    virtual void look_at(const std::vector<StepResult>& /*steps*/, const vcg::Point3f* /*signals*/) {}
    /// Whether \p v, which has the highest counter, may be split.
    virtual bool may_split(VertexId /*v*/) const { return true; }
    /// After the signals of each batch, their splits and collapses. \p collapsed: there were collapses. \p
    /// progress stands still. \return a reason to end growth, or nothing
    virtual std::optional<StopReason> between_steps(bool /*collapsed*/, Progress& /*progress*/) { return {}; }

    /// Draws and learns \p count signals, with the splits that fall due between them if it \p grows.
    void learn_batch(int count, bool grows);
    bool report_due();
    /// \return false if \p progress asked to stop
    bool report(const char* doing, double fraction, Progress& progress) const;

    const TargetSpace& target_;
    LearningState state_;
    GrowthSchedule schedule_;
    BasicStepBatch batch_;

private:
    const StepRates rates_;
    WindowMean mean_delta_;
    NormalTurn normal_turn_;
    Random random_;                    ///< of the signals
    std::vector<vcg::Point3f> drawn_;  ///< those of the last batch
    BatchLimit batch_limit_;
    std::int64_t last_report_ = 0;
};

}  // namespace neuralmesh
