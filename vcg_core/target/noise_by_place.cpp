// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/target/noise_by_place.h"

#include <algorithm>

#include "vcg_core/base/even_mesh.h"

namespace neuralmesh {
namespace {

/// Within so many deviations a network that learns shows no direction along the surface, as the points do
/// not.
float least_squared_edge(float variance) { return kLeastDeviations * kLeastDeviations * variance; }

std::vector<vcg::Point3f> positions_of(const SurfaceSurvey& survey) {
    std::vector<vcg::Point3f> positions;
    for (const SurveyedPlace& place : survey.places())
        if (!place.clutter) positions.push_back(place.position);
    return positions;
}

}  // namespace

NoiseByPlace::NoiseByPlace(const SurfaceSurvey& survey) : index_(positions_of(survey)) {
    for (const SurveyedPlace& place : survey.places())
        if (!place.clutter)
            noise_.push_back(
                {place.spacing, place.deviation * place.deviation, place.rounding * place.rounding});
}

float NoiseByPlace::least_squared_edge_at(const vcg::Point3f& p) const {
    return least_squared_edge(variance_at(p));
}

std::size_t NoiseByPlace::carried_by(std::size_t points) const {
    double vertices_per_point = 0;
    for (const Noise& noise : noise_) {
        const auto point = static_cast<double>(noise.spacing) * static_cast<double>(noise.spacing);
        const double edges = kAreaPerVertex * static_cast<double>(least_squared_edge(noise.variance));
        vertices_per_point += point / std::max(static_cast<double>(kPointsPerCarried) * point, edges);
    }
    return static_cast<std::size_t>(vertices_per_point / static_cast<double>(noise_.size()) *
                                    static_cast<double>(points));
}

}  // namespace neuralmesh
