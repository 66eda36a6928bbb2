// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Whether a batch runs faster on one thread or on all.
#pragma once

#include <vector>

namespace neuralmesh {

/// Times batches on one thread and on all, periodically, and chooses the faster: it depends on inter-core
/// latency and load. A batch that was interrupted does not decide. The choice does not change what is
/// computed.
class ThreadTiming {
public:
    /// Whether to run the next batch on all threads.
    bool use_all_threads() const;
    /// Reports the duration of that batch.
    void add_batch(double nanoseconds_per_signal);

private:
    int batch_ = 0;                   ///< since the last trial began
    std::vector<double> one_thread_;  ///< the timed batches of the trial, in ns per signal
    std::vector<double> all_threads_;
    bool all_are_faster_ = false;  ///< in the last trial
};

}  // namespace neuralmesh
