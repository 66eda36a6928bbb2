// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Clouds whose coordinates single precision has rounded: far from the origin it knows a few places only.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>

#include "vcg_core/cloud/target_space.h"

namespace neuralmesh {

/// The longest step between numbers of single precision, over those axes along which most of the cloud spans
/// less than half as many steps as it has points; each axis' step is that at its median. 0 if there is none,
/// or if some coordinate is no number of single precision. \p coordinates_at(i), i in [0, count), as they
/// were read, which is before a matrix moves them; \p lengths: those that the matrix gives the axes. A grid
/// of voxels or pixels has longer steps. O(count).
double float_step(std::size_t count, const std::function<std::array<double, 3>(std::size_t)>& coordinates_at,
                  const std::array<double, 3>& lengths);

/// The warning, if the steps of single precision are longer than .4 spacings of the points; else empty.
/// O(points log points).
std::string warning_of_rounding(const TargetSpace& target);

/// \throws InputError if these steps are more than twice as long as the edges of a mesh of \p vertices would
/// be, which would be one of steps instead of the surface. O(points log points).
void refuse_rounding(const TargetSpace& target, int vertices);

}  // namespace neuralmesh
