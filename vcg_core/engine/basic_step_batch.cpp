// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/engine/basic_step_batch.h"

#include <algorithm>

namespace neuralmesh {

namespace {

constexpr int kLeastPerThread = 48;  ///< signals: with fewer, synchronisation costs more than a thread saves
/// Networks of this size do not fit into a core's second cache.
constexpr int kLeastOutOfCache = 16384;

}  // namespace

const std::vector<StepResult>& BasicStepBatch::take(const vcg::Point3f* signals, int count,
                                                    const StepRates& rates, Network& network,
                                                    WinnerSearch& search) {
    const int threads = std::clamp(count / kLeastPerThread, 1, team_.members());
    // With several threads, one has moved all vertices, and they are in the cache of its core.
    const bool out_of_cache = threads > 1 || network.vertex_count() >= kLeastOutOfCache;
    const BatchInput input{signals, rates, network, search, out_of_cache};
    for (int part = 0; part < threads; ++part)
        parts_[static_cast<std::size_t>(part)].reserve((count + threads - 1) / threads);
    team_.parallel(threads, [&](int /*member*/, int part) {
        const int first = count * part / threads;
        parts_[static_cast<std::size_t>(part)].compute(input, first, count * (part + 1) / threads - first);
    });
    results_.clear();
    for (int part = 0; part < threads; ++part) apply(parts_[static_cast<std::size_t>(part)], network, search);
    return results_;
}

/// Moves vertices by all displacements, in the order of the signals.
void BasicStepBatch::apply(const ComputedSteps& steps, const Network& network, WinnerSearch& search) {
    for (int k = 0; k < steps.count(); ++k) {
        const Four* by = steps.displacements(k);
        const VertexId winner = steps.winner(k);
        results_.push_back({winner, steps.delta(k)});
        search.move(winner, load_xyz(&network.slots()[winner]) + by[0]);
        for (const VertexId v : network.ring(winner)) search.move(v, load_xyz(&network.slots()[v]) + *++by);
    }
}

}  // namespace neuralmesh
