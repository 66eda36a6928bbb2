// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Points of a cloud thinned to the scale on which it is a surface, and put down on that surface.
#pragma once

#include <vcg/space/point3.h>

#include <vector>

#include "vcg_core/base/random.h"
#include "vcg_core/base/thread_team.h"
#include "vcg_core/cloud/surface_survey.h"

namespace neuralmesh {

/// Points of the surface, each at least about its radius from the others and at most two from the next.
struct ConsolidatedPoints {
    std::vector<vcg::Point3f> positions;
    std::vector<vcg::Point3f> normals;  ///< of length 1, to either side
    std::vector<float> radii;
    /// How far points of the surface may lie from it: the least radius by spacing and deviation there.
    std::vector<float> tolerances;

    int size() const { return static_cast<int>(positions.size()); }
};

/// Takes points of \p cloud in random order, drops those within the surveyed radius of each, or within a
/// greater one that leaves about \p most in all, and moves every one that is left to the local quadric.
/// Points around which there is no surface are left out. O(points log points); 0.1 s for 250,000 points.
ConsolidatedPoints consolidated_points(const NearestPoints& cloud, const SurfaceSurvey& survey, int most,
                                       Random& random, ThreadTeam& team);

}  // namespace neuralmesh
