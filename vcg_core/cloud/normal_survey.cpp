// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/cloud/normal_survey.h"

#include <cmath>

namespace neuralmesh {
namespace {

using vcg::Point3f;

constexpr float kWithin30Degrees = 0.8660254F;
/// Most of the places; random directions fit at 13 % of them.
constexpr double kMostFitting = 0.5;
/// If each normal is flipped with the probability p, 2 p (1 - p) of the pairs are opposite: here p is .15.
constexpr double kMostOpposite = 0.25;
/// Neighbours lower than this over the surface, in their distances, are on its side.
constexpr float kSameSide = 0.3F;
/// So many of the nearest neighbours are compared.
constexpr int kCompared = 6;

double share(int part, int all) { return all > 0 ? static_cast<double>(part) / all : 0; }

/// 1 or -1: the side of the surface that the normal points to. 0: it does not fit.
int side_of(const PackedNormal& normal, const Point3f& of_surface) {
    const Point3f n = unpacked(normal);
    const float along = n * of_surface;
    if (!(std::abs(along) >= kWithin30Degrees * n.Norm()) || along == 0) return 0;
    return along > 0 ? 1 : -1;
}

/// Compares the normal at \p place, to \p side of its surface, with those of its neighbours.
void compare_sides(const NearestPoints& cloud, const std::vector<PackedNormal>& normals,
                   const SurveyedPlace& place, int side, NormalSurvey& result) {
    std::vector<NearestPoints::Neighbour> near;
    cloud.nearest(place.place, kCompared, near);
    for (const NearestPoints::Neighbour& n : near) {
        const Point3f way = cloud.point(n.place) - place.position;
        if (std::abs(way * place.normal) > kSameSide * way.Norm()) continue;
        const int other = side_of(normals[cloud.index(n.place)], place.normal);
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

NormalSurvey survey_of_normals(Surveys& surveys, const std::vector<PackedNormal>& normals) {
    const NearestPoints& cloud = surveys.points().cloud;
    NormalSurvey result;
    for (const SurveyedPlace& place : surveys.surface().places()) {
        const PackedNormal& normal = normals[cloud.index(place.place)];
        if (normal == kNoNormal || place.clutter) continue;
        ++result.places;
        const int side = side_of(normal, place.normal);
        if (side == 0) continue;
        ++result.fitting;
        compare_sides(cloud, normals, place, side, result);
    }
    return result;
}

}  // namespace neuralmesh
