// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Where the sensor of a single view stood, from the density of its points.
#pragma once

#include <vcg/space/point3.h>

#include <optional>
#include <vector>

#include "vcg_core/cloud/surface_survey.h"

namespace neuralmesh {

/// A sensor that looks in even steps of angle, as a range camera or a turning scanner does, puts
/// |cos(angle)| / distance^2 points on a unit of area: the angle is that between the normal and the line of
/// sight. The place from which that law leaves the least mean deviation of the logarithm of the density at
/// \p places, if it leaves at most half of what there is without a law; else none: of several views, of a
/// cloud thinned since, of a sensor so far away that the density is even. Within a tenth of the diagonal of
/// the cloud on frames with noise. O(places); 0.05 s.
std::optional<vcg::Point3f> sensor_place(const NearestPoints& cloud,
                                         const std::vector<SurveyedPlace>& places);

}  // namespace neuralmesh
