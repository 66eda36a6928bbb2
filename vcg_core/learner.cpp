// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The learning loop and its steps.
#include "learner.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "patch.h"

namespace neuralmesh {

namespace {

/// delta of eq 2, 1 - n.n', written so that it keeps its digits where the normals are nearly equal.
double normal_variation(const vcg::Point3f& n, const vcg::Point3f& n_after) {
    return 0.5 * static_cast<double>((n_after - n).SquaredNorm());
}

/// F_v = (l_v)^2 with l_v the mean length of the edges at v (eq 5).
double voronoi_area(const Network& network, VertexId v) {
    const Ring& ring = network.ring(v);
    const vcg::Point3f p = network.position(v);
    double l = 0;
    for (int i = 0; i < ring.valence; ++i) l += static_cast<double>((network.position(ring[i]) - p).Norm());
    l /= ring.valence;
    return l * l;
}

constexpr int kSplitCandidates = 32;  ///< tried before a split is put off

}  // namespace

Learner::Learner(const TargetSpace& target, const Settings& settings, Network start)
    : target_(target),
      settings_(settings),
      network_(std::move(start)),
      search_(network_),
      utility_counters_(settings.counter_decay, settings.min_wins_per_split),
      feature_counters_(settings.feature_decay),
      mean_delta_(settings.normalization_window),
      random_(static_cast<std::uint64_t>(settings.random_seed)),
      last_active_(static_cast<std::size_t>(network_.slot_count()), 0),
      vertices_at_collapse_(network_.vertex_count()) {
    if (network_.vertex_count() > settings.target_vertices)
        throw SettingError("The start mesh already has " + std::to_string(network_.vertex_count()) +
                           " vertices: set target_vertices to at least that.");
    network_.reserve(settings.target_vertices + 1);
    utility_counters_.resize(network_.slot_count());
    feature_counters_.resize(network_.slot_count());
}

StopReason Learner::run(Progress& progress) {
    const int target_vertices = settings_.target_vertices;
    const std::int64_t report_every = 1000;
    while (network_.vertex_count() < target_vertices) {
        basic_step(target_.sample(random_));
        if (signals_ % settings_.signals_per_split == 0) vertex_split();
        if (due_for_collapse()) half_edge_collapse();

        if (signals_ % report_every != 0) continue;
        char text[80];
        std::snprintf(text, sizeof text, "Learning: %d of %d vertices, %lld signals", network_.vertex_count(),
                      target_vertices, static_cast<long long>(signals_));
        if (!progress(static_cast<double>(network_.vertex_count()) / target_vertices, text))
            return StopReason::cancelled;
        if (settings_.stop_below_mean_counter > 0 && mean_counter() < settings_.stop_below_mean_counter)
            return StopReason::converged;
        if (signals_ >= signal_bound()) return StopReason::cut_short;
    }
    return settle(settings_.settling_signals_per_vertex, progress) ? StopReason::target_reached
                                                                   : StopReason::cancelled;
}

void Learner::basic_step(const vcg::Point3f& s) {
    const VertexId w = search_.winner(s);
    Patch patch(network_, w);
    const vcg::Point3f n = patch.normal();
    patch.move_winner(s, static_cast<float>(settings_.learning_rate));
    patch.smooth(settings_.smoothing_steps, static_cast<float>(settings_.smoothing_rate));
    learn_counters(w, normal_variation(n, patch.normal()));

    search_.move(w, patch.winner_position());
    for (int i = 0; i < patch.valence(); ++i) search_.move(patch.neighbour(i), patch.position(i));
    last_active_[static_cast<std::size_t>(w)] = ++signals_;
}

void Learner::learn_counters(VertexId w, double delta) {
    mean_delta_.add(delta);
    const double m_delta = mean_delta_.mean();
    // A mesh that has not turned at all (a plane learned by a plane) has no mean to compare with: all are equal.
    const double n_delta = m_delta > 0 ? delta / m_delta : 1;  // eq 3
    utility_counters_.win(w, settings_.utility_counter == kNormalCounter ? n_delta : 1);
    feature_counters_.win(w, n_delta);
}

bool Learner::vertex_split() {
    for (int candidate = 0; candidate < kSplitCandidates; ++candidate) {
        const VertexId v = utility_counters_.highest();
        if (v < 0) return false;
        if (try_split(v)) return true;
        utility_counters_.pass_over(v);
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

    const vcg::Point3f midpoint = (p + network_.position(ring[longest])) / 2;
    const VertexId u = network_.split(v, half.first, half.count, midpoint);
    search_.add(u);
    utility_counters_.resize(network_.slot_count());
    feature_counters_.resize(network_.slot_count());
    last_active_.resize(static_cast<std::size_t>(network_.slot_count()));
    utility_counters_.share(v, u, voronoi_area(network_, v), voronoi_area(network_, u));
    feature_counters_.inherit(v, u);
    last_active_[static_cast<std::size_t>(u)] = signals_;
    search_.keep_up();
    ++splits_;
    return true;
}

/// From the longest edge e equally far both ways to e1 and e2. Where the star has an odd number of edges to
/// give, the side whose end has the smaller valence gets one more.
Learner::Halving Learner::halve_star(VertexId v, int longest) const {
    const Ring& ring = network_.ring(v);
    const int k = ring.valence;
    const int steps = k / 2;  // on both sides together
    const auto option = [&](int back, int ahead) -> Halving {
        int first = longest - back;
        int count = back + ahead + 1;
        if (ring.open != 0) {
            const int end = std::min(first + count, k);
            first = std::max(first, 0);
            count = end - first;
        } else if (first < 0) {
            first += k;
        }
        return network_.can_split(v, first, count) ? Halving{first, count} : Halving{0, 0};
    };
    const auto ends = [&](const Halving& h) {
        return h.count == 0 ? std::numeric_limits<int>::max()
                            : network_.ring(ring[h.first]).valence +
                                  network_.ring(ring[(h.first + h.count - 1) % k]).valence;
    };
    const Halving a = option(steps / 2, steps - steps / 2);
    const Halving b = option(steps - steps / 2, steps / 2);
    return ends(b) < ends(a) ? b : a;
}

bool Learner::due_for_collapse() const {
    return signals_ - last_collapse_ >= std::int64_t{vertices_at_collapse_} * settings_.signals_per_collapse;
}

int Learner::half_edge_collapse() {
    int removed = 0;
    for (VertexId v = 0; v < network_.slot_count(); ++v) {
        if (!network_.alive(v) || last_active_[static_cast<std::size_t>(v)] > last_collapse_) continue;
        const VertexId kept = best_collapse(v);
        if (kept < 0) continue;
        search_.remove(v);
        utility_counters_.remove(v);
        network_.collapse(v, kept);
        ++removed;
    }
    search_.keep_up();
    collapses_ += removed;
    last_collapse_ = signals_;
    vertices_at_collapse_ = network_.vertex_count();
    return removed;
}

/// The neighbour into which v goes at the least cost 1/3 sqrt((a + b - 10)^2 + (c - 7)^2 + (d - 7)^2): a, b the
/// valences at the ends of the edge, c, d those opposite to it (Ivrissimtzis et al. 2003). -1: none is legal.
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

bool Learner::settle(int per_vertex, Progress& progress) {
    const std::int64_t end = signals_ + std::int64_t{per_vertex} * network_.vertex_count();
    while (signals_ < end) {
        basic_step(target_.sample(random_));
        if (signals_ % 1000 != 0) continue;
        char text[80];
        std::snprintf(text, sizeof text, "Settling: %d vertices, %lld signals", network_.vertex_count(),
                      static_cast<long long>(signals_));
        if (!progress(1, text)) return false;
    }
    return true;
}

std::int64_t Learner::signal_bound() const {
    const std::int64_t per_vertex = 4 * std::int64_t{settings_.signals_per_split} + 2 * settings_.min_wins_per_split;
    return per_vertex * settings_.target_vertices + 100000;
}

double Learner::mean_counter() const {
    double sum = 0;
    for (VertexId v = 0; v < network_.slot_count(); ++v)
        if (network_.alive(v)) sum += static_cast<double>(feature_counters_.value(v));
    return sum / network_.vertex_count();
}

}  // namespace neuralmesh
