// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The learning algorithm as one would first write it down: the winner by looking at every vertex, the
// counters decayed one by one, the smoothing by walking over the mesh in double. Slow, and the measure for
// Learner.
#pragma once

#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "vcg_core/mesh/network.h"
#include "vcg_core/settings.h"

namespace neuralmesh::reference {

using Positions = std::vector<vcg::Point3d>;

inline Positions positions_of(const Network& network) {
    Positions result;
    for (VertexId v = 0; v < network.slot_count(); ++v)
        result.push_back(vcg::Point3d::Construct(network.position(v)));
    return result;
}

inline vcg::Point3d& at(Positions& positions, VertexId v) { return positions[static_cast<std::size_t>(v)]; }
inline const vcg::Point3d& at(const Positions& positions, VertexId v) {
    return positions[static_cast<std::size_t>(v)];
}

inline VertexId winner(const Network& network, const Positions& positions, const vcg::Point3d& s) {
    VertexId best = -1;
    for (VertexId v = 0; v < network.slot_count(); ++v)
        if (network.alive(v) &&
            (best < 0 || (at(positions, v) - s).SquaredNorm() < (at(positions, best) - s).SquaredNorm()))
            best = v;
    return best;
}

/// Sum of the unit normals of the faces around v, normalised.
inline vcg::Point3d normal(const Network& network, const Positions& positions, VertexId v) {
    const Ring& ring = network.ring(v);
    vcg::Point3d sum(0, 0, 0);
    for (int i = 0; i < ring.face_count(); ++i) {
        vcg::Point3d n =
            (at(positions, ring[i]) - at(positions, v)) ^ (at(positions, ring.next(i)) - at(positions, v));
        sum += n.Normalize();
    }
    return sum.Normalize();
}

/// One sweep over the ring of \p w, all its inner vertices at once: L_t = L - (L.n) n, n the direction of the
/// area vector of the star. Of a star, the winner and its two neighbours along the winner's ring count where
/// they are now, the others where they were \p before the sweeps: that matters where one of them is in the
/// ring, too (three edges that bound no face), and in a star of three, whose face opposite the winner keeps
/// one old corner.
inline void sweep(const Network& network, Positions& positions, const Positions& before, VertexId w,
                  double alpha_l) {
    const Positions now = positions;
    const Ring& winners = network.ring(w);
    for (int i = 0; i < winners.valence; ++i) {
        const VertexId v = winners[i];
        const Ring& ring = network.ring(v);
        if (ring.open != 0) continue;
        const auto place = [&](VertexId x) {
            return at(x == w || x == winners.previous(i) || x == winners.next(i) ? now : before, x);
        };
        vcg::Point3d mean(0, 0, 0);
        vcg::Point3d area(0, 0, 0);
        for (int j = 0; j < ring.valence; ++j) {
            mean += place(ring[j]) / ring.valence;
            area += place(ring[j]) ^ place(ring.next(j));
        }
        if (ring.valence == 3) {
            // Relative to the winner's old place, for a path that is not closed has an area vector of its own
            // there.
            const vcg::Point3d o = at(before, w);
            const vcg::Point3d a = at(now, winners.previous(i)) - o;
            const vcg::Point3d b = at(now, winners.next(i)) - o;
            const vcg::Point3d b_before = at(before, winners.next(i)) - o;
            const vcg::Point3d p = at(now, w) - o;
            area = (p ^ a) + (a ^ b_before) + (b_before ^ b) + (b ^ p);
        }
        const vcg::Point3d l = mean - at(now, v);
        const double squared = area.SquaredNorm();
        at(positions, v) += (squared > 0 ? l - area * (l * area / squared) : l) * alpha_l;
    }
}

/// eq 1 and the smoothing after it.
inline void basic_step(const Network& network, Positions& positions, VertexId w, const vcg::Point3d& s,
                       const Settings& settings) {
    const Positions before = positions;
    at(positions, w) += (s - at(positions, w)) * settings.learning_rate;
    for (int i = 0; i < settings.smoothing_steps; ++i)
        sweep(network, positions, before, w, settings.smoothing_rate);
}

/// Keeps a network of its own, whose connectivity Network's operations change; decides everything itself.
class ReferenceLearner {
public:
    ReferenceLearner(Network start, const Settings& settings)
        : network_(std::move(start)), settings_(settings), positions_(positions_of(network_)) {
        grow();
    }

    /// All from one state of the network, one after the other on a copy of it; what they move is summed.
    void basic_steps(const std::vector<vcg::Point3f>& signals) {
        steps_.clear();
        Positions sum = positions_;
        for (const vcg::Point3f& signal : signals) {
            const auto s = vcg::Point3d::Construct(signal);
            const VertexId w = reference::winner(network_, positions_, s);
            Positions after = positions_;
            reference::basic_step(network_, after, w, s, settings_);
            const vcg::Point3d turn = normal(network_, after, w) - normal(network_, positions_, w);
            steps_.emplace_back(w, turn.SquaredNorm() / 2);  // eq 2
            for (std::size_t v = 0; v < sum.size(); ++v) sum[v] += after[v] - positions_[v];
        }
        positions_ = sum;
        for (VertexId v = 0; v < network_.slot_count(); ++v)
            network_.set_position(v, vcg::Point3f::Construct(at(positions_, v)));
    }

    void learn_counters(std::size_t step) {
        const VertexId w = steps_[step].first;
        deltas_.push_back(steps_[step].second);
        const auto window = static_cast<std::size_t>(settings_.normalization_window);
        const auto from =
            deltas_.size() > window ? deltas_.end() - settings_.normalization_window : deltas_.begin();
        const double mean =
            std::accumulate(from, deltas_.end(), 0.0) / static_cast<double>(deltas_.end() - from);
        const double n_delta = mean > 0 ? deltas_.back() / mean : 1;  // eq 3
        const auto i = static_cast<std::size_t>(w);
        utility[i] += settings_.utility_counter == kNormalCounter ? n_delta : 1;  // eq 4
        for (double& counter : utility) counter *= settings_.counter_decay;
        feature[i] = settings_.feature_decay * feature[i] + (1 - settings_.feature_decay) * n_delta;  // eq 6
        ++wins[i];
        won_since_collapse_[i] = true;
    }

    bool vertex_split() {
        std::vector<bool> tried(utility.size(), false);
        for (;;) {
            VertexId best = -1;
            for (VertexId v = 0; v < network_.slot_count(); ++v) {
                const auto i = static_cast<std::size_t>(v);
                if (!network_.alive(v) || tried[i] || wins[i] < settings_.min_wins_per_split || wins[i] == 0)
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
            if (settings_.min_wins_per_split != 0) regularise(kept);
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
        positions_.resize(n);
        won_since_collapse_.resize(n, false);
    }

    double area(VertexId v) const {
        const Ring& ring = network_.ring(v);
        double l = 0;
        for (int i = 0; i < ring.valence; ++i)
            l += (at(positions_, ring[i]) - at(positions_, v)).Norm() / ring.valence;
        return l * l;
    }

    bool split(VertexId v) {
        const Ring ring = network_.ring(v);
        const int k = ring.valence;
        int longest = 0;
        for (int i = 1; i < k; ++i)
            if ((at(positions_, ring[i]) - at(positions_, v)).Norm() >
                (at(positions_, ring[longest]) - at(positions_, v)).Norm())
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
        const vcg::Point3d middle = (at(positions_, v) + at(positions_, ring[longest])) / 2;
        const VertexId u = network_.split(v, best_first, best_count, vcg::Point3f::Construct(middle));
        grow();
        at(positions_, u) = middle;
        const auto i = static_cast<std::size_t>(v);
        const auto j = static_cast<std::size_t>(u);
        const double whole = utility[i];  // shared as F_v to F_u (eq 5)
        utility[i] = whole * area(v) / (area(v) + area(u));
        utility[j] = whole - utility[i];
        feature[j] = feature[i];
        wins[i] = wins[j] = 0;
        won_since_collapse_[j] = settings_.min_wins_per_split != 0;
        if (settings_.min_wins_per_split != 0)
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
        vcg::Point3d n = (at(positions_, b) - at(positions_, a)) ^ (at(positions_, c) - at(positions_, a));
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
    Settings settings_;
    Positions positions_;
    std::vector<double> deltas_;
    std::vector<std::pair<VertexId, double>> steps_;  ///< of the last batch: winner, delta
    std::vector<bool> won_since_collapse_;
};

}  // namespace neuralmesh::reference
