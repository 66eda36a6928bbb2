// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// When each vertex was last active, for Half-Edge Collapse.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "vcg_core/base/indexed.h"
#include "vcg_core/base/platform.h"
#include "vcg_core/engine/basic_step_batch.h"
#include "vcg_core/engine/batch_limit.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// The number of the signal that each vertex won last, or after which it was born.
class Activity {
public:
    void resize(int slots) { last_active_.resize(slots, 0); }

    /// Records the winners of a batch that starts after \p begin signals, and lets \p limit know which of
    /// them won repeatedly. O(1) per step, O(valence) per repeated winner.
    void record(const std::vector<StepResult>& steps, std::int64_t begin, const Network& network,
                BatchLimit& limit) {
        const auto count = static_cast<int>(steps.size());
        const auto winner = [&](int i) { return steps[static_cast<std::size_t>(i)].winner; };
        for (int i = 0; i < count; ++i) {
            prefetch_for_write(&last_active_[winner(std::min(i + kAhead, count - 1))]);
            std::int64_t& last_active = last_active_[winner(i)];
            if (last_active > begin) limit.repeated(winner(i));
            last_active = begin + i + 1;
        }
        const std::vector<VertexId>& repeated = limit.repeated_winners();
        const auto is_crowded = [&](VertexId v) {
            return active_neighbours(network, v, begin) >= BatchLimit::kCrowd;
        };
        limit.end_batch(count, static_cast<int>(std::count_if(repeated.begin(), repeated.end(), is_crowded)));
    }
    void set(VertexId v, std::int64_t signal) { last_active_[v] = signal; }
    bool active_since(VertexId v, std::int64_t signal) const { return last_active_[v] > signal; }
    /// As UtilityCounters::renumber().
    void renumber(const std::vector<VertexId>& order) {
        last_active_ = permuted(last_active_, order, std::int64_t{0});
    }

private:
    int active_neighbours(const Network& network, VertexId v, std::int64_t signal) const {
        const Ring& ring = network.ring(v);
        return static_cast<int>(
            std::count_if(ring.begin(), ring.end(), [&](VertexId u) { return active_since(u, signal); }));
    }

    static constexpr int kAhead = 8;  ///< steps between the prefetch and the use of an entry

    PerVertex<std::int64_t> last_active_;
};

}  // namespace neuralmesh
