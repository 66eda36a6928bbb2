// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// How much surface each point of an uneven cloud stands for.
#pragma once

#include <vcg/space/point3.h>

#include <cstddef>
#include <optional>
#include <vector>

#include "vcg_core/cloud/cloud_survey.h"

namespace neuralmesh {

/// A cloud in an order in which points near in space mostly come near, and the area that each stands for. One
/// area holds for a run of kRun consecutive points: the squared spacing there.
struct PointAreas {
    static constexpr std::size_t kRun = CloudSurvey::kRun;

    std::vector<vcg::Point3f> points;
    std::vector<float> of_run;  ///< area per point; 1 in the mean over the points
};

/// The areas of the points of \p survey; nothing if their density is even but for chance, or if they are too
/// few to tell. O(n).
std::optional<PointAreas> areas_if_uneven(const CloudSurvey& survey);

}  // namespace neuralmesh
