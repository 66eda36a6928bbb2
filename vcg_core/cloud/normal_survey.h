// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Whether the normals that came with a cloud are those of its surface.
#pragma once

#include <vector>

#include "vcg_core/base/colors_and_normals.h"
#include "vcg_core/cloud/surface_survey.h"

namespace neuralmesh {

/// What the surveyed places of a cloud and their neighbours say about its normals.
struct NormalSurvey {
    int places = 0;    ///< with a normal, where the points show a surface
    int fitting = 0;   ///< of them those whose normal, to either side, is within 30 degrees of the surface's
    int pairs = 0;     ///< of neighbours on the same side of the surface whose normals fit
    int opposite = 0;  ///< of them those whose normals point to different sides

    /// Of the places, those whose normals fit; 0 if there are none.
    double share_fitting() const;
    double share_opposite() const;
    /// Most normals fit.
    bool fits() const;
    /// Neighbours mostly point to the same side. Where parts of the cloud point to different sides, it is so.
    bool has_sides() const;
};

/// \p normals are those of the points that \p surveys are of, kNoNormal where there is none. O(places log n)
NormalSurvey survey_of_normals(Surveys& surveys, const std::vector<PackedNormal>& normals);

}  // namespace neuralmesh
