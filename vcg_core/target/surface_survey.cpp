// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/target/surface_survey.h"

#include <algorithm>
#include <cmath>

#include "vcg_core/base/median.h"
#include "vcg_core/base/parallel_for.h"
#include "vcg_core/target/local_quadric.h"

namespace neuralmesh {
namespace {

using vcg::Point3f;
using Place = NearestPoints::Place;

constexpr std::size_t kPointsPerPlace = 60, kFewestPlaces = 500, kMostPlaces = 4000;
/// The circle through the seventh neighbour holds seven points.
constexpr int kNeighbour = 7;
constexpr float kPi = 3.1415927F;
/// The median over so many places around takes out what is chance at one of them.
constexpr int kPlacesAround = 12;
/// The least radius in spacings, and in deviations: within five deviations the points have all heights, and no
/// direction along the surface.
constexpr float kLeastSpacings = 2, kLeastDeviations = 5;
/// Neighbourhoods that are as thick as this beside their width show no surface.
constexpr float kThick = 0.55F;
/// A quadric takes the points within this many radii.
constexpr float kSupport = 1.6F;
/// The radius grows by a factor in steps, to eight times at most.
constexpr float kGrowth = 1.35F;
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
    return std::sqrt(kPi * near.back().squared_distance / static_cast<float>(near.size()));
}

/// The least radius on which the points around a place show a surface.
void find_radius(const NearestPoints& cloud, std::vector<Point3f>& near, SurveyedPlace& place) {
    place.radius = kLeastSpacings * place.spacing;
    place.deviation = place.radius;
    place.clutter = true;
    for (int step = 0; step < kSteps && place.clutter; ++step) {
        if (step > 0) place.radius *= kGrowth;
        cloud.within(place.position, kSupport * place.radius, kMostForQuadric, near);
        const LocalQuadric quadric = local_quadric(near, place.position, kSupport * place.radius);
        place.deviation = quadric.holds() ? quadric.deviation : place.radius;
        place.normal = quadric.normal;
        place.clutter = !quadric.holds() || kLeastDeviations * place.deviation > place.radius ||
                        quadric.flatness > kThick;
    }
}

/// Replaces a number of every place by the median of the places around it.
void smooth(const NearestPoints& index, std::vector<SurveyedPlace>& places, float SurveyedPlace::*number,
            ThreadTeam& team) {
    constexpr int kAtATime = 64;
    std::vector<float> smoothed(places.size());
    parallel_for(static_cast<int>(places.size()), kAtATime, team, [&](int i) {
        std::vector<NearestPoints::Neighbour> near;
        index.nearest(static_cast<Place>(i), kPlacesAround, near);
        std::vector<float> values{places[static_cast<std::size_t>(i)].*number};
        for (const NearestPoints::Neighbour& n : near) values.push_back(places[n.place].*number);
        smoothed[static_cast<std::size_t>(i)] = median(std::move(values));
    });
    for (std::size_t i = 0; i < places.size(); ++i) places[i].*number = smoothed[i];
}

std::vector<Point3f> positions_of(const NearestPoints& cloud) {
    std::vector<Point3f> positions;
    for (const Place place : chosen_places(cloud)) positions.push_back(cloud.point(place));
    return positions;
}

}  // namespace

SurfaceSurvey::SurfaceSurvey(const CloudSurvey& survey, ThreadTeam& team)
    : index_(positions_of(survey.cloud)) {
    constexpr int kAtATime = 16;
    const NearestPoints& cloud = survey.cloud;
    const std::vector<Place> chosen = chosen_places(cloud);
    const int count = static_cast<int>(index_.size());
    places_.resize(index_.size());
    const auto place = [&](int i) -> SurveyedPlace& { return places_[static_cast<std::size_t>(i)]; };
    parallel_for(count, kAtATime, team, [&](int i) {
        std::vector<NearestPoints::Neighbour> near;
        place(i).position = index_.point(static_cast<Place>(i));
        place(i).spacing = spacing_at(cloud, chosen[index_.index(static_cast<Place>(i))], near);
    });
    smooth(index_, places_, &SurveyedPlace::spacing, team);
    parallel_for(count, kAtATime, team, [&](int i) {
        std::vector<Point3f> near;
        find_radius(cloud, near, place(i));
    });
    smooth(index_, places_, &SurveyedPlace::radius, team);
    smooth(index_, places_, &SurveyedPlace::deviation, team);
}

double SurfaceSurvey::clutter() const {
    const auto clutter =
        std::count_if(places_.begin(), places_.end(), [](const SurveyedPlace& p) { return p.clutter; });
    return static_cast<double>(clutter) / static_cast<double>(places_.size());
}

}  // namespace neuralmesh
