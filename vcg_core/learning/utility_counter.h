// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The utility counter: which vertex Vertex Split takes next (the paper's sections 2 and 3).
//
// The paper calls two counters "normal counter". In the code each has one name:
//   utility counter  eq 4 and 5, decays globally, chooses the vertex to split. With n_delta as increment it
//                    is the paper's normal counter, with 1 the signal counter of its predecessors.
//   feature counter  eq 6 and 7, decays per vertex, shown as the vertex quality (feature_counter.h).
#pragma once

#include <cstdint>
#include <vector>

#include "vcg_core/base/platform.h"
#include "vcg_core/engine/scaled_numbers.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/mesh/ring.h"

namespace neuralmesh {

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

}  // namespace neuralmesh
