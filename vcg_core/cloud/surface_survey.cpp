// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/cloud/surface_survey.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "vcg_core/base/even_mesh.h"
#include "vcg_core/base/median.h"
#include "vcg_core/base/parallel_for.h"
#include "vcg_core/cloud/depth_steps.h"
#include "vcg_core/cloud/local_quadric.h"

namespace neuralmesh {
namespace {

using vcg::Point3f;
using Place = NearestPoints::Place;

/// The quadrics of neighbouring places, which have 32 points on the least radius, hardly overlap. More places
/// than the most would take longer than .2 s.
constexpr std::size_t kPointsPerPlace = 60, kFewestPlaces = 500, kMostPlaces = 4000;
/// The circle through the seventh neighbour holds seven points.
constexpr int kNeighbour = 7;
constexpr float kPiF = 3.1415927F;
/// Steps of the radius, to eight times at most.
constexpr int kSteps = 7;

std::vector<Place> chosen_places(const NearestPoints& cloud) {
    const std::size_t points = cloud.size();
    const std::size_t wanted =
        std::min(points, std::clamp(points / kPointsPerPlace, kFewestPlaces, kMostPlaces));
    std::vector<Place> chosen;
    for (std::size_t i = 0; i < wanted; ++i)
        chosen.push_back(static_cast<Place>((2 * i + 1) * points / (2 * wanted)));
    return chosen;
}

float spacing_at(const NearestPoints& cloud, Place place, std::vector<NearestPoints::Neighbour>& near) {
    cloud.nearest(place, kNeighbour, near);
    if (near.empty()) return 0;
    return std::sqrt(kPiF * near.back().squared_distance / static_cast<float>(near.size()));
}

/// The least radius on which the points around a place show a surface.
void find_radius(const NearestPoints& cloud, const DepthSteps& steps, std::vector<Point3f>& near,
                 SurveyedPlace& place) {
    place.radius = kLeastSpacings * place.spacing;
    place.deviation = place.radius;
    place.clutter = true;
    for (int step = 0; step < kSteps && place.clutter; ++step) {
        if (step > 0) place.radius *= kGrowth;
        cloud.within(place.position, kSupport * place.radius, kMostForQuadric, near);
        const LocalQuadric quadric = local_quadric(near, place.position, kSupport * place.radius);
        place.rounding =
            quadric.holds() ? steps.deviation(place.position, quadric.normal, place.spacing, near) : 0;
        place.deviation = quadric.holds() ? std::max(quadric.deviation, place.rounding) : place.radius;
        place.normal = quadric.normal;
        place.kurtosis = quadric.kurtosis;
        place.spread = quadric.spread;
        place.on_curve = quadric.width < kNarrow;
        place.clutter = !quadric.holds() || place.on_curve || quadric.flatness > kThick ||
                        kLeastDeviations * place.deviation > place.radius;
    }
}

/// For every place those around it, and itself, whose density is no other.
std::vector<std::vector<Place>> places_around(const NearestPoints& index,
                                              const std::vector<SurveyedPlace>& places, ThreadTeam& team) {
    constexpr int kAtATime = 64;
    // A place is sparser than its surroundings by right if two others are so, too; one alone lies between two
    // depths.
    constexpr int kCompany = 2;
    constexpr float kOtherDensity = 3;  // in spacings
    std::vector<std::vector<Place>> around(places.size());
    parallel_for(static_cast<int>(places.size()), kAtATime, team, [&](int i) {
        std::vector<NearestPoints::Neighbour> near;
        index.nearest(static_cast<Place>(i), kTwoRings, near);
        std::vector<Place> all{static_cast<Place>(i)}, alike = all;
        for (const NearestPoints::Neighbour& n : near) {
            all.push_back(n.place);
            if (kOtherDensity * places[n.place].spacing > places[all.front()].spacing)
                alike.push_back(n.place);
        }
        around[all.front()] = alike.size() > kCompany ? std::move(alike) : std::move(all);
    });
    return around;
}

/// Replaces a number of every place by the median of the places \p around it, which takes out what is chance
/// at one of them. Clutter does not count, since leaves above the ground say nothing of it; where only
/// clutter is around, it does.
void smooth(const std::vector<std::vector<Place>>& around, std::vector<SurveyedPlace>& places,
            float SurveyedPlace::*number) {
    // The median of fewer is one of them.
    constexpr std::size_t kFewest = 3;
    std::vector<float> smoothed, values, orderly;
    for (const std::vector<Place>& of_place : around) {
        values.clear();
        orderly.clear();
        for (const Place other : of_place) {
            values.push_back(places[other].*number);
            if (!places[other].clutter) orderly.push_back(values.back());
        }
        smoothed.push_back(median(orderly.size() >= kFewest ? orderly : values));
    }
    for (std::size_t i = 0; i < places.size(); ++i) places[i].*number = smoothed[i];
}

/// See SurfaceSurvey::sparse_radius().
float radius_of_sparse_part(const std::vector<SurveyedPlace>& places) {
    constexpr double kBelow = 0.75;  // all but a quarter of the surface
    std::vector<float> spacings;
    double all = 0, below = 0;
    for (const SurveyedPlace& p : places) {
        spacings.push_back(p.spacing);
        all += static_cast<double>(p.spacing) * static_cast<double>(p.spacing);
    }
    std::sort(spacings.begin(), spacings.end());
    // All places stand for as many points, so for areas in proportion to their squared spacings.
    for (const float h : spacings)
        if ((below += static_cast<double>(h) * static_cast<double>(h)) >= kBelow * all)
            return kLeastSpacings * h;
    return kLeastSpacings * spacings.back();
}

std::vector<Point3f> positions_of(const NearestPoints& cloud) {
    std::vector<Point3f> positions;
    for (const Place place : chosen_places(cloud)) positions.push_back(cloud.point(place));
    return positions;
}

/// They have 32 runs, and three of these tell the tenth with the least areas.
constexpr std::size_t kFewestPoints = 1024;
/// A cloud is uneven if a fifth of its surface has more than kUneven times the area per point that a tenth of
/// its points have. Even random clouds of the models of tests/experiments/accuracy, 2,000 to 100,000 points
/// with and without noise, have 1.3 to 1.6 times; clouds of density 10:1 have 3.6 to 4.5. The vertices of
/// meshes have 1.1 to 11.
constexpr double kLow = 0.1, kHigh = 0.8;
constexpr float kUneven = 2.5F;
/// Bound on the ratio of an area to the median: the few points of the far end of a room must not draw all
/// signals. Room scans have 1000:1 and more between the percentiles.
constexpr float kMostAreaRatio = 100;

struct Spread {
    float low;     ///< the area that kLow of the points fall short of
    float median;  ///< of the points
    float high;    ///< the area per point in kHigh of the surface
};

Spread spread_of(std::vector<float> areas) {
    std::sort(areas.begin(), areas.end());
    const auto at = [&](double share) {
        return areas[static_cast<std::size_t>(share * static_cast<double>(areas.size()))];
    };
    const double whole = std::accumulate(areas.begin(), areas.end(), 0.0);
    double sum = 0;
    std::size_t i = 0;
    while (i + 1 < areas.size() && sum + static_cast<double>(areas[i]) < kHigh * whole)
        sum += static_cast<double>(areas[i++]);
    return {at(kLow), at(0.5), areas[i]};
}

/// Bounds the areas of runs by their \p median and scales them to 1 in the mean over \p points points.
void normalise(std::vector<float>& of_run, float median, std::size_t points) {
    double sum = 0;
    for (std::size_t r = 0; r < of_run.size(); ++r) {
        of_run[r] = std::min(std::max(of_run[r] / median, 1 / kMostAreaRatio), kMostAreaRatio);
        const std::size_t in_run = std::min(CloudSurvey::kRun, points - r * CloudSurvey::kRun);
        sum += static_cast<double>(of_run[r]) * static_cast<double>(in_run);
    }
    for (float& area : of_run)
        area = static_cast<float>(static_cast<double>(area) * static_cast<double>(points) / sum);
}

}  // namespace

CloudSurvey::CloudSurvey(const std::vector<vcg::Point3f>& points, int threads)
    : cloud(points), squared_spacings((points.size() + kRun - 1) / kRun) {
    constexpr std::size_t kChunk = 32;
    ThreadTeam team(thread_count(threads));
    for_chunks(squared_spacings.size(), kChunk, team, [&](std::size_t, std::size_t begin, std::size_t end) {
        std::vector<NearestPoints::Neighbour> near;
        for (std::size_t run = begin; run < end; ++run) {
            const std::size_t place = std::min<std::size_t>(run * kRun + kRun / 2, cloud.size() - 1);
            cloud.nearest(static_cast<NearestPoints::Place>(place), kNeighbour, near);
            squared_spacings[run] = near.back().squared_distance;
        }
    });
}

std::vector<float> CloudSurvey::areas_if_uneven() const {
    if (cloud.size() < kFewestPoints) return {};
    // The area of a point is its squared spacing, up to a factor. The median of five runs takes out most of
    // what it varies by chance, and single outliers.
    std::vector<float> areas = running_median(squared_spacings);
    const Spread spread = spread_of(areas);
    if (!(spread.high > kUneven * spread.low) || !(spread.median > 0)) return {};
    normalise(areas, spread.median, cloud.size());
    return areas;
}

SurfaceSurvey::SurfaceSurvey(const NearestPoints& cloud, ThreadTeam& team) : index_(positions_of(cloud)) {
    constexpr int kAtATime = 16;
    const std::vector<Place> chosen = chosen_places(cloud);
    const int count = static_cast<int>(index_.size());
    places_.resize(index_.size());
    const auto place = [&](int i) -> SurveyedPlace& { return places_[static_cast<std::size_t>(i)]; };
    parallel_for(count, kAtATime, team, [&](int i) {
        std::vector<NearestPoints::Neighbour> near;
        place(i).place = chosen[index_.index(static_cast<Place>(i))];
        place(i).position = cloud.point(place(i).place);
        place(i).spacing = spacing_at(cloud, place(i).place, near);
    });
    sparse_radius_ = radius_of_sparse_part(places_);
    const std::vector<std::vector<Place>> around = places_around(index_, places_, team);
    smooth(around, places_, &SurveyedPlace::spacing);
    const DepthSteps steps(cloud);
    parallel_for(count, kAtATime, team, [&](int i) {
        std::vector<Point3f> near;
        find_radius(cloud, steps, near, place(i));
    });
    smooth(around, places_, &SurveyedPlace::radius);
    smooth(around, places_, &SurveyedPlace::deviation);
    smooth(around, places_, &SurveyedPlace::rounding);
    std::vector<Point3f> positions;
    for (const SurveyedPlace& p : places_) {
        if (p.clutter) continue;
        orderly_.push_back(static_cast<std::size_t>(&p - places_.data()));
        positions.push_back(p.position);
    }
    if (!positions.empty()) orderly_index_.emplace(positions);
}

double SurfaceSurvey::share(bool SurveyedPlace::*what) const {
    const auto with =
        std::count_if(places_.begin(), places_.end(), [&](const SurveyedPlace& p) { return p.*what; });
    return static_cast<double>(with) / static_cast<double>(places_.size());
}

double SurfaceSurvey::median_of(float SurveyedPlace::*number) const {
    std::vector<float> values;
    for (const SurveyedPlace& p : places_) values.push_back(p.*number);
    return static_cast<double>(median(std::move(values)));
}

LayerFigures SurfaceSurvey::layers() const {
    std::size_t orderly = 0, two = 0;
    for (const SurveyedPlace& p : places_) {
        orderly += p.clutter ? 0 : 1;
        two += !p.clutter && p.two_layers() ? 1 : 0;
    }
    const double sqrt_two = std::sqrt(2.0);  // together the layers are twice as dense as one
    return {2 * two > orderly, 2 * median_of(&SurveyedPlace::spread),
            sqrt_two * median_of(&SurveyedPlace::spacing)};
}

double SurfaceSurvey::noise_in_edges(double points_per_vertex) const {
    std::vector<float> in_spacings;
    for (const SurveyedPlace& p : places_)
        if (!p.clutter && !p.two_layers() && p.spacing > 0) in_spacings.push_back(p.deviation / p.spacing);
    if (in_spacings.empty()) return 0;
    const double spacings_per_edge = std::sqrt(points_per_vertex / kAreaPerVertex);
    return static_cast<double>(median(std::move(in_spacings))) / spacings_per_edge;
}

std::size_t SurfaceSurvey::carried_by(std::size_t points) const {
    double vertices_per_point = 0;
    for (const SurveyedPlace& place : places_) {
        if (place.clutter) continue;
        const auto point = static_cast<double>(place.spacing) * static_cast<double>(place.spacing);
        const double edges = kAreaPerVertex * static_cast<double>(place.least_squared_edge());
        vertices_per_point += point / std::max(static_cast<double>(kPointsPerCarried) * point, edges);
    }
    const double orderly = (1 - clutter()) * static_cast<double>(places_.size());
    return static_cast<std::size_t>(vertices_per_point / orderly * static_cast<double>(points));
}

}  // namespace neuralmesh
