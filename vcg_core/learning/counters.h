// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The counters of the paper's section 3: one number per vertex that says how much its place matters.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// The values at \p order's places, in its order; \p none where that is -1.
template <class T>
std::vector<T> permuted(const std::vector<T>& values, const std::vector<VertexId>& order, T none) {
    std::vector<T> result;
    result.reserve(std::max(values.capacity(), order.size()));
    for (const VertexId v : order) result.push_back(v < 0 ? none : values[static_cast<std::size_t>(v)]);
    return result;
}

/// Mean of the last C_delta values: the paper's M_delta (before eq 3). O(1) per value.
class WindowMean {
public:
    explicit WindowMean(int window) : values_(static_cast<std::size_t>(window), 0.0) {}

    void add(double value);
    /// 0 before the first value.
    double mean() const { return count_ == 0 ? 0 : sum_ / static_cast<double>(count_); }

private:
    std::vector<double> values_;
    std::size_t next_ = 0;
    std::size_t count_ = 0;
    double sum_ = 0;
};

/// The utility counter with its global decay: after every win all counters are multiplied by alpha.
///
/// The decay is exact and lazy. A counter is stored relative to alpha^t, t the number of wins so far, in a
/// number with an unbounded exponent: one double holding exponent + (mantissa - 1), which orders like the
/// value, so that the highest is found by a tournament over those doubles. The exponent takes its share of
/// the 52 bits: at alpha = 0.95 about 35 are left to the mantissa after a million wins, 25 after a billion.
/// No logarithm is taken; the same bits come out on every machine.
class UtilityCounters {
public:
    /// \param decay    alpha_nc, in (0, 1]
    /// \param maturity a vertex is passed over by highest() until it has won this often since its birth
    ///                 or last split
    UtilityCounters(double decay, int maturity) : decay_(decay), maturity_(maturity) {}

    void resize(int slots);
    /// eq 4: adds \p amount (>= 0) to v's counter, then multiplies all counters by alpha. Amortised O(1),
    /// O(log n) at worst.
    void win(VertexId v, double amount);
    /// Brings into the cache what win(v) will touch.
    void prefetch(VertexId v) const {
        const auto i = static_cast<std::size_t>(v);
        __builtin_prefetch(&keys_[i], 1);
        __builtin_prefetch(&wins_[i], 1);
        __builtin_prefetch(&tournament_[0][i], 1);
    }
    /// The counter of v now. 0 for a vertex that never won.
    double value(VertexId v) const;
    /// Wins of v since its birth or last split.
    int wins(VertexId v) const { return wins_[static_cast<std::size_t>(v)]; }
    /// Vertex split, before eq 5: v and its new twin share v's counter as \p of_v to \p of_u; both start to
    /// mature anew. O(log n).
    void share(VertexId v, VertexId u, double of_v, double of_u);
    /// v is gone.
    void remove(VertexId v);
    /// v has been tried in vain: it counts as immature until its next win. O(log n).
    void defer(VertexId v) { enter(v, kNone); }
    /// Vertex order[i] is vertex i from now on, those not named are gone; where order[i] is -1 there is none
    /// yet. O(n).
    void renumber(const std::vector<VertexId>& order);
    /// From now on one win is enough for highest(). Those that never won stay left out. O(n).
    void waive_maturity();
    std::size_t bytes() const;
    /// The mature vertex with the highest counter, the smaller id among equals; -1 if none is mature.
    /// O(log n).
    VertexId highest() const;

private:
    static constexpr double kNone = -1e300;   ///< no entry in the tournament
    static constexpr double kZero = -1e299;   ///< the counter is 0: last, but in
    static constexpr std::size_t kWidth = 8;  ///< children per node: one cache line of doubles

    double scaled(double key) const;
    void enter(VertexId v, double key);
    void raise(VertexId v, double key);

    double decay_;
    int maturity_;
    double unit_mantissa_ = 1;  ///< alpha^-t = unit_mantissa_ x 2^unit_exponent_
    double unit_exponent_ = 0;
    std::vector<double> keys_;
    std::vector<std::int32_t> wins_;
    std::vector<std::vector<double>> tournament_;  ///< [0]: keys of the mature, then maxima of kWidth each
};

/// The feature counter, eq 6: updated for the winner only, never decayed as a whole.
class FeatureCounters {
public:
    explicit FeatureCounters(double decay) : decay_(static_cast<float>(decay)) {}

    void resize(int slots) { values_.resize(static_cast<std::size_t>(slots), 0.0F); }
    /// eq 6: n_c <- alpha_fd n_c + (1 - alpha_fd) n_delta.
    void win(VertexId v, double n_delta) {
        float& n_c = values_[static_cast<std::size_t>(v)];
        n_c = decay_ * n_c + (1 - decay_) * static_cast<float>(n_delta);
    }
    void prefetch(VertexId v) const { __builtin_prefetch(&values_[static_cast<std::size_t>(v)], 1); }
    float value(VertexId v) const { return values_[static_cast<std::size_t>(v)]; }
    /// As UtilityCounters::renumber().
    void renumber(const std::vector<VertexId>& order) { values_ = permuted(values_, order, 0.0F); }
    /// A new vertex starts from its parent's knowledge of the place.
    void inherit(VertexId from, VertexId to) { values_[static_cast<std::size_t>(to)] = value(from); }

private:
    float decay_;
    std::vector<float> values_;
};

}  // namespace neuralmesh
