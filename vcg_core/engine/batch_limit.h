// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// How many signals may be taken from one state of the network where few vertices win most of them.
#pragma once

#include <algorithm>
#include <vector>

#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// Watches the batches of Basic Steps. Moves from one state add up: a vertex that wins 17 signals of a batch
/// overshoots their mean (alpha_w = 0.06), its neighbours overshoot theirs at 5, and from twice as many on
/// both swing ever wider. So batches are halved until hardly any vertex wins more than twice in one, and
/// doubled again when that has held for a while. Where signals spread evenly nothing comes of it.
class BatchLimit {
public:
    /// The most signals the next batch should have; at least 1.
    int limit() const { return limit_; }
    /// \p winner has won in the present batch before. O(repeated wins of the batch) at worst.
    void repeated(VertexId winner);
    /// A batch of \p count signals has ended.
    void end_batch(int count);

private:
    static constexpr int kUnlimited = 1 << 20;
    /// Wins of a batch beyond each vertex's second: so many, and one more for every so many signals. In a
    /// long batch of an even cloud there are some, all over the network, and no harm is in them.
    static constexpr int kTolerated = 2, kMostTolerated = 6, kSignalsPerTolerated = 64;
    static constexpr int kCalm = 64;  ///< batches in a row before a longer one is tried

    std::vector<VertexId> repeated_;
    int excess_ = 0;
    int calm_ = 0;
    int limit_ = kUnlimited;
};

inline void BatchLimit::repeated(VertexId winner) {
    if (excess_ > kMostTolerated) return;
    bool third = false;
    for (const VertexId v : repeated_) third = third || v == winner;
    if (third) {
        ++excess_;
    } else {
        repeated_.push_back(winner);
    }
}

inline void BatchLimit::end_batch(int count) {
    if (excess_ > std::min(kTolerated + count / kSignalsPerTolerated, kMostTolerated)) {
        limit_ = count > 1 ? count / 2 : 1;
        calm_ = 0;
    } else if (limit_ < kUnlimited && ++calm_ >= kCalm) {
        limit_ = std::min(2 * limit_, kUnlimited);
        calm_ = 0;
    }
    repeated_.clear();
    excess_ = 0;
}

}  // namespace neuralmesh
