// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/target/normal_survey.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "vcg_core/base/small_matrices.h"
#include "vcg_core/target/neighbour_scatter.h"

namespace neuralmesh {
namespace {

using vcg::Point3f;
using Place = NearestPoints::Place;

constexpr std::size_t kNormalPlaces = 1000;
constexpr int kNormalNeighbours[] = {12, 36, 108};
/// Points are flat if their variance across the plane is less than this share of the smaller one along it.
constexpr double kFlat = 0.1;
constexpr float kWithin30Degrees = 0.8660254F;
/// Most of the places; random directions fit at 13 % of them.
constexpr double kMostFitting = 0.5;
/// If each normal is flipped with the probability p, 2 p (1 - p) of the pairs are opposite: here p is .15.
constexpr double kMostOpposite = 0.25;
/// Neighbours lower than this over the plane, in their distances, are on its side.
constexpr float kSameSide = 0.3F;
/// So many of the nearest neighbours are compared.
constexpr std::size_t kCompared = 6;

double share(int part, int all) { return all > 0 ? static_cast<double>(part) / all : 0; }

/// The normal of the plane around the point at \p place; nothing if the cloud is not flat there. Fills the
/// neighbours.
std::optional<Point3f> plane_at(const NearestPoints& cloud, Place place,
                                std::vector<NearestPoints::Neighbour>& near) {
    for (const int wanted : kNormalNeighbours) {
        cloud.nearest(place, wanted, near);
        if (near.size() < static_cast<std::size_t>(wanted)) return {};
        const PrincipalAxes principal = principal_axes(neighbour_scatter(cloud, place, near));
        const Eigen::Vector3d& spread = principal.values;
        if (!(spread[0] < kFlat * spread[1])) continue;
        const Eigen::Vector3d n = principal.axes.col(0);
        return Point3f(static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2]));
    }
    return {};
}

/// 1 or -1: the side of the plane that the normal points to. 0: it does not fit.
int side_of(const PackedNormal& normal, const Point3f& plane) {
    const Point3f n = unpacked(normal);
    const float along = n * plane;
    if (!(std::abs(along) >= kWithin30Degrees * n.Norm()) || along == 0) return 0;
    return along > 0 ? 1 : -1;
}

/// Compares the normal at \p place, to \p side of \p plane, with those of its neighbours.
void compare_sides(const NearestPoints& cloud, const std::vector<PackedNormal>& normals, Place place,
                   const std::vector<NearestPoints::Neighbour>& near, const Point3f& plane, int side,
                   NormalSurvey& result) {
    for (std::size_t k = 0; k < std::min(kCompared, near.size()); ++k) {
        const Point3f way = cloud.point(near[k].place) - cloud.point(place);
        if (std::abs(way * plane) > kSameSide * way.Norm()) continue;
        const int other = side_of(normals[cloud.index(near[k].place)], plane);
        if (other == 0) continue;
        ++result.pairs;
        result.opposite += other != side ? 1 : 0;
    }
}

}  // namespace

double NormalSurvey::share_fitting() const { return share(fitting, places); }
double NormalSurvey::share_opposite() const { return share(opposite, pairs); }
bool NormalSurvey::fits() const { return share_fitting() > kMostFitting; }
bool NormalSurvey::has_sides() const { return pairs > 0 && share_opposite() < kMostOpposite; }

NormalSurvey survey_of_normals(const CloudSurvey& survey, const std::vector<PackedNormal>& normals) {
    const NearestPoints& cloud = survey.cloud;
    const std::size_t step = std::max<std::size_t>(1, cloud.size() / kNormalPlaces);
    std::vector<NearestPoints::Neighbour> near;
    NormalSurvey result;
    for (std::size_t i = step / 2; i < cloud.size(); i += step) {
        const auto place = static_cast<Place>(i);
        const PackedNormal& normal = normals[cloud.index(place)];
        if (normal == kNoNormal) continue;
        const std::optional<Point3f> plane = plane_at(cloud, place, near);
        if (!plane) continue;
        ++result.places;
        const int side = side_of(normal, *plane);
        if (side == 0) continue;
        ++result.fitting;
        compare_sides(cloud, normals, place, near, *plane, side, result);
    }
    return result;
}

}  // namespace neuralmesh
