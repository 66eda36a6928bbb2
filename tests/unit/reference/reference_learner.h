// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The learning algorithm without anything that makes it fast: Basic Steps by basic_step.h, one by
// one and in double, and counters that are decayed one by one. The oracle for Learner.
#pragma once

#include "tests/unit/reference/basic_step.h"
#include "vcg_core/learning/learner_options.h"

namespace neuralmesh::reference {

inline Positions exact_positions_of(const Network& network) {
    Positions result(network.slot_count());
    for (const VertexId v : network.vertices()) result[v] = vcg::Point3d::Construct(network.position(v));
    return result;
}

/// Uses Network's operations to change connectivity, and its own code to decide on them.
class ReferenceLearner {
public:
    ReferenceLearner(Network start, const LearnerOptions& options)
        : network_(std::move(start)), options_(options), positions_(exact_positions_of(network_)) {
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
        const double n_delta = mean > 0 ? deltas_.back() / mean : 1;                          // eq 3
        utility[w] += options_.utility_counter == kNormalVariation ? n_delta : 1;             // eq 4
        for (double& counter : utility) counter *= options_.counter_decay;
        feature[w] = options_.feature_decay * feature[w] + (1 - options_.feature_decay) * n_delta;  // eq 6
        ++wins[w];
        won_since_collapse_[w] = 1;
    }

    bool vertex_split() {
        PerVertex<char> tried(network_.slot_count(), 0);
        for (;;) {
            VertexId best = -1;
            for (const VertexId v : network_.vertices()) {
                if (tried[v] != 0 || wins[v] < options_.min_wins_per_split || wins[v] == 0) continue;
                if (best < 0 || utility[v] > utility[best]) best = v;
            }
            if (best < 0) return false;
            if (split(best)) return true;
            tried[best] = 1;
        }
    }

    int half_edge_collapse() {
        int removed = 0;
        for (const VertexId v : network_.vertices()) {
            if (won_since_collapse_[v] != 0) continue;
            const VertexId kept = cheapest_collapse(v);
            if (kept < 0) continue;
            network_.collapse(v, kept);
            utility[v] = 0;
            wins[v] = 0;
            if (options_.min_wins_per_split != 0) regularise(kept);
            ++removed;
        }
        won_since_collapse_.assign(network_.slot_count(), 0);
        return removed;
    }

    const Network& network() const { return network_; }

    PerVertex<double> utility;
    PerVertex<double> feature;
    PerVertex<int> wins;

private:
    void grow() {
        const int n = network_.slot_count();
        utility.resize(n, 0);
        feature.resize(n, 0);
        wins.resize(n, 0);
        positions_.resize(n, vcg::Point3d(0, 0, 0));
        won_since_collapse_.resize(n, 0);
    }

    /// F_v of eq 5.
    double area(VertexId v) const {
        double l = 0;
        for (const VertexId u : network_.ring(v))
            l += (positions_[u] - positions_[v]).Norm() / network_.ring(v).valence;
        return l * l;
    }

    int longest_edge(VertexId v) const {
        const Ring& ring = network_.ring(v);
        const auto length = [&](int i) { return (positions_[ring[i]] - positions_[v]).Norm(); };
        int longest = 0;
        for (int i = 1; i < ring.valence; ++i)
            if (length(i) > length(longest)) longest = i;
        return longest;
    }

    /// Of all halves of the star around its longest edge, the one with the most regular valences: its first
    /// position in the ring and the number of its edges, 0 if there is none.
    std::pair<int, int> half_star(VertexId v, int longest) const {
        const Ring& ring = network_.ring(v);
        const int k = ring.valence;
        const auto square = [](int x) { return (x - 6) * (x - 6); };
        std::pair<int, int> best(-1, 0);
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
                best = {first, edges + 1};
            }
        return best;
    }

    bool split(VertexId v) {
        const Ring ring = network_.ring(v);
        const int longest = longest_edge(v);
        const auto [first, count] = half_star(v, longest);
        if (count == 0) return false;
        const VertexId ends[] = {ring[first], ring[(first + count - 1) % ring.valence]};
        const vcg::Point3d middle = (positions_[v] + positions_[ring[longest]]) / 2;
        const VertexId u = network_.split(v, first, count, vcg::Point3f::Construct(middle));
        grow();
        positions_[u] = middle;
        const double whole = utility[v];  // eq 5
        utility[v] = whole * area(v) / (area(v) + area(u));
        utility[u] = whole - utility[v];
        feature[u] = feature[v];
        wins[v] = wins[u] = 0;
        won_since_collapse_[u] = options_.min_wins_per_split != 0;
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

    /// Flips edges at v where that lowers the sum of (valence - 6)^2 and the surface is flat.
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
    PerVertex<char> won_since_collapse_;
};

}  // namespace neuralmesh::reference
