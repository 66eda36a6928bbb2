// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/engine/slab_schedule.h"

#include <vcg/space/box3.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "vcg_core/base/median.h"

namespace neuralmesh {

namespace {

constexpr int kLeastPerThread = 48;  ///< signals: with fewer, synchronisation costs more than a thread saves

// Of ThreadTiming.
constexpr int kTrial = 24;            ///< batches of each kind in a trial
constexpr int kWarmUp = 8;            ///< of these, not timed: they fill the other core's cache
constexpr int kBetweenTrials = 2048;  ///< batches from the start of one trial to that of the next

}  // namespace

AxisPartition::AxisPartition(const std::vector<vcg::Point3f>& sample) {
    vcg::Box3f box;
    for (const vcg::Point3f& p : sample) box.Add(p);
    axis_ = sample.empty() ? 0 : box.MaxDim();
    for (const vcg::Point3f& p : sample) coordinates_.push_back(p[axis_]);
    std::sort(coordinates_.begin(), coordinates_.end());
    cut(1);
}

void AxisPartition::cut(int count) {
    constexpr float kEnd = std::numeric_limits<float>::infinity();
    const auto slabs = static_cast<std::size_t>(count);
    borders_.assign(slabs + 1, kEnd);
    borders_.front() = -kEnd;
    for (std::size_t i = 1; i < slabs && !coordinates_.empty(); ++i)
        borders_[i] = coordinates_[coordinates_.size() * i / slabs];
}

int AxisPartition::of(const vcg::Point3f& p) const {
    int slab = 0;
    while (!range(slab).holds(p)) ++slab;
    return slab;
}

bool ThreadTiming::use_all_threads() const { return batch_ < 2 * kTrial ? batch_ < kTrial : all_are_faster_; }

void ThreadTiming::add_batch(double nanoseconds_per_signal) {
    if (batch_ < 2 * kTrial && batch_ % kTrial >= kWarmUp)
        (use_all_threads() ? all_threads_ : one_thread_).push_back(nanoseconds_per_signal);
    if (++batch_ == 2 * kTrial)
        all_are_faster_ = median(std::move(all_threads_)) < median(std::move(one_thread_));
    if (batch_ == kBetweenTrials) *this = ThreadTiming();
}

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
