// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Which points a fit uses.
#pragma once

#include <cstddef>
#include <vector>

#include "vcg_core/base/random.h"
#include "vcg_core/cloud/target_space.h"
#include "vcg_core/fit/points_by_face.h"

namespace neuralmesh {

struct PointChoice {
    TrackedPoints fitted;    ///< in random order
    TrackedPoints held_out;  ///< no part of the fit; they measure its error
};

/// Chooses \p wanted points of \p target at random: of a cloud without repetition, at most all of them; of
/// faces at most 2 million or a tenth of \p wanted, whichever is more. One in eight is held out, at most
/// 10,000. Of a weighted cloud, points are chosen evenly over the surface, and the weights of the others make
/// up for those that are too few; their number is then about \p wanted. O(points of the cloud + wanted).
PointChoice choose_points(const TargetSpace& target, std::size_t wanted, Random& random);

}  // namespace neuralmesh
