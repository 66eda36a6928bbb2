// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/learning/learner.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vcg_core/base/ablation.h"
#include "vcg_core/base/random.h"
#include "vcg_core/cloud/surface_survey.h"

namespace neuralmesh {

Learner::Learner(const TargetSpace& target, const LearnerOptions& options, Network start)
    : PaperLearner(target, options, std::move(start)),
      options_(options),
      topology_random_(stream_seed(options.random_seed, Stream::topology)) {}

StopReason Learner::run(int landing_signals, Progress& progress) {
    // Shares of the progress by the signals that each phase is likely to take; growth seldom needs fewer.
    const auto landing = static_cast<double>(settling_signals(landing_signals, network().vertex_count()));
    const auto growth = static_cast<double>(std::int64_t{options_.signals_per_split} *
                                            (options_.grow_to - network().vertex_count()));
    const auto settling =
        static_cast<double>(settling_signals(options_.settling_signals_per_vertex, options_.grow_to));
    const double whole = std::max(landing + growth + settling, 1.0);
    PartOf first(progress, 0, landing / whole);
    PartOf second(progress, landing / whole, (landing + growth) / whole);
    PartOf third(progress, (landing + growth) / whole, 1);

    if (!settle(landing_signals, first, false)) return StopReason::cancelled;
    const StopReason grown = begin_and_grow(second);
    if (grown != StopReason::target_reached) return grown;
    return settle(options_.settling_signals_per_vertex, third) ? grown : StopReason::cancelled;
}

StopReason Learner::begin_and_grow(Progress& progress) {
    growth_begin_ = signals();
    look_for_notches();
    if (options_.learn_topology)
        topology_stages_.emplace(network().vertex_count(),
                                 std::min(options_.grow_to, most_examined(target_)));
    const StopReason reason = grow(progress);
    mends_notches_ = false;
    return reason;
}

std::optional<StopReason> Learner::between_steps(bool collapsed, Progress& progress) {
    if (memory_order_.renew_while_growing(state_)) boundary_signals_.clear();
    const bool examines = topology_stages_ && topology_stages_->pass(network().vertex_count());
    if (examines && !learn_topology(topology_stages_->over(), progress)) return StopReason::cancelled;
    if (!forced() && signals() >= growth_begin_ + growth_budget(options_)) {
        schedule_.end_collapses();
        state_.utility_counters.waive_maturity();
    }
    if (signals() >= growth_begin_ + signal_bound()) return StopReason::cut_short;
    if (!collapsed || !is_saturated()) return {};
    const bool examine = topology_stages_ && !topology_stages_->over();
    return examine && !learn_topology(true, progress) ? StopReason::cancelled : StopReason::target_reached;
}

bool Learner::is_saturated() {
    const bool reached = saturation_.reached(network().vertex_count(), state_.splits + state_.splits_refused);
    return reached && options_.noise != nullptr && !skips("saturation");
}

bool Learner::may_split(VertexId v) const {
    return options_.noise == nullptr ||
           squared_mean_edge(network(), v) >=
               static_cast<double>(options_.noise->orderly_at(network().position(v)).least_squared_edge());
}

void Learner::look_at(const std::vector<StepResult>& steps, const vcg::Point3f* signals) {
    if (!mends_notches_) return;
    for (std::size_t i = 0; i < steps.size(); ++i)
        if (network().ring(steps[i].winner).open != 0) boundary_signals_.add(steps[i].winner, signals[i]);
}

void Learner::look_for_notches() {
    mends_notches_ = !state_.to_the_letter() && network().boundary_loop_count() > 0;
}

int Learner::half_edge_collapse() {
    if (!state_.to_the_letter()) mend_boundary_faces(state_, boundary_signals_, true);
    boundary_signals_.clear();
    return PaperLearner::half_edge_collapse();
}

bool Learner::learn_topology(bool last, Progress& progress) {
    constexpr int kMostRounds = 4;
    const TopologyRules& rules = options_.topology_rules;
    ThreadTeam team(thread_count(options_.threads));
    const auto evidence = [&] { return topology_evidence(network(), target_, topology_random_, team); };
    state_.network.orient_outward();  // a tetrahedron may turn inside out as a whole while it is small
    int changes = 0;
    bool goes_on = true;
    auto now = evidence();
    for (int round = 0; now && goes_on && round < kMostRounds; ++round) {
        const int before = changes;
        for (const Reconnection& change :
             neuralmesh::topology_changes(network(), target_, *now, rules, team, progress))
            changes += state_.exchange_faces(change.gone, change.added) ? 1 : 0;
        goes_on = report("Learning", 0, progress);
        if (changes == before) break;
        now = evidence();
    }
    if (now && last && goes_on && std::isfinite(rules.opens_from)) {
        for (const std::vector<Triangle>& gone : membranes_to_open(*now, rules))
            changes += state_.exchange_faces(gone, {}) ? 1 : 0;
        look_for_notches();
    }
    topology_changes_ += changes;
    return goes_on;
}

bool Learner::settle(int per_vertex, Progress& progress, bool observe) {
    if (!learn_at_rest(settling_signals(per_vertex, network().vertex_count()), progress, observe))
        return false;
    if (observe && !state_.to_the_letter()) mend_boundary_faces(state_, boundary_signals_, false);
    return true;
}

bool Learner::learn_at_rest(std::int64_t count, Progress& progress, bool observe) {
    if (memory_order_.renew_at_rest(state_)) boundary_signals_.clear();
    crease_measure_ = CreaseMeasure();
    const std::int64_t begin = signals();
    const std::int64_t end = begin + count;
    // The first fifth is not observed: there the mesh still moves as a result of its growth.
    std::int64_t next_moment = begin + (end - begin) / 5;
    while (signals() < end) {
        learn_batch(static_cast<int>(std::min<std::int64_t>(batch_size(), end - signals())), false);
        if (observe && options_.observe_creases && signals() >= next_moment) {
            crease_measure_.observe(network(), batch_.team());
            next_moment += network().vertex_count();
        }
        if (!report_due()) continue;
        const double done = static_cast<double>(signals() - begin) / static_cast<double>(end - begin);
        if (!report("Settling", done, progress)) return false;
    }
    return true;
}

void Learner::move_to(const PerVertex<vcg::Point3f>& places) {
    for (const VertexId v : state_.network.vertices()) state_.search.move(v, places[v]);
}

}  // namespace neuralmesh
