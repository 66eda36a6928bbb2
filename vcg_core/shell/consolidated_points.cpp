// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/shell/consolidated_points.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "vcg_core/base/parallel_for.h"
#include "vcg_core/target/local_quadric.h"

namespace neuralmesh {
namespace {

using vcg::Point3f;
using Place = NearestPoints::Place;

/// A quadric takes the points within so many surveyed radii, and is fitted again around its own foot.
constexpr float kSupport = 1.6F;
constexpr int kPasses = 2;
/// The survey tells its radius from the median of twelve places, so single ones are noisier.
constexpr float kClutterFactor = 1.5F;

/// The radius above which \p most points are left: discs thrown at random until no more fit cover .55 of a
/// plane, so there are .7 of them per squared radius.
float least_radius(const NearestPoints& cloud, const SurfaceSurvey& survey, int most) {
    constexpr double kPerSquaredRadius = 0.7;
    const double points_per_place =
        static_cast<double>(cloud.size()) / static_cast<double>(survey.places().size());
    const auto left = [&](double radius) {
        double sum = 0;
        for (const SurveyedPlace& place : survey.places()) {
            const double r = std::max(radius, static_cast<double>(place.radius));
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

/// Whether the points around a place are a surface on its surveyed scale.
bool is_surface(const LocalQuadric& quadric, float radius) {
    return quadric.holds() && quadric.flatness < kThick &&
           kLeastDeviations * quadric.deviation < kClutterFactor * radius;
}

}  // namespace

ConsolidatedPoints consolidated_points(const NearestPoints& cloud, const SurfaceSurvey& survey, int most,
                                       Random& random, ThreadTeam& team) {
    constexpr int kAtATime = 64;
    std::vector<float> surveyed(cloud.size());
    parallel_for(static_cast<int>(cloud.size()), 1024, team, [&](int i) {
        surveyed[static_cast<std::size_t>(i)] = survey.at(cloud.point(static_cast<Place>(i))).radius;
    });
    const float least = least_radius(cloud, survey, most);
    std::vector<char> gone(cloud.size(), 0);
    std::vector<Place> kept;
    for (const Place place : shuffled(cloud.size(), random)) {
        if (gone[place] != 0) continue;
        kept.push_back(place);
        cloud.any_within(place, std::max(least, surveyed[place]), [&](Place other) {
            gone[other] = 1;
            return false;
        });
    }
    std::sort(kept.begin(), kept.end());
    std::vector<LocalQuadric> quadrics(kept.size());
    parallel_for(static_cast<int>(kept.size()), kAtATime, team, [&](int i) {
        LocalQuadric& quadric = quadrics[static_cast<std::size_t>(i)];
        const Place place = kept[static_cast<std::size_t>(i)];
        std::vector<Point3f> near;
        Point3f at = cloud.point(place);
        for (int pass = 0; pass < kPasses; ++pass) {
            cloud.within(at, kSupport * surveyed[place], kMostForQuadric, near);
            quadric = local_quadric(near, at, kSupport * surveyed[place]);
            if (!quadric.holds() || (quadric.foot - at).Norm() > surveyed[place]) return;
            at = quadric.foot;
        }
    });
    ConsolidatedPoints result;
    for (std::size_t i = 0; i < kept.size(); ++i) {
        const float radius = surveyed[kept[i]];
        if (!is_surface(quadrics[i], radius)) continue;
        const float spacing = survey.at(quadrics[i].foot).spacing;
        result.positions.push_back(quadrics[i].foot);
        result.normals.push_back(quadrics[i].normal);
        result.radii.push_back(std::max(least, radius));
        result.tolerances.push_back(
            std::max(kLeastSpacings * spacing, kLeastDeviations * quadrics[i].deviation));
    }
    return result;
}

}  // namespace neuralmesh
