// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Whether single precision has rounded the coordinates of a cloud: far from the origin it knows a few places
// only.
#pragma once

#include <vcg/space/point3.h>

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace neuralmesh {

/// The longest step between numbers of single precision, over those axes along which most of the cloud spans
/// less than half as many steps as it has points; each axis' step is that at its median. 0 if there is none,
/// or if some coordinate is no number of single precision. \p coordinates_at(i), i in [0, count), as they
/// were read, which is before a matrix moves them; \p lengths: those that the matrix gives the axes. A grid
/// of voxels or pixels has longer steps. O(count).
double float_step(std::size_t count, const std::function<std::array<double, 3>(std::size_t)>& coordinates_at,
                  const std::array<double, 3>& lengths);

/// What steps do to a cloud.
struct SteppedCloud {
    /// Of points in different places, in each cube of four steps that has any. A surface whose points are two
    /// steps apart has more than 2. A grid of four steps has 1, and so have few points for the steps.
    double places_per_cube = 0;
    double area = 0;  ///< of the surface, from the number of cubes: about
};

/// \p step: its length in the units of \p points. Of a sample of cubes. O(points).
SteppedCloud stepped(const std::vector<vcg::Point3f>& points, double step);

}  // namespace neuralmesh
