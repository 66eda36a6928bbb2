// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Which points a fit uses.
#pragma once

#include <cstddef>
#include <vector>

#include "vcg_core/base/random.h"
#include "vcg_core/mesh/triangle.h"
#include "vcg_core/target/target_space.h"

namespace neuralmesh {

struct PointChoice {
    std::vector<Vector3> fitted;    ///< in random order
    std::vector<Vector3> held_out;  ///< no part of the fit; they measure its error
};

/// Chooses \p wanted points of \p target at random: of a cloud without repetition, at most all of them; of
/// faces at most 2 million or a tenth of \p wanted, whichever is more. One in eight is held out, at most
/// 10,000. O(points of the cloud + wanted).
PointChoice choose_points(const TargetSpace& target, std::size_t wanted, Random& random);

}  // namespace neuralmesh
