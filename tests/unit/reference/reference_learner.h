// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The learning algorithm without anything that makes it fast: Basic Steps by learning/basic_step.h, one by
// one and in double, and counters that are decayed one by one. The oracle for Learner.
#pragma once

#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "vcg_core/learning/basic_step.h"
#include "vcg_core/learning/learner_options.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh::reference {

inline Positions positions_of(const Network& network) {
    Positions result(network.slot_count());
    for (const VertexId v : network.vertices()) result[v] = vcg::Point3d::Construct(network.position(v));
    return result;
}

/// Keeps a network of its own, whose connectivity Network's operations change; decides everything itself.
class ReferenceLearner {
public:
    ReferenceLearner(Network start, const LearnerOptions& options)
        : network_(std::move(start)), options_(options), positions_(positions_of(network_)) {
        grow();
    }

    /// Computes all steps from the same state of the network, then adds up their displacements.
    const std::vector<BasicStep>& basic_steps(const std::vector<vcg::Point3f>& signals) {
        const StepRates rates{static_cast<float>(options_.learning_rate),
                              static_cast<float>(options_.smoothing_rate), options_.smoothing_steps};
        steps_.clear();
        Positions sum = positions_;
        for (const vcg::Point3f& signal : signals) {
            const auto s = vcg::Point3d::Construct(signal);
            const VertexId w = find_winner(network_, positions_, s);
            const BasicStep step = basic_step(network_, positions_, w, s, rates);
            const Ring& ring = network_.ring(w);
            sum[w] += step.winner_position - positions_[w];
            for (std::size_t i = 0; i < ring.valence; ++i) {
                const VertexId v = ring.neighbours[i];
                sum[v] += step.ring_positions[i] - positions_[v];
            }
            steps_.push_back(step);
        }
        positions_ = sum;
        for (const VertexId v : network_.vertices())
            network_.set_position(v, vcg::Point3f::Construct(positions_[v]));
        return steps_;
    }

    void learn_counters(const BasicStep& step) {
        const VertexId w = step.winner;
        deltas_.push_back(step.delta);
        const auto window = static_cast<std::size_t>(options_.normalization_window);
        const auto from =
            deltas_.size() > window ? deltas_.end() - options_.normalization_window : deltas_.begin();
        const double mean =
            std::accumulate(from, deltas_.end(), 0.0) / static_cast<double>(deltas_.end() - from);
        const double n_delta = mean > 0 ? deltas_.back() / mean : 1;  // eq 3
        const auto i = static_cast<std::size_t>(w);
        utility[i] += options_.utility_increment == UtilityIncrement::n_delta ? n_delta : 1;  // eq 4
        for (double& counter : utility) counter *= options_.counter_decay;
        feature[i] = options_.feature_decay * feature[i] + (1 - options_.feature_decay) * n_delta;  // eq 6
        ++wins[i];
        won_since_collapse_[i] = true;
    }

    bool vertex_split() {
        std::vector<bool> tried(utility.size(), false);
        for (;;) {
            VertexId best = -1;
            for (VertexId v = 0; v < network_.slot_count(); ++v) {
                const auto i = static_cast<std::size_t>(v);
                if (!network_.alive(v) || tried[i] || wins[i] < options_.min_wins_per_split || wins[i] == 0)
                    continue;
                if (best < 0 || utility[i] > utility[static_cast<std::size_t>(best)]) best = v;
            }
            if (best < 0) return false;
            if (split(best)) return true;
            tried[static_cast<std::size_t>(best)] = true;
        }
    }

    int half_edge_collapse() {
        int removed = 0;
        for (VertexId v = 0; v < network_.slot_count(); ++v) {
            const auto i = static_cast<std::size_t>(v);
            if (!network_.alive(v) || won_since_collapse_[i]) continue;
            const VertexId kept = cheapest_collapse(v);
            if (kept < 0) continue;
            network_.collapse(v, kept);
            utility[i] = 0;
            wins[i] = 0;
            if (options_.min_wins_per_split != 0) regularise(kept);
            ++removed;
        }
        won_since_collapse_.assign(won_since_collapse_.size(), false);
        return removed;
    }

    const Network& network() const { return network_; }

    std::vector<double> utility;
    std::vector<double> feature;
    std::vector<int> wins;

private:
    void grow() {
        const auto n = static_cast<std::size_t>(network_.slot_count());
        utility.resize(n, 0);
        feature.resize(n, 0);
        wins.resize(n, 0);
        positions_.resize(network_.slot_count(), vcg::Point3d(0, 0, 0));
        won_since_collapse_.resize(n, false);
    }

    double area(VertexId v) const {
        const Ring& ring = network_.ring(v);
        double l = 0;
        for (int i = 0; i < ring.valence; ++i)
            l += (positions_[ring[i]] - positions_[v]).Norm() / ring.valence;
        return l * l;
    }

    bool split(VertexId v) {
        const Ring ring = network_.ring(v);
        const int k = ring.valence;
        int longest = 0;
        for (int i = 1; i < k; ++i)
            if ((positions_[ring[i]] - positions_[v]).Norm() >
                (positions_[ring[longest]] - positions_[v]).Norm())
                longest = i;
        // Every way to give half of the star away with e in the middle; the most regular valences win.
        const auto square = [](int x) { return (x - 6) * (x - 6); };
        int best_first = -1;
        int best_count = 0;
        int least = std::numeric_limits<int>::max();
        for (int back = 1; back <= k / 2; ++back)
            for (int ahead = std::max(1, back - 1); ahead <= std::min(k / 2, back + 1); ++ahead) {
                const int edges = back + ahead;
                if (edges != k / 2 && edges != (k + 1) / 2) continue;
                const int first = (longest - back + k) % k;
                if (!network_.can_split(v, first, edges + 1)) continue;
                const int cost = square(edges + 2) + square(k - edges + 2) +
                                 square(network_.ring(ring[first]).valence + 1) +
                                 square(network_.ring(ring[(longest + ahead) % k]).valence + 1);
                if (cost >= least) continue;
                least = cost;
                best_first = first;
                best_count = edges + 1;
            }
        if (best_first < 0) return false;
        const VertexId ends[] = {ring[best_first], ring[(best_first + best_count - 1) % k]};
        const vcg::Point3d middle = (positions_[v] + positions_[ring[longest]]) / 2;
        const VertexId u = network_.split(v, best_first, best_count, vcg::Point3f::Construct(middle));
        grow();
        positions_[u] = middle;
        const auto i = static_cast<std::size_t>(v);
        const auto j = static_cast<std::size_t>(u);
        const double whole = utility[i];  // shared as F_v to F_u (eq 5)
        utility[i] = whole * area(v) / (area(v) + area(u));
        utility[j] = whole - utility[i];
        feature[j] = feature[i];
        wins[i] = wins[j] = 0;
        won_since_collapse_[j] = options_.min_wins_per_split != 0;
        if (options_.min_wins_per_split != 0)
            for (const VertexId w : {v, u, ends[1], ends[0]}) regularise(w);
        return true;
    }

    VertexId cheapest_collapse(VertexId gone) const {
        const Ring& ring = network_.ring(gone);
        VertexId best = -1;
        double least = std::numeric_limits<double>::infinity();
        for (int i = 0; i < ring.valence; ++i) {
            const auto valence = [&](VertexId v) { return network_.ring(v).valence; };
            const double ab = ring.valence + valence(ring[i]) - 10;
            const double c = valence(ring.next(i)) - 7;
            const double d = valence(ring.previous(i)) - 7;
            const double cost = std::sqrt(ab * ab + c * c + d * d) / 3;
            if (cost >= least || !network_.can_collapse(gone, ring[i])) continue;
            least = cost;
            best = ring[i];
        }
        return best;
    }

    vcg::Point3d face_normal(VertexId a, VertexId b, VertexId c) const {
        vcg::Point3d n = (positions_[b] - positions_[a]) ^ (positions_[c] - positions_[a]);
        return n.Normalize();
    }

    /// Flips the edges at v that bring the squared distances of the valences from 6 down, where it is flat.
    void regularise(VertexId v) {
        for (int i = 0; i < network_.ring(v).valence; ++i) {
            const VertexId w = network_.ring(v)[i];
            if (!network_.can_flip(v, w)) continue;
            const VertexId c = network_.ring(v).next(i);
            const VertexId d = network_.ring(v).previous(i);
            const auto cost = [&](VertexId x, int change) {
                const int excess = network_.ring(x).valence + change - 6;
                return excess * excess;
            };
            if (cost(v, -1) + cost(w, -1) + cost(c, 1) + cost(d, 1) >=
                cost(v, 0) + cost(w, 0) + cost(c, 0) + cost(d, 0))
                continue;
            bool flat = true;
            for (const vcg::Point3d& old : {face_normal(v, w, c), face_normal(w, v, d)})
                for (const vcg::Point3d& now : {face_normal(v, d, c), face_normal(w, c, d)})
                    flat = flat && old * now >= 0.95;
            if (flat) network_.flip(v, w);
        }
    }

    Network network_;
    LearnerOptions options_;
    Positions positions_;
    std::vector<double> deltas_;
    std::vector<BasicStep> steps_;  ///< of the last batch
    std::vector<bool> won_since_collapse_;
};

}  // namespace neuralmesh::reference
