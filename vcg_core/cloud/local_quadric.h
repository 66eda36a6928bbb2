// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A height field of degree 2 through the points around a place: the local surface of a noisy cloud.
#pragma once

#include <vcg/space/point3.h>

#include <cstddef>
#include <vector>

namespace neuralmesh {

/// What the points around a place say of the surface there.
struct LocalQuadric {
    int points = 0;       ///< that it was fitted to; it holds if there are kLeastPoints
    float deviation = 0;  ///< of the points about the quadric, robust, corrected for its six coefficients
    float spread = 0;     ///< of all of them: the root mean square of their distances to the quadric
    /// Fourth moment of these distances over the squared second one: 3 for normal noise, 1 for two layers.
    float kurtosis = 3;
    float flatness = 0;   ///< spread across the plane over the smaller spread along it, 0 to 1
    float width = 0;      ///< smaller spread along the plane over the larger one, 0 to 1; a line has 0
    vcg::Point3f foot;    ///< of the place, along the normal of the plane
    vcg::Point3f normal;  ///< of the quadric at the foot, of length 1, to either side
    static constexpr int kLeastPoints = 12;  ///< two for each coefficient
    bool holds() const { return points >= kLeastPoints; }
};

/// With less width than this the points lie on a line, as on one scan line, and more of them are needed.
constexpr float kNarrow = 0.3F;
/// More points tell no more of six coefficients.
constexpr std::size_t kMostForQuadric = 120;

/// Least squares over the plane of \p points, with weights that fall to a fifth at \p radius from \p
/// place and two passes of Cauchy weights, which take outliers out. Does not hold for fewer than
/// LocalQuadric::kLeastPoints points or where the points lie on a line. O(points).
LocalQuadric local_quadric(const std::vector<vcg::Point3f>& points, const vcg::Point3f& place, float radius);

}  // namespace neuralmesh
