// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// By how much normals turn while a mesh learns: what eq 8 can be asked of.
#pragma once

#include <algorithm>
#include <cmath>

namespace neuralmesh {

/// The root of the mean square angle by which the winner's normal turns in one Basic Step, over about the
/// last ten signals per vertex.
///
/// This is Mean(n_c) without the normalisation of eq 3, which holds that close to 1 whatever the mesh. The
/// variations are far from equal (a few vertices at the sharpest places have most of the sum), so a mean over
/// the C_delta = 1000 signals of eq 3 falls below a bound by chance long before the mesh does; and a memory
/// of many more signals than these lags behind the growth, which doubles the vertices in 100 signals per
/// vertex.
class NormalTurn {
public:
    static constexpr int kSignalsPerVertex = 10;

    /// \p delta of eq 2, of a signal learned by a mesh of \p vertices. O(1).
    void add(double delta, int vertices) {
        ++signals_;
        const double memory = std::max(1000.0, static_cast<double>(kSignalsPerVertex) * vertices);
        mean_ += (delta - mean_) / std::min(signals_, memory);
    }

    /// 0 before the first signal.
    double degrees() const {
        // delta = 1 - cos(angle), which is angle^2 / 2 for the small angles in question.
        return kDegreesPerRadian * std::sqrt(2 * mean_);
    }

private:
    static constexpr double kDegreesPerRadian = 57.29577951308232;

    double signals_ = 0;
    double mean_ = 0;
};

}  // namespace neuralmesh
