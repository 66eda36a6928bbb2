// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/paper/paper_learner.h"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <string>
#include <utility>

#include "vcg_core/base/error.h"
#include "vcg_core/paper/connectivity_steps.h"

namespace neuralmesh {

namespace {

constexpr int kMostInBatch = 512;     ///< signals whose data stay in the cache
constexpr int kPrefetchDistance = 8;  ///< signals between the prefetch and the use of a winner's counters
constexpr int kReportEvery = 1000;    ///< signals between two looks at the progress and at eq 8

Network checked(Network start, int grow_to) {
    if (start.vertex_count() > grow_to)
        throw SettingError("The start mesh already has " + std::to_string(start.vertex_count()) +
                           " vertices: set target_vertices to at least that.");
    return start;
}

}  // namespace

StopReason PaperLearner::grow(Progress& progress) {
    const int begin = network().vertex_count(), goal = state_.options.grow_to;
    double done = 0;  // collapses do not take it back
    while (network().vertex_count() < goal) {
        learn_batch(batch_size(), true);
        const bool collapses = schedule_.collapse_due(signals());
        if (collapses) half_edge_collapse();
        PartOf standing(progress, done, done);
        if (const auto reason = between_steps(collapses, standing)) return *reason;
        if (!report_due()) continue;
        done = std::max(done, static_cast<double>(network().vertex_count() - begin) / (goal - begin));
        if (!report("Learning", done, progress)) return StopReason::cancelled;
        if (mean_turn() < state_.options.stop_below_turn) return StopReason::converged;  // eq 8
    }
    return StopReason::target_reached;
}

void PaperLearner::learn_batch(int count, bool grows) {
    target_.sample(random_, count, drawn_);
    const std::vector<StepResult>& steps = basic_steps(drawn_.data(), count);
    look_at(steps, drawn_.data());
    const auto last = static_cast<std::size_t>(count) - 1;
    for (std::size_t i = 0; i <= last; ++i) {
        const VertexId soon = steps[std::min(i + kPrefetchDistance, last)].winner;
        state_.utility_counters.prefetch(soon);
        state_.feature_counters.prefetch(soon);
        learn_counters(steps[i]);
        if (grows && schedule_.split_due(signals())) vertex_split();
    }
}

const std::vector<StepResult>& PaperLearner::basic_steps(const vcg::Point3f* signals, int count) {
    const std::vector<StepResult>& steps = batch_.take(signals, count, rates_, state_.network, state_.search);
    state_.activity.record(steps, state_.signals, state_.network, batch_limit_);
    return steps;
}

void PaperLearner::learn_counters(const StepResult& step) {
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

bool PaperLearner::vertex_split() {
    return network().vertex_count() < state_.options.grow_to &&
           neuralmesh::vertex_split(state_, [this](VertexId v) { return may_split(v); });
}

int PaperLearner::half_edge_collapse() {
    const int removed = neuralmesh::half_edge_collapse(state_, schedule_.last_collapse());
    schedule_.collapsed(signals(), network().vertex_count());
    return removed;
}

PaperLearner::PaperLearner(const TargetSpace& target, const GrowthOptions& options, Network start)
    : target_(target),
      state_(options, checked(std::move(start), options.grow_to)),
      schedule_(state_.options, state_.network.vertex_count()),
      batch_(options.threads),
      rates_{static_cast<float>(options.learning_rate), static_cast<float>(options.smoothing_rate),
             options.smoothing_steps},
      mean_delta_(options.normalization_window),
      random_(stream_seed(options.random_seed, Stream::learning)) {}

int PaperLearner::batch_size() const {
    if (state_.to_the_letter() || !rates_.may_add_up()) return 1;
    return std::clamp(network().vertex_count() / kVerticesPerSignal, 1,
                      std::min(kMostInBatch, batch_limit_.limit()));
}

bool PaperLearner::report_due() {
    if (signals() - last_report_ < kReportEvery) return false;
    last_report_ = signals();
    return true;
}

bool PaperLearner::report(const char* doing, double fraction, Progress& progress) const {
    char text[96];
    std::snprintf(text, sizeof text, "%s: %d vertices, %lld signals", doing, network().vertex_count(),
                  static_cast<long long>(signals()));
    return progress(fraction, text);
}

}  // namespace neuralmesh
