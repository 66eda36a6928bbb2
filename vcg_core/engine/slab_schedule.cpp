// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/engine/slab_schedule.h"

#include <algorithm>
#include <numeric>

namespace neuralmesh {

namespace {

constexpr int kLeastPerThread = 48;  ///< signals: with fewer, synchronisation costs more than a thread saves

}  // namespace

void SlabSchedule::begin_batch(int count, Network& network, WinnerSearch& search) {
    const int threads = std::clamp(count / kLeastPerThread, 1, team_.members());
    worth_timing_ = threads > 1;
    if (threads > 1 && (threads > partition_.count() || !assigned_)) {
        if (threads > partition_.count()) {
            partition_.cut(threads);
            const AxisPartition::Range half = partition_.range(threads / 2);
            search.divide_table(half.axis, half.begin);
        }
        assigned_ = true;
        timing_ = ThreadTiming();
        for (const VertexId v : network.vertices()) network.set_tag(v, partition_.of(network.position(v)));
    }
    slabs_ = threads > 1 && timing_.use_all_threads() ? partition_.count() : 1;
    count_ = count;
    begin_ = std::chrono::steady_clock::now();
}

void SlabSchedule::end_batch() {
    const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - begin_;
    if (worth_timing_) timing_.add_batch(taken.count() / count_);
}

int SlabSchedule::signals_in(int slab, const vcg::Point3f* signals, int count, Indexed<int>& indices) const {
    if (slabs_ == 1) {
        std::iota(indices.begin(), indices.begin() + count, 0);
        return count;
    }
    int found = 0;
    int* const to = indices.data();
    const AxisPartition::Range range = partition_.range(slab);
    for (int j = 0; j < count; ++j) {  // without a branch that cannot be predicted
        to[found] = j;
        found += range.holds(signals[j]) ? 1 : 0;
    }
    return found;
}

}  // namespace neuralmesh
