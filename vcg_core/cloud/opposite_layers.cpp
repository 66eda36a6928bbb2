// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/cloud/opposite_layers.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "vcg_core/base/parallel_for.h"
#include "vcg_core/base/small_matrices.h"
#include "vcg_core/cloud/local_quadric.h"

namespace neuralmesh {
namespace {

using vcg::Point3f;

/// The standard error of a share of so many places is .016 at most.
constexpr std::size_t kLayerPlaces = 1000;
/// In radii of the circle around kTwoRings neighbours: how far the other layer is looked for, and on thin
/// walls, how wide the column is in which it is, and how much of the column is empty between the layers.
constexpr float kFarthest = 10, kThin = 5, kColumn = 0.75F;
/// The other layer has this share of the points that the own layer has in the column, and this many.
constexpr double kLeastShare = 0.3;
constexpr int kLeastPoints = 3;

/// Thicker neighbourhoods, beside their width, are noise, or leaves: layers in them are no sides of a wall.
/// With .55, as clutter of the survey, the noise of a photogrammetric statue showed walls: it was closed all
/// around, and 2 % of its faces cut others.
constexpr double kThickest = 0.4;

/// Sum of the outer products of the differences of the point at \p place and those \p near it to their mean.
Eigen::Matrix3d scatter(const NearestPoints& cloud, NearestPoints::Place place,
                        const std::vector<NearestPoints::Neighbour>& near) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    for (const NearestPoints::Neighbour& n : near) {
        const vcg::Point3f d = cloud.point(n.place) - cloud.point(place);
        const Eigen::Vector3d p(static_cast<double>(d[0]), static_cast<double>(d[1]),
                                static_cast<double>(d[2]));
        sum += p;
        squares += p * p.transpose();
    }
    return squares - sum * sum.transpose() / (static_cast<double>(near.size()) + 1);
}

LayerPlace place_at(const NearestPoints& cloud, NearestPoints::Place place,
                    const std::vector<NearestPoints::Neighbour>& near) {
    const PrincipalAxes principal = principal_axes(scatter(cloud, place, near));
    const Eigen::Vector3d n = principal.axes.col(0), spread = principal.values;
    LayerPlace result;
    result.position = cloud.point(place);
    result.normal = {static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2])};
    // Narrow neighbourhoods are on one scan line, and the plane through them has any direction.
    constexpr auto narrow = static_cast<double>(kNarrow);
    result.flat = spread[0] < kThickest * kThickest * spread[1] && spread[1] > narrow * narrow * spread[2];
    return result;
}

/// The distance of the layer that the first \p count of sorted \p heights over the own layer, which is at 0,
/// show: empty at first and then full. 0: there is none.
float layer_among(const std::vector<float>& heights, std::size_t count, float empty, std::size_t own) {
    std::size_t first = 0;
    float last = 0;
    while (first < count && heights[first] - last < empty) last = heights[first++];
    const std::size_t beyond = count - first;
    const bool full = beyond >= static_cast<std::size_t>(kLeastPoints) &&
                      static_cast<double>(beyond) >= kLeastShare * static_cast<double>(own + first);
    return full ? heights[first] : 0;
}

/// Fills the distances of the opposite layers. \p radius: of the circle around the neighbours
void find_opposite_layers(const NearestPoints& cloud, float radius, LayerPlace& result) {
    const float squared_column = kColumn * kColumn * radius * radius;
    const float squared_farthest = kFarthest * radius * kFarthest * radius;
    std::vector<float> above, below;
    cloud.along(result.position, result.normal, kFarthest * radius, kColumn * radius, [&](const Point3f& p) {
        const Point3f d = p - result.position;
        const float height = d * result.normal;
        if (d.SquaredNorm() <= squared_farthest && d.SquaredNorm() - height * height < squared_column)
            (height > 0 ? above : below).push_back(std::abs(height));
    });
    std::sort(above.begin(), above.end());
    std::sort(below.begin(), below.end());
    const auto up_to = [&](const std::vector<float>& heights, float height) {
        return static_cast<std::size_t>(std::lower_bound(heights.begin(), heights.end(), height) -
                                        heights.begin());
    };
    const auto layer = [&](const std::vector<float>& heights, const std::vector<float>& others,
                           float farthest) {
        return layer_among(heights, up_to(heights, farthest * radius), kColumn * radius,
                           up_to(others, kColumn * radius));
    };
    result.above = layer(above, below, kFarthest);
    result.below = layer(below, above, kFarthest);
    result.on_thin_wall = result.flat && (layer(above, below, kThin) > 0 || layer(below, above, kThin) > 0);
}

}  // namespace

std::vector<LayerPlace> layer_places(const NearestPoints& cloud, ThreadTeam& team) {
    constexpr int kPlacesAtATime = 16;
    const std::size_t step = std::max<std::size_t>(1, cloud.size() / kLayerPlaces);
    const std::size_t count = (cloud.size() + step - 1 - step / 2) / step;
    return parallel_collect<LayerPlace>(
        static_cast<int>(count), kPlacesAtATime, team, [&](int i, std::vector<LayerPlace>& places) {
            const auto place =
                static_cast<NearestPoints::Place>(step / 2 + static_cast<std::size_t>(i) * step);
            std::vector<NearestPoints::Neighbour> near;
            cloud.nearest(place, kTwoRings, near);
            if (near.size() < static_cast<std::size_t>(kTwoRings)) return;
            LayerPlace found = place_at(cloud, place, near);
            find_opposite_layers(cloud, std::sqrt(near.back().squared_distance), found);
            places.push_back(found);
        });
}

double share_on_thin_walls(const std::vector<LayerPlace>& places, Surveys& surveys) {
    if (places.empty()) return 0;
    const SurfaceSurvey& survey = surveys.surface();
    const auto with = std::count_if(places.begin(), places.end(), [&](const LayerPlace& place) {
        if (!place.on_thin_wall) return false;
        const SurveyedPlace& surface = survey.at(place.position);
        const bool above = place.above > 0 && (place.below == 0 || place.above < place.below);
        return surface.radius < (above ? place.above : place.below) || surface.two_layers();
    });
    return static_cast<double>(with) / static_cast<double>(places.size());
}

}  // namespace neuralmesh
