// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/target/opposite_layers.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "vcg_core/target/neighbour_scatter.h"

namespace neuralmesh {
namespace {

using vcg::Point3f;

constexpr std::size_t kPlaces = 500;
constexpr int kNeighbours = 12;
/// In radii of the circle around the neighbours, which is about two spacings wide: how far the other layer is
/// looked for, how wide the column is in which it is, and how much of the column is empty between the layers.
constexpr float kFarthest = 5, kColumn = 0.75F, kEmpty = 0.75F;
/// The other layer has this share of the points that the own layer has in the column, and this many.
constexpr double kLeastShare = 0.3;
constexpr int kLeastPoints = 3;

Point3f normal_of(const NearestPoints& cloud, NearestPoints::Place place,
                  const std::vector<NearestPoints::Neighbour>& near) {
    const Eigen::Matrix3d scatter = neighbour_scatter(cloud, place, near);
    const Eigen::Vector3d n = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors().col(0);
    return {static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2])};
}

/// Whether sorted \p heights over the own layer, which is at 0, are empty at first and then full.
bool shows_layer(const std::vector<float>& heights, float empty, std::size_t own) {
    std::size_t first = 0;
    float last = 0;
    while (first < heights.size() && heights[first] - last < empty) last = heights[first++];
    const std::size_t beyond = heights.size() - first;
    return beyond >= static_cast<std::size_t>(kLeastPoints) &&
           static_cast<double>(beyond) >= kLeastShare * static_cast<double>(own + first);
}

bool has_opposite_layer(const NearestPoints& cloud, NearestPoints::Place place,
                        std::vector<NearestPoints::Neighbour>& near) {
    cloud.nearest(place, kNeighbours, near);
    if (near.size() < static_cast<std::size_t>(kNeighbours)) return false;
    const float radius = std::sqrt(near.back().squared_distance);
    const Point3f normal = normal_of(cloud, place, near);
    const float squared_column = kColumn * kColumn * radius * radius;
    std::vector<float> above, below;
    cloud.any_within(place, kFarthest * radius, [&](NearestPoints::Place other) {
        const Point3f d = cloud.point(other) - cloud.point(place);
        const float height = d * normal;
        if (d.SquaredNorm() - height * height < squared_column)
            (height > 0 ? above : below).push_back(std::abs(height));
        return false;
    });
    std::sort(above.begin(), above.end());
    std::sort(below.begin(), below.end());
    const auto near_plane = [&](const std::vector<float>& heights) {
        return static_cast<std::size_t>(std::lower_bound(heights.begin(), heights.end(), kEmpty * radius) -
                                        heights.begin());
    };
    return shows_layer(above, kEmpty * radius, near_plane(below)) ||
           shows_layer(below, kEmpty * radius, near_plane(above));
}

}  // namespace

double share_with_opposite_layer(const CloudSurvey& survey) {
    const NearestPoints& cloud = survey.cloud;
    const std::size_t step = std::max<std::size_t>(1, cloud.size() / kPlaces);
    std::vector<NearestPoints::Neighbour> near;
    std::size_t places = 0, with = 0;
    for (std::size_t i = step / 2; i < cloud.size(); i += step, ++places)
        with += has_opposite_layer(cloud, static_cast<NearestPoints::Place>(i), near) ? 1 : 0;
    return places == 0 ? 0 : static_cast<double>(with) / static_cast<double>(places);
}

}  // namespace neuralmesh
