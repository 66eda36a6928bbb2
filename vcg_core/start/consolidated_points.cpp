// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/start/consolidated_points.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "vcg_core/base/parallel_for.h"
#include "vcg_core/cloud/local_quadric.h"

namespace neuralmesh {
namespace {

using vcg::Point3f;
using Place = NearestPoints::Place;

/// A quadric is fitted again around its own foot.
constexpr int kPasses = 2;
/// Steps of the radius, to 2.5 times at most.
constexpr int kSteps = 4;

float thinning_radius(const SurveyedPlace& place) {
    // Without noise points may be closer than the radius of a quadric, which needs a dozen of them.
    constexpr float kSpacings = 1.5F;
    return std::min(place.radius, std::max(kSpacings * place.spacing, kLeastDeviations * place.deviation));
}

/// The radius above which \p most points are left.
float least_radius(const NearestPoints& cloud, const SurfaceSurvey& survey, int most) {
    // Discs thrown at random until no more fit cover .55 of a plane.
    constexpr double kPerSquaredRadius = 0.7;
    const double points_per_place =
        static_cast<double>(cloud.size()) / static_cast<double>(survey.places().size());
    const auto left = [&](double radius) {
        double sum = 0;
        for (const SurveyedPlace& place : survey.places()) {
            const double r = std::max(radius, static_cast<double>(thinning_radius(place)));
            const double h = static_cast<double>(place.spacing);
            sum += kPerSquaredRadius * points_per_place * h * h / (r * r);
        }
        return sum;
    };
    double low = 0, high = 1;
    if (left(low) <= most) return 0;
    for (int i = 0; i < 40; ++i) {
        const double middle = (low + high) / 2;
        (left(middle) > most ? low : high) = middle;
    }
    return static_cast<float>(high);
}

std::vector<Place> shuffled(Place count, Random& random) {
    std::vector<Place> order(count);
    std::iota(order.begin(), order.end(), Place{0});
    for (Place i = count; i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    return order;
}

/// A quadric on the least radius on which the points around a place are a surface.
struct Grounded {
    LocalQuadric quadric;  ///< does not hold where there is none
    float radius = 0;
};

/// Fits a quadric, and again around its foot. \return false if the points are as thick as wide
bool fit_twice(const NearestPoints& cloud, const Point3f& place, float radius, std::vector<Point3f>& near,
               LocalQuadric& quadric) {
    Point3f at = place;
    for (int pass = 0; pass < kPasses; ++pass) {
        cloud.within(at, kSupport * radius, kMostForQuadric, near);
        quadric = local_quadric(near, at, kSupport * radius);
        if (!quadric.holds()) return true;
        if (quadric.flatness > kThick || (quadric.foot - at).Norm() > radius) return false;
        at = quadric.foot;
    }
    return true;
}

/// From \p radius on: it grows where the points are sparser or noisier than the survey, a median, says.
Grounded grounded(const NearestPoints& cloud, const Point3f& place, float radius) {
    std::vector<Point3f> near;
    Grounded result{LocalQuadric(), radius};
    for (int step = 0; step < kSteps; ++step, result.radius *= kGrowth) {
        if (!fit_twice(cloud, place, result.radius, near, result.quadric)) break;
        if (result.quadric.holds() && kLeastDeviations * result.quadric.deviation <= result.radius)
            return result;
    }
    return {LocalQuadric(), radius};
}

}  // namespace

ConsolidatedPoints consolidated_points(const NearestPoints& cloud, const SurfaceSurvey& survey, int most,
                                       Random& random, ThreadTeam& team) {
    constexpr int kAtATime = 64;
    const float least = least_radius(cloud, survey, most);
    std::vector<std::size_t> place_of(cloud.size());
    parallel_for(static_cast<int>(cloud.size()), 1024, team, [&](int i) {
        place_of[static_cast<std::size_t>(i)] = survey.index_at(cloud.point(static_cast<Place>(i)));
    });
    std::vector<char> gone(cloud.size(), 0);
    std::vector<Place> kept;
    for (const Place place : shuffled(cloud.size(), random)) {
        if (gone[place] != 0) continue;
        kept.push_back(place);
        cloud.any_within(cloud.point(place),
                         std::max(least, thinning_radius(survey.places()[place_of[place]])),
                         [&](Place other) {
                             gone[other] = 1;
                             return false;
                         });
    }
    std::sort(kept.begin(), kept.end());
    std::vector<Grounded> found(kept.size());
    parallel_for(static_cast<int>(kept.size()), kAtATime, team, [&](int i) {
        const Place place = kept[static_cast<std::size_t>(i)];
        found[static_cast<std::size_t>(i)] =
            grounded(cloud, cloud.point(place), survey.places()[place_of[place]].radius);
    });
    ConsolidatedPoints result;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const LocalQuadric& quadric = found[i].quadric;
        if (!quadric.holds()) continue;
        const std::size_t place = place_of[kept[i]];
        result.positions.push_back(quadric.foot);
        result.normals.push_back(quadric.normal);
        result.radii.push_back(std::max(least, found[i].radius));
        result.tolerances.push_back(
            std::max(kLeastSpacings * survey.places()[place].spacing, kLeastDeviations * quadric.deviation));
    }
    return result;
}

}  // namespace neuralmesh
