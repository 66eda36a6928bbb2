// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// What a cloud says of its surface, place by place: how dense and how noisy the points are there, and on which
// scale they show a surface.
#pragma once

#include <vcg/space/point3.h>

#include <vector>

#include "vcg_core/base/thread_team.h"
#include "vcg_core/target/cloud_survey.h"

namespace neuralmesh {

/// One of the places that were looked at. Lengths in the frame of the points.
struct SurveyedPlace {
    vcg::Point3f position;
    vcg::Point3f normal;  ///< of length 1, to either side
    float spacing = 0;    ///< between neighbouring points
    /// Standard deviation of the points about the local surface, a quadric: noise, without the bends of the
    /// surface on scales beyond \p radius.
    float deviation = 0;
    float radius = 0;      ///< the least on which the points show a surface
    bool clutter = false;  ///< no radius shows one: leaves, grass, points between two depths
};

/// A place for some 60 points, at most 4,000 and at least 500 (or all).
class SurfaceSurvey {
public:
    /// Of the points of \p cloud, of which there must be LocalQuadric::kLeastPoints. Does not depend on the
    /// number of threads. O(places x neighbours): 0.2 s.
    SurfaceSurvey(const CloudSurvey& cloud, ThreadTeam& team);

    const std::vector<SurveyedPlace>& places() const { return places_; }
    /// The surveyed place nearest to \p p. O(log places).
    const SurveyedPlace& at(const vcg::Point3f& p) const { return places_[index_.nearest_to(p)]; }
    /// The share of the places that are clutter.
    double clutter() const;

private:
    std::vector<SurveyedPlace> places_;  ///< in the order of index_
    NearestPoints index_;
};

}  // namespace neuralmesh
