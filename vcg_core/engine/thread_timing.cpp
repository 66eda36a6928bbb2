// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/engine/thread_timing.h"

#include <utility>

#include "vcg_core/base/median.h"

namespace neuralmesh {

namespace {

constexpr int kTrial = 24;            ///< batches of each kind in a trial
constexpr int kWarmUp = 8;            ///< of these, not timed: they fill the other core's cache
constexpr int kBetweenTrials = 2048;  ///< batches from the start of one trial to that of the next

}  // namespace

bool ThreadTiming::use_all_threads() const { return batch_ < 2 * kTrial ? batch_ < kTrial : all_are_faster_; }

void ThreadTiming::add_batch(double nanoseconds_per_signal) {
    if (batch_ < 2 * kTrial && batch_ % kTrial >= kWarmUp)
        (use_all_threads() ? all_threads_ : one_thread_).push_back(nanoseconds_per_signal);
    if (++batch_ == 2 * kTrial)
        all_are_faster_ = median(std::move(all_threads_)) < median(std::move(one_thread_));
    if (batch_ == kBetweenTrials) *this = ThreadTiming();
}

}  // namespace neuralmesh
