// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Learner::run() is the whole of the learning, and Learner::grow() its loop. The steps follow.
#include "vcg_core/learning/learner.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <utility>

#include "vcg_core/base/ablation.h"
#include "vcg_core/base/error.h"
#include "vcg_core/base/random.h"
#include "vcg_core/learning/boundary_faces.h"
#include "vcg_core/learning/connectivity_steps.h"
#include "vcg_core/topology/learned_topology.h"

namespace neuralmesh {

namespace {

constexpr int kMostInBatch = 512;      ///< signals whose data stay in the cache
constexpr int kPrefetchDistance = 8;   ///< signals between the prefetch and the use of a winner's counters
constexpr int kReportEvery = 1000;     ///< signals between two looks at the progress and at the stop criteria

Network checked(Network start, int grow_to) {
    if (start.vertex_count() > grow_to)
        throw SettingError("The start mesh already has " + std::to_string(start.vertex_count()) +
                           " vertices: set target_vertices to at least that.");
    return start;
}

}  // namespace

Learner::Learner(const TargetSpace& target, const LearnerOptions& options, Network start)
    : target_(target),
      state_(options, checked(std::move(start), options.grow_to)),
      rates_{static_cast<float>(options.learning_rate), static_cast<float>(options.smoothing_rate),
             options.smoothing_steps},
      mean_delta_(options.normalization_window),
      schedule_(state_.options, state_.network.vertex_count()),
      random_(stream_seed(options.random_seed, Stream::learning)),
      batch_(options.threads),
      topology_random_(stream_seed(options.random_seed, Stream::topology)) {}

StopReason Learner::run(int landing_signals, Progress& progress) {
    const LearnerOptions& options = state_.options;
    // Shares of the progress by the signals that each phase is likely to take; growth seldom needs fewer.
    const auto landing = static_cast<double>(settling_signals(landing_signals, network().vertex_count()));
    const auto growth = static_cast<double>(std::int64_t{options.signals_per_split} *
                                            (options.grow_to - network().vertex_count()));
    const auto settling =
        static_cast<double>(settling_signals(options.settling_signals_per_vertex, options.grow_to));
    const double whole = std::max(landing + growth + settling, 1.0);
    PartOf first(progress, 0, landing / whole);
    PartOf second(progress, landing / whole, (landing + growth) / whole);
    PartOf third(progress, (landing + growth) / whole, 1);

    if (!settle(landing_signals, first, false)) return StopReason::cancelled;
    const StopReason grown = grow(second);
    mends_notches_ = false;
    if (grown != StopReason::target_reached) return grown;
    return settle(options.settling_signals_per_vertex, third) ? grown : StopReason::cancelled;
}

StopReason Learner::grow(Progress& progress) {
    const int goal = state_.options.grow_to;
    const int begin = network().vertex_count();
    double done = 0;  // of growth; collapses do not take it back
    schedule_.begin(signals());
    mends_notches_ = !state_.to_the_letter() && network().boundary_loop_count() > 0;
    TopologyStages stages(begin, std::min(goal, most_examined(target_)));
    while (network().vertex_count() < goal) {
        learn_batch(batch_size(), [this] {
            if (schedule_.split_due(signals())) vertex_split();
        });
        const bool collapses = !forced_ && schedule_.collapse_due(signals());
        if (collapses) half_edge_collapse();

        // Not in the paper: memory in the order of space, changes of the topology, and growth that stalls.
        state_.reorder_while_growing();
        PartOf standing(progress, done, done);
        const bool examines = state_.options.learn_topology && stages.pass(network().vertex_count());
        if (examines && !learn_topology(stages.over(), standing)) return StopReason::cancelled;
        if (!forced_ && schedule_.stalled(signals())) force_growth();
        if (schedule_.exhausted(signals())) return StopReason::cut_short;
        if (collapses && is_saturated()) {
            const bool examine = state_.options.learn_topology && !stages.over();
            return examine && !learn_topology(true, standing) ? StopReason::cancelled
                                                              : StopReason::target_reached;
        }

        if (!report_due()) continue;
        done = std::max(done, static_cast<double>(network().vertex_count() - begin) / (goal - begin));
        if (!report("Learning", done, progress)) return StopReason::cancelled;
        if (mean_turn() < state_.options.stop_below_turn) return StopReason::converged;  // eq 8
    }
    return StopReason::target_reached;
}

void Learner::force_growth() {
    forced_ = true;
    state_.utility_counters.waive_maturity();
}

bool Learner::is_saturated() {
    const bool reached = saturation_.reached(network().vertex_count(), state_.splits + state_.splits_refused);
    return reached && state_.options.noise != nullptr && !skips("saturation");
}

void Learner::keep_boundary_signals(const std::vector<StepResult>& steps, const vcg::Point3f* signals) {
    for (std::size_t i = 0; i < steps.size(); ++i)
        if (network().ring(steps[i].winner).open != 0)
            state_.boundary_signals.add(steps[i].winner, signals[i]);
}

/// Draws and learns \p count signals. Calls \p after_signal() after the counters of each.
template <class AfterSignal>
void Learner::learn_batch(int count, const AfterSignal& after_signal) {
    target_.sample(random_, count, drawn_);
    const vcg::Point3f* signals = drawn_.data();
    const std::vector<StepResult>& steps = basic_steps(signals, count);
    if (mends_notches_) keep_boundary_signals(steps, signals);
    const auto last = static_cast<std::size_t>(count) - 1;
    for (std::size_t i = 0; i <= last; ++i) {
        const VertexId soon = steps[std::min(i + kPrefetchDistance, last)].winner;
        state_.utility_counters.prefetch(soon);
        state_.feature_counters.prefetch(soon);
        learn_counters(steps[i]);
        after_signal();
    }
}

const std::vector<StepResult>& Learner::basic_steps(const vcg::Point3f* signals, int count) {
    const std::vector<StepResult>& steps = batch_.take(signals, count, rates_, state_.network, state_.search);
    state_.activity.record(steps, state_.signals, state_.network, batch_limit_);
    return steps;
}

void Learner::learn_counters(const StepResult& step) {
    const auto delta = static_cast<double>(step.delta);
    mean_delta_.add(delta);
    const double m_delta = mean_delta_.mean();
    // If no normal has turned (a plane learned by a plane), all vertices count the same.
    const double n_delta = m_delta > 0 ? delta / m_delta : 1;  // eq 3
    const bool adaptive = state_.options.utility_counter == kNormalVariation;
    state_.utility_counters.win(step.winner, adaptive ? n_delta : 1);
    state_.feature_counters.win(step.winner, n_delta);
    normal_turn_.add(delta, network().vertex_count());
    ++state_.signals;
}

int Learner::batch_size() const {
    if (state_.to_the_letter() || !rates_.may_add_up()) return 1;
    return std::clamp(network().vertex_count() / kVerticesPerSignal, 1,
                      std::min(kMostInBatch, batch_limit_.limit()));
}

bool Learner::vertex_split() {
    return network().vertex_count() < state_.options.grow_to && neuralmesh::vertex_split(state_);
}

int Learner::half_edge_collapse() {
    if (!state_.to_the_letter()) mend_boundary_faces(state_, true);
    state_.boundary_signals.clear();
    const int removed = neuralmesh::half_edge_collapse(state_, schedule_.last_collapse());
    schedule_.collapsed(signals(), network().vertex_count());
    return removed;
}

bool Learner::learn_topology(bool last, Progress& progress) {
    constexpr int kMostRounds = 4;
    const TopologyRules& rules = state_.options.topology_rules;
    ThreadTeam team(thread_count(state_.options.threads));
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
        mends_notches_ = !state_.to_the_letter() && network().boundary_loop_count() > 0;
    }
    topology_changes_ += changes;
    return goes_on;
}

bool Learner::settle(int per_vertex, Progress& progress, bool observe) {
    if (!learn_at_rest(settling_signals(per_vertex, network().vertex_count()), progress, observe))
        return false;
    if (observe && !state_.to_the_letter()) mend_boundary_faces(state_, false);
    return true;
}

bool Learner::learn_at_rest(std::int64_t count, Progress& progress, bool observe) {
    state_.reorder_at_rest();
    crease_measure_ = CreaseMeasure();
    const std::int64_t begin = signals();
    const std::int64_t end = begin + count;
    // The first fifth is not observed: there the mesh still moves as a result of its growth.
    std::int64_t next_moment = begin + (end - begin) / 5;
    while (signals() < end) {
        learn_batch(static_cast<int>(std::min<std::int64_t>(batch_size(), end - signals())), [] {});
        if (observe && state_.options.observe_creases && signals() >= next_moment) {
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

bool Learner::report_due() {
    if (signals() - last_report_ < kReportEvery) return false;
    last_report_ = signals();
    return true;
}

bool Learner::report(const char* doing, double fraction, Progress& progress) const {
    char text[96];
    std::snprintf(text, sizeof text, "%s: %d vertices, %lld signals", doing, network().vertex_count(),
                  static_cast<long long>(signals()));
    return progress(fraction, text);
}

}  // namespace neuralmesh
