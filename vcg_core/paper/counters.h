// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// What signals leave at the vertices (the paper's sections 2 and 3). The paper calls two counters "normal
// counter". In the code each has one name:
//   utility counter  eq 4 and 5, decays globally, chooses the vertex to split. With n_delta as increment it
//                    is the paper's normal counter, with 1 the signal counter of its predecessors.
//   feature counter  eq 6 and 7, decays per vertex, shown as the vertex quality.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "vcg_core/base/platform.h"
#include "vcg_core/engine/scaled_numbers.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// Mean of the last C_delta values: the paper's M_delta, by which eq 3 normalises. Amortised O(1) per value.
class WindowMean {
public:
    /// \p window is C_delta, at least 1.
    explicit WindowMean(int window) : values_(static_cast<std::size_t>(window), 0.0) {}

    void add(double value) {
        sum_ += value - values_[next_];
        values_[next_] = value;
        if (count_ < values_.size()) ++count_;
        if (++next_ < values_.size()) return;
        next_ = 0;
        // The sum is recomputed once per window: rounding errors do not accumulate, and zeros sum to zero.
        sum_ = 0;
        for (const double v : values_) sum_ += v;
    }
    /// 0 before the first value.
    double mean() const { return count_ == 0 ? 0 : sum_ / static_cast<double>(count_); }

private:
    std::vector<double> values_;
    std::size_t next_ = 0;
    std::size_t count_ = 0;
    double sum_ = 0;
};

/// The utility counters of all vertices. The decay of all counters after each signal costs O(1), see
/// ScaledNumbers.
class UtilityCounters {
public:
    /// \param alpha_nc the decay, in (0, 1]
    /// \param maturity wins since its birth or last split that a vertex needs before highest() returns it
    UtilityCounters(double alpha_nc, int maturity) : alpha_nc_(alpha_nc), maturity_(maturity) {}

    /// New vertices have counter 0 and no wins.
    void resize(int slots);
    /// Adds \p amount (>= 0) to the counter of the winner \p w, then multiplies all counters by alpha_nc.
    /// Amortised O(1), O(log n) at worst.
    void win(VertexId w, double amount);
    /// Prefetches what win(v) accesses.
    void prefetch(VertexId v) const {
        counters_.prefetch(v);
        prefetch_for_write(&wins_[v]);
        tournament_.prefetch(v);
    }
    /// The counter of v. 0 for a vertex that never won.
    double value(VertexId v) const { return counters_.value(v); }
    /// Wins of v since its birth or last split.
    int wins(VertexId v) const { return wins_[v]; }
    /// Divides the counter of v, which was split into v and u, in proportion to F_v and F_u of eq 5. Resets
    /// the wins of both. O(log n).
    void share(VertexId v, VertexId u, double f_v, double f_u);
    /// v has been removed from the network.
    void remove(VertexId v);
    /// Excludes v from highest() until its next win. O(log n).
    void defer(VertexId v) { tournament_.set(v, Tournament::kNone); }
    /// Vertex order[i] gets the id i. Vertices missing from \p order are removed; where order[i] is -1, i is
    /// a free id. O(n).
    void renumber(const std::vector<VertexId>& order);
    /// Makes one win sufficient for highest(), from now on and for all vertices. O(n).
    void waive_maturity();
    /// The mature vertex with the highest counter, the smallest id among equals; -1 if none is mature.
    /// O(log n).
    VertexId highest() const { return tournament_.highest(); }

private:
    double alpha_nc_;
    int maturity_;
    ScaledNumbers counters_;
    PerVertex<std::int32_t> wins_;
    Tournament tournament_;  ///< of the mature vertices
};

/// F_v = l_v^2, l_v the mean length of the edges at v: approximates the area of the Voronoi region of v.
/// O(valence).
double squared_mean_edge(const Network& network, VertexId v);

/// The feature counters of all vertices. A counter changes only when its vertex wins, so those of rarely
/// winning vertices do not decay to 0 as utility counters do.
class FeatureCounters {
public:
    /// \param alpha_fd the weight of a counter's past, in [0, 1)
    explicit FeatureCounters(double alpha_fd) : alpha_fd_(static_cast<float>(alpha_fd)) {}

    /// New vertices have counter 0.
    void resize(int slots) { values_.resize(slots, 0.0F); }
    /// Updates the counter of the winner \p w. \p n_delta is that of eq 3, at least 0. O(1).
    void win(VertexId w, double n_delta) {
        float& n_c = values_[w];
        n_c = alpha_fd_ * n_c + (1 - alpha_fd_) * static_cast<float>(n_delta);  // eq 6
    }
    void prefetch(VertexId v) const { prefetch_for_write(&values_[v]); }
    float value(VertexId v) const { return values_[v]; }
    /// As UtilityCounters::renumber().
    void renumber(const std::vector<VertexId>& order) { values_ = permuted(values_, order, 0.0F); }
    /// A new vertex starts with its parent's counter: it lies in the same place.
    void inherit(VertexId parent, VertexId child) { values_[child] = values_[parent]; }

private:
    float alpha_fd_;
    PerVertex<float> values_;
};

/// The threshold above which a counter marks its vertex as a feature.
/// \param c_nc         the paper's C_nc
/// \param mean_counter Mean(n_c), over the vertices of the mesh
inline double feature_threshold(double c_nc, double mean_counter) {
    return c_nc * mean_counter;  // eq 7
}

}  // namespace neuralmesh
