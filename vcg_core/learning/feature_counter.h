// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The feature counter: how much the surface bends at a vertex (the paper's section 3.1). utility_counter.h
// says how it relates to the paper's other normal counter.
#pragma once

#include <vector>

#include "vcg_core/base/indexed.h"
#include "vcg_core/base/platform.h"
#include "vcg_core/mesh/ring.h"

namespace neuralmesh {

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
