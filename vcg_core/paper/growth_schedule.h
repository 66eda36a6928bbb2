// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// When splits and collapses are due, and eq 8, which tells that the learning may end.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "vcg_core/paper/constants.h"

namespace neuralmesh {

/// When the steps of growth are due. All arguments count signals since the start of the learning.
class GrowthSchedule {
public:
    /// Keeps a reference to \p constants.
    GrowthSchedule(const LearningConstants& constants, int vertices)
        : constants_(constants), vertices_at_collapse_(vertices) {}

    bool split_due(std::int64_t signals) const { return signals % constants_.signals_per_split == 0; }
    bool collapse_due(std::int64_t signals) const {
        return collapses_ && signals - last_collapse_ >=
                                 std::int64_t{vertices_at_collapse_} * constants_.signals_per_collapse;
    }
    void collapsed(std::int64_t signals, int vertices) {
        last_collapse_ = signals;
        vertices_at_collapse_ = vertices;
    }
    std::int64_t last_collapse() const { return last_collapse_; }
    /// From now on no collapse is due.
    void end_collapses() { collapses_ = false; }
    bool has_ended_collapses() const { return !collapses_; }

private:
    const LearningConstants& constants_;
    std::int64_t last_collapse_ = 0;
    int vertices_at_collapse_;
    bool collapses_ = true;
};

/// Root mean square angle by which a Basic Step turns the winner's normal, over about the last ten signals
/// per vertex.
///
/// It replaces the Mean(n_c) of eq 8, which cannot tell when to stop: its n_delta are normalised (see eq 3),
/// so it stays near 1 for the counters of eq 6, and near 20 / vertices for those of eq 4, however far the
/// mesh has converged. The deltas before normalisation do fall; degrees() is their mean, converted to an
/// angle. In the dialog the bound is called stop_below_mean_counter.
///
class NormalTurn {
public:
    /// The memory is a compromise. A few vertices at the sharpest places have most of the sum, so a mean over
    /// few signals, such as C_delta = 1000, falls below a bound by chance long before the mesh does. A longer
    /// memory lags behind the growth, which doubles the vertices in 100 signals per vertex.
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

}  // namespace neuralmesh
