// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The steps in which a depth camera measures: along its axis the points lie on planes, which are no surfaces.
#pragma once

#include <vcg/space/point3.h>

#include <array>
#include <vector>

#include "vcg_core/cloud/nearest_points.h"

namespace neuralmesh {

/// The steps of coordinates that take few values. Those of structured light grow with the squared depth: 35
/// mm at 3.5 m, where the points are 6 mm apart. Grids have steps along several axes.
class DepthSteps {
public:
    /// Of the points of \p cloud, in the coordinates of the camera. O(n), with such steps O(n log n).
    explicit DepthSteps(const NearestPoints& cloud);

    /// Standard deviation along the unit vector \p normal of points like \p p, one coordinate of which is
    /// rounded to steps longer than .75 times \p spacing; else 0. So it is where those of the points \p near
    /// it that share its value lie on a line: the surface was cut there, as by contours or by the rings of a
    /// lathe. O(log values + near).
    float deviation(const vcg::Point3f& p, const vcg::Point3f& normal, float spacing,
                    const std::vector<vcg::Point3f>& near) const;

private:
    std::array<std::vector<float>, 3> values_;  ///< that several points have, of each axis, ascending
};

}  // namespace neuralmesh
