// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The learning loop and its steps.
#include "vcg_core/learning/learner.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "vcg_core/mesh/valence_flips.h"
#include "vcg_core/mesh/vertex_order.h"

namespace neuralmesh {

namespace {

/// Cosine between the faces before and after a flip: above it the flip is one in the surface, not of it.
constexpr float kFlatEnough = 0.95F;
constexpr int kSplitCandidates = 32;  ///< tried before a split is put off
constexpr std::int64_t kLeastSettling = 60000;
constexpr int kMostAtOnce = 512;       ///< a batch that stays in the cache
constexpr int kLeastInOrder = 2048;    ///< vertices of a network that more than one thread may share
constexpr int kTypicalSignals = 4096;  ///< place a border between two threads' regions to about 1 %
constexpr int kCountersAhead = 8;      ///< signals whose counters are on their way into the cache
constexpr int kReportEvery = 1000;     ///< signals between two looks at the progress and at the stop criteria

/// From random numbers of its own, so that those of the learning do not depend on the threads.
std::vector<vcg::Point3f> typical_signals(const TargetSpace& target, int threads) {
    std::vector<vcg::Point3f> drawn;
    Random random(1);
    for (int i = 0; threads != 1 && i < kTypicalSignals; ++i) drawn.push_back(target.sample(random));
    return drawn;
}

/// True if each new face is within kFlatEnough of each old one.
bool is_flat(const FlipNormals& normals) {
    for (vcg::Point3f n : normals.before) {
        n.Normalize();
        for (vcg::Point3f m : normals.after)
            if (n * m.Normalize() < kFlatEnough) return false;
    }
    return true;
}

}  // namespace

Learner::Learner(const TargetSpace& target, const Settings& settings, Network start)
    : settings_(settings),
      network_(std::move(start)),
      search_(network_),
      utility_counters_(settings.counter_decay, settings.min_wins_per_split),
      feature_counters_(settings.feature_decay),
      mean_delta_(settings.normalization_window),
      steps_(settings.threads, typical_signals(target, settings.threads)),
      drawn_(target, settings.random_seed, BasicStepBatch::kMostSignals),
      last_active_(network_.slot_count(), 0),
      vertices_at_collapse_(network_.vertex_count()) {
    if (network_.vertex_count() > settings.target_vertices)
        throw SettingError("The start mesh already has " + std::to_string(network_.vertex_count()) +
                           " vertices: set target_vertices to at least that.");
    network_.reserve(settings.target_vertices + 1);
    utility_counters_.resize(network_.slot_count());
    feature_counters_.resize(network_.slot_count());
}

StopReason Learner::run(int per_vertex, Progress& progress) {
    // The parts by the signals they are likely to take; growth seldom does with fewer.
    const auto landing = static_cast<double>(settling_signals(per_vertex, network_.vertex_count()));
    const auto growth = static_cast<double>(std::int64_t{settings_.signals_per_split} *
                                            (settings_.target_vertices - network_.vertex_count()));
    const auto settling = static_cast<double>(
        settling_signals(settings_.settling_signals_per_vertex, settings_.target_vertices));
    const double whole = std::max(landing + growth + settling, 1.0);
    PartOf first(progress, 0, landing / whole);
    PartOf second(progress, landing / whole, (landing + growth) / whole);
    PartOf third(progress, (landing + growth) / whole, 1);
    if (!settle(per_vertex, first, false)) return StopReason::cancelled;
    const StopReason grown = grow(second);
    if (grown != StopReason::target_reached) return grown;
    return settle(settings_.settling_signals_per_vertex, third) ? grown : StopReason::cancelled;
}

StopReason Learner::grow(Progress& progress) {
    const std::int64_t budget = signals_ + growth_budget();
    const std::int64_t bound = signals_ + signal_bound();
    const int begin = network_.vertex_count();
    double done = 0;  // never less than it was, though vertices go as well
    while (network_.vertex_count() < settings_.target_vertices) {
        const int count = batch_size();
        basic_steps(drawn_.take(count), count);
        const auto draw = [&] { drawn_.draw_ahead(count); };
        const auto drawing = steps_.run_in_background(draw);
        for (int i = 0; i < count; ++i) {
            learn_counters(i);
            if (signals_ % settings_.signals_per_split == 0) vertex_split();
        }
        if (due_for_collapse()) half_edge_collapse();
        reorder_if_grown();

        if (!forced_ && signals_ >= budget) force_growth();
        if (signals_ >= bound) return StopReason::cut_short;
        if (!due_for_report()) continue;
        done = std::max(
            done, static_cast<double>(network_.vertex_count() - begin) / (settings_.target_vertices - begin));
        if (!report("Learning", done, progress)) return StopReason::cancelled;
        if (mean_turn() < settings_.stop_below_mean_counter) return StopReason::converged;  // eq 8
    }
    return StopReason::target_reached;
}

bool Learner::report(const char* doing, double fraction, Progress& progress) const {
    char text[96];
    std::snprintf(text, sizeof text, "%s: %d vertices, %lld signals", doing, network_.vertex_count(),
                  static_cast<long long>(signals_));
    return progress(fraction, text);
}

bool Learner::due_for_report() {
    if (signals_ - last_report_ < kReportEvery) return false;
    last_report_ = signals_;
    return true;
}

int Learner::batch_size() const {
    if (to_the_letter()) return 1;
    return std::clamp(network_.vertex_count() / kVerticesPerSignal, 1,
                      std::min(kMostAtOnce, crowding_.limit()));
}

/// A network that outgrows a core's first cache, and may then be shared by threads, is put in order from time
/// to time, so that what a step visits shares cache lines and pages, and what the threads visit does not.
void Learner::reorder_if_grown() {
    const int n = network_.vertex_count();
    if (n >= kLeastInOrder && n >= vertices_in_order_ + vertices_in_order_ / 4)
        reorder(std::min(n / 4, settings_.target_vertices - n));
}

/// With free ids between for \p more vertices.
void Learner::reorder(int more) {
    vertices_in_order_ = network_.vertex_count();
    changes_in_order_ = splits_ + collapses_;
    const std::vector<VertexId> order = interleave_free(morton_order(network_), more);
    network_.renumber(order);
    utility_counters_.renumber(order);
    feature_counters_.renumber(order);
    last_active_ = permuted(last_active_, order, std::int64_t{0});
    search_.lay_out();
    steps_.reconsider();
}

void Learner::basic_steps(const vcg::Point3f* signals, int count) {
    const StepRates rates{static_cast<float>(settings_.learning_rate),
                          static_cast<float>(settings_.smoothing_rate), settings_.smoothing_steps};
    steps_.take(signals, count, rates, network_, search_);
    batch_begin_ = signals_;
    batch_end_ = signals_ + count;
}

void Learner::learn_counters(int i) {
    const VertexId soon = steps_.winner(std::min(i + kCountersAhead, steps_.count() - 1));
    utility_counters_.prefetch(soon);
    feature_counters_.prefetch(soon);
    __builtin_prefetch(&last_active_[soon], 1);
    const VertexId w = steps_.winner(i);
    const double delta = steps_.delta(i);  // eq 2
    mean_delta_.add(delta);
    turn_mean_.add(delta, network_.vertex_count());
    const double m_delta = mean_delta_.mean();
    // A mesh that has not turned at all (a plane learned by a plane) has no mean to compare with: all are
    // equal.
    const double n_delta = m_delta > 0 ? delta / m_delta : 1;  // eq 3
    utility_counters_.win(w, settings_.utility_counter == kNormalCounter ? n_delta : 1);
    feature_counters_.win(w, n_delta);
    std::int64_t& last_active = last_active_[w];
    if (last_active > batch_begin_) crowding_.repeated(w);
    last_active = ++signals_;
    if (signals_ == batch_end_) crowding_.end_batch(static_cast<int>(batch_end_ - batch_begin_));
}

bool Learner::vertex_split() {
    if (network_.vertex_count() >= settings_.target_vertices) return false;
    for (int candidate = 0; candidate < kSplitCandidates; ++candidate) {
        const VertexId v = utility_counters_.highest();
        if (v < 0) return false;
        if (try_split(v)) return true;
        utility_counters_.defer(v);
    }
    return false;
}

bool Learner::try_split(VertexId v) {
    const Ring& ring = network_.ring(v);
    const vcg::Point3f p = network_.position(v);
    int longest = 0;
    float length = -1;
    for (int i = 0; i < ring.valence; ++i) {
        const float l = (network_.position(ring[i]) - p).SquaredNorm();
        if (l <= length) continue;
        length = l;
        longest = i;
    }
    const Halving half = halve_star(v, longest);
    if (half.count == 0) return false;

    const VertexId e2 = ring[half.first];
    const VertexId e1 = ring[(half.first + half.count - 1) % ring.valence];
    const vcg::Point3f midpoint = (p + network_.position(ring[longest])) / 2;
    const VertexId u = network_.split(v, half.first, half.count, midpoint);
    register_new(u, v);
    search_.keep_up();
    if (!to_the_letter())
        for (const VertexId w : {v, u, e1, e2}) flip_edges_for_valence(network_, w, {is_flat});
    ++splits_;
    return true;
}

/// Enters the new vertex u, split off v, everywhere a vertex is known.
void Learner::register_new(VertexId u, VertexId v) {
    search_.add(u);
    utility_counters_.resize(network_.slot_count());
    feature_counters_.resize(network_.slot_count());
    last_active_.resize(network_.slot_count());
    utility_counters_.share(v, u, squared_mean_edge(network_, v), squared_mean_edge(network_, u));
    feature_counters_.inherit(v, u);
    // A vertex that was not there at the last call of Half-Edge Collapse has not been inactive since.
    last_active_[u] = to_the_letter() ? 0 : signals_;
}

/// From the longest edge e both ways to e1 and e2, so that the star is halved. "Equally" leaves a choice of
/// one edge more or less on either side: the one that leaves the most regular valences.
Learner::Halving Learner::halve_star(VertexId v, int longest) const {
    const Ring& ring = network_.ring(v);
    const int k = ring.valence;
    Halving best{0, 0};
    int least = std::numeric_limits<int>::max();
    const auto irregularity = [](int valence) { return (valence - 6) * (valence - 6); };
    for (int back = 1; back <= k / 2; ++back) {
        for (int ahead = 1; ahead <= k / 2; ++ahead) {
            if (std::abs(back - ahead) > 1 || std::abs(2 * (back + ahead) - std::max(k, 3)) > 1) continue;
            // An open star ends at its boundary edges.
            const int first = ring.open != 0 ? std::max(longest - back, 0) : (longest - back + k) % k;
            const int count =
                ring.open != 0 ? std::min(longest + ahead, k - 1) - first + 1 : back + ahead + 1;
            if (!network_.can_split(v, first, count)) continue;
            const int cost = irregularity(count + 1) + irregularity(k - count + 3) +
                             irregularity(network_.ring(ring[first]).valence + 1) +
                             irregularity(network_.ring(ring[(first + count - 1) % k]).valence + 1);
            if (cost >= least) continue;
            least = cost;
            best = {first, count};
        }
    }
    return best;
}

void Learner::force_growth() {
    forced_ = true;
    utility_counters_.waive_maturity();
}

bool Learner::due_for_collapse() const {
    return !forced_ &&
           signals_ - last_collapse_ >= std::int64_t{vertices_at_collapse_} * settings_.signals_per_collapse;
}

int Learner::half_edge_collapse() {
    int removed = 0;
    for (VertexId v = 0; v < network_.slot_count(); ++v) {
        if (!network_.alive(v) || last_active_[v] > last_collapse_) continue;
        const VertexId kept = best_collapse(v);
        if (kept < 0) continue;
        search_.remove(v);
        utility_counters_.remove(v);
        network_.collapse(v, kept);
        if (!to_the_letter()) flip_edges_for_valence(network_, kept, {is_flat});
        ++removed;
    }
    search_.keep_up();
    collapses_ += removed;
    last_collapse_ = signals_;
    vertices_at_collapse_ = network_.vertex_count();
    return removed;
}

/// The neighbour into which v goes at the least cost 1/3 sqrt((a + b - 10)^2 + (c - 7)^2 + (d - 7)^2): a, b
/// the valences at the ends of the edge, c, d those opposite to it (Ivrissimtzis et al. 2003). -1: none is
/// legal.
VertexId Learner::best_collapse(VertexId gone) const {
    const Ring& ring = network_.ring(gone);
    VertexId best = -1;
    int least = std::numeric_limits<int>::max();
    const auto valence = [&](VertexId v) { return static_cast<int>(network_.ring(v).valence); };
    const auto square = [](int x) { return x * x; };
    for (int i = 0; i < ring.valence; ++i) {
        // The root and the factor do not change the order.
        const int cost = square(ring.valence + valence(ring[i]) - 10) + square(valence(ring.next(i)) - 7) +
                         square(valence(ring.previous(i)) - 7);
        if (cost >= least || !network_.can_collapse(gone, ring[i])) continue;
        least = cost;
        best = ring[i];
    }
    return best;
}

std::int64_t Learner::settling_signals(int per_vertex, int vertices) {
    return per_vertex == 0 ? 0 : std::max(std::int64_t{per_vertex} * vertices, kLeastSettling);
}

bool Learner::settle(int per_vertex, Progress& progress, bool to_be_observed) {
    // For long, as the connectivity stays as it is.
    if (network_.vertex_count() >= kLeastInOrder && changes_in_order_ != splits_ + collapses_) reorder(0);
    const bool observing = to_be_observed && settings_.feature_measure == kCreaseMeasure;
    const std::int64_t begin = signals_;
    const std::int64_t end = begin + settling_signals(per_vertex, network_.vertex_count());
    std::int64_t next_moment = begin + (end - begin) / 5;  // until then it is still on its way from growth
    crease_measure_ = CreaseMeasure();
    while (signals_ < end) {
        const int count = static_cast<int>(std::min<std::int64_t>(batch_size(), end - signals_));
        basic_steps(drawn_.take(count), count);
        {
            const auto draw = [&] { drawn_.draw_ahead(count); };
            const auto drawing = steps_.run_in_background(draw);
            for (int i = 0; i < count; ++i) learn_counters(i);
        }
        if (observing && signals_ >= next_moment) {
            crease_measure_.observe(network_);
            next_moment += network_.vertex_count();
        }
        if (!due_for_report()) continue;
        const double done = static_cast<double>(signals_ - begin) / static_cast<double>(end - begin);
        if (!report("Settling", done, progress)) return false;
    }
    return true;
}

std::int64_t Learner::growth_budget() const {
    const std::int64_t per_vertex =
        4 * std::int64_t{settings_.signals_per_split} + 2 * std::int64_t{settings_.min_wins_per_split};
    return per_vertex * settings_.target_vertices + 100000;
}

std::int64_t Learner::signal_bound() const {
    return growth_budget() + 2 * std::int64_t{settings_.signals_per_split} * settings_.target_vertices;
}

}  // namespace neuralmesh
