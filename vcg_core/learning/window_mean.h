// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// M_delta, the paper's moving average of delta.
#pragma once

#include <cstddef>
#include <vector>

namespace neuralmesh {

/// Mean of the last C_delta values: the paper's M_delta, by which eq 3 normalises. Amortised O(1) per value.
class WindowMean {
public:
    /// \p window is C_delta, at least 1.
    explicit WindowMean(int window) : values_(static_cast<std::size_t>(window), 0.0) {}

    void add(double value) {
        sum_ += value - values_[next_];
        values_[next_] = value;
        if (count_ < values_.size()) ++count_;
        if (++next_ < values_.size()) return;
        next_ = 0;
        // The sum is recomputed once per window: rounding errors do not accumulate, and zeros sum to zero.
        sum_ = 0;
        for (const double v : values_) sum_ += v;
    }
    /// 0 before the first value.
    double mean() const { return count_ == 0 ? 0 : sum_ / static_cast<double>(count_); }

private:
    std::vector<double> values_;
    std::size_t next_ = 0;
    std::size_t count_ = 0;
    double sum_ = 0;
};

}  // namespace neuralmesh
