// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// What is said of clouds whose coordinates single precision has rounded: see cloud/float_steps.h.
#pragma once

#include <string>

#include "vcg_core/cloud/target_space.h"

namespace neuralmesh {

/// The warning, if the steps of single precision are longer than .4 spacings of the points; else empty.
/// O(points).
std::string warning_of_rounding(const TargetSpace& target);

/// \throws InputError if these steps are more than twice as long as the edges of a mesh of \p vertices would
/// be, which would be one of steps instead of the surface. O(points).
void refuse_rounding(const TargetSpace& target, int vertices);

}  // namespace neuralmesh
