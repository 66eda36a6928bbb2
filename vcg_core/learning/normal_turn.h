// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// How much the normals turn while a mesh learns: what termination compares with alpha_t (see eq 8), and
// M_delta, the moving average by which eq 3 normalises.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace neuralmesh {

/// Root mean square angle by which a Basic Step turns the winner's normal, over about the last ten signals
/// per vertex.
///
/// It replaces the Mean(n_c) of eq 8, which cannot tell when to stop: its n_delta are normalised (see eq 3),
/// so it stays near 1 for the counters of eq 6, and near 20 / vertices for those of eq 4, however far the
/// mesh has converged. The deltas before normalisation do fall; degrees() is their mean, converted to an
/// angle. In the dialog the bound is called stop_below_mean_counter.
///
/// The memory of ten signals per vertex is a compromise. A few vertices at the sharpest places have most of
/// the sum, so a mean over few signals, such as C_delta = 1000, falls below a bound by chance long before the
/// mesh does. A longer memory lags behind the growth, which doubles the vertices in 100 signals per vertex.
class NormalTurn {
public:
    static constexpr int kSignalsPerVertex = 10;

    /// Adds the \p delta of a signal (see eq 2) that a mesh of \p vertices vertices has learned. O(1).
    void add(double delta, int vertices) {
        ++signals_;
        const double memory = std::max(kLeastMemory, static_cast<double>(kSignalsPerVertex) * vertices);
        mean_ += (delta - mean_) / std::min(signals_, memory);
    }

    /// 0 before the first signal.
    double degrees() const {
        // delta = 1 - cos(angle), which for small angles is angle^2 / 2.
        return kDegreesPerRadian * std::sqrt(2 * mean_);
    }

private:
    static constexpr double kLeastMemory = 1000;  ///< signals, for small meshes
    static constexpr double kDegreesPerRadian = 57.29577951308232;

    double signals_ = 0;
    double mean_ = 0;
};

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
