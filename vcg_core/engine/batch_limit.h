// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Limits the batch size when a few vertices win most signals.
#pragma once

#include <algorithm>
#include <vector>

#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// Watches which vertices win in each batch of Basic Steps.
///
/// Displacements computed from one state of the network add up. With alpha_w = 0.06 a vertex that wins 17
/// (1 / alpha_w) signals of a batch overshoots their mean, and its neighbours overshoot at 5 wins; from twice
/// as many wins on, both oscillate with growing amplitude. Vertices side by side do so from two wins each on:
/// those of large faces, beside finer parts of the mesh. So batches are halved until hardly any vertex wins
/// more than twice in one, and hardly any that wins twice has many neighbours that win. They are doubled
/// after 64 such batches in a row. Evenly spread signals are never limited.
class BatchLimit {
public:
    /// Most signals that the next batch should have, at least 1.
    int limit() const { return limit_; }
    /// Reports a win of \p winner, which has won in the present batch before. O(repeated wins of the batch)
    /// at worst.
    void repeated(VertexId winner);
    /// The vertices that have won twice or more in the present batch. Once the batch is too long for the wins
    /// of single vertices, no more are added.
    const std::vector<VertexId>& repeated_winners() const { return repeated_; }
    /// Reports the end of a batch of \p count signals. \p crowded: how many of the repeated winners have
    /// kCrowd neighbours or more that have won, too.
    void end_batch(int count, int crowded);

    static constexpr int kCrowd = 4;  ///< of a vertex's neighbours

private:
    static constexpr int kUnlimited = 1 << 20;
    /// Tolerated wins of a batch beyond each vertex's second: kTolerated, and one more per
    /// kSignalsPerTolerated signals up to kMostTolerated. Long batches of evenly spread signals have a few,
    /// all over the network, which do no harm.
    static constexpr int kTolerated = 2, kMostTolerated = 6, kSignalsPerTolerated = 64;
    static constexpr int kToleratedCrowded = 1;  ///< by chance
    static constexpr int kCalm = 64;  ///< batches in a row without a limit reached before the limit doubles

    std::vector<VertexId> repeated_;  ///< vertices with two wins or more in the present batch
    int excess_ = 0;                  ///< wins of the present batch beyond each vertex's second
    int calm_ = 0;                    ///< batches in a row below the tolerated excess
    int limit_ = kUnlimited;
};

inline void BatchLimit::repeated(VertexId winner) {
    if (excess_ > kMostTolerated) return;
    if (std::find(repeated_.begin(), repeated_.end(), winner) != repeated_.end()) {
        ++excess_;
    } else {
        repeated_.push_back(winner);
    }
}

inline void BatchLimit::end_batch(int count, int crowded) {
    if (crowded > kToleratedCrowded ||
        excess_ > std::min(kTolerated + count / kSignalsPerTolerated, kMostTolerated)) {
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
