// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/target/cloud_noise.h"

#include <algorithm>
#include <cmath>

#include "vcg_core/base/even_mesh.h"
#include "vcg_core/base/median.h"
#include "vcg_core/base/small_matrices.h"
#include "vcg_core/target/neighbour_scatter.h"

namespace neuralmesh {

namespace {

constexpr std::size_t kPlaces = 1000;
/// Fewer neighbours than kFewest make an unsteady plane; more than kMost, of which any number shows the
/// noise, cost time.
constexpr double kFewest = 12;
constexpr double kMost = 60;
constexpr double kPi = 3.141592653589793;

/// Squared spread about the best plane of the point at \p place and its neighbours.
double variance_about_plane(const NearestPoints& cloud, NearestPoints::Place place,
                            const std::vector<NearestPoints::Neighbour>& near) {
    const double count = static_cast<double>(near.size()) + 1;
    const PrincipalAxes spread = principal_axes(neighbour_scatter(cloud, place, near));
    constexpr double kParametersOfAPlane = 3;
    return std::max(0.0, spread.values[0]) / (count - kParametersOfAPlane);
}

}  // namespace

double noise_in_edges(const CloudSurvey& survey, double points_per_vertex) {
    const NearestPoints& cloud = survey.cloud;
    const double neighbours = std::min(std::max(points_per_vertex, kFewest), kMost);
    const std::size_t step = std::max<std::size_t>(1, cloud.size() / kPlaces);
    std::vector<double> squared_ratios;
    std::vector<NearestPoints::Neighbour> near;
    for (std::size_t i = step / 2; i < cloud.size(); i += step) {
        const auto place = static_cast<NearestPoints::Place>(i);
        cloud.nearest(place, static_cast<int>(neighbours), near);
        const double squared_radius = near.empty() ? 0 : static_cast<double>(near.back().squared_distance);
        if (near.size() < static_cast<std::size_t>(kFewest) || !(squared_radius > 0)) continue;
        squared_ratios.push_back(variance_about_plane(cloud, place, near) / squared_radius);
    }
    if (squared_ratios.empty()) return 0;
    // The circle around a place holds its neighbours, a vertex its points; both in proportion to their areas.
    const double squared_radius_in_edges = neighbours / points_per_vertex * kAreaPerVertex / kPi;
    return std::sqrt(median(std::move(squared_ratios)) * squared_radius_in_edges);
}

}  // namespace neuralmesh
