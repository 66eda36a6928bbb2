// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// What a cloud says of its surface, place by place: how dense and how noisy the points are there, and on
// which scale they show a surface.
#pragma once

#include <vcg/space/point3.h>

#include <cstddef>
#include <optional>
#include <vector>

#include "vcg_core/base/thread_team.h"
#include "vcg_core/cloud/nearest_points.h"

namespace neuralmesh {

/// A cloud indexed by place, with its spacing at samples.
struct CloudSurvey {
    /// The squared distance to the tenth neighbour varies by a third by chance.
    static constexpr int kNeighbour = 10;
    /// It is in the middle of each run of so many consecutive places about what it is in all of the run.
    static constexpr std::size_t kRun = 32;

    /// Of at least two points. Does not depend on \p threads (0: all cores).
    /// O(n log n): 0.015 s for 100,000 points on one thread. Memory: 22 bytes per point.
    CloudSurvey(const std::vector<vcg::Point3f>& points, int threads);

    /// The area that each point of a run stands for, 1 in the mean over the points; empty if their density is
    /// even but for chance, or if they are too few to tell. O(n).
    std::vector<float> areas_if_uneven() const;

    NearestPoints cloud;
    std::vector<float> squared_spacings;  ///< of each run, to neighbour kNeighbour
};

/// Neighbourhoods that are as thick as this beside their width show no surface.
constexpr float kThick = 0.55F;
/// The least radius in spacings, and in deviations: within five of them the points have all heights, and no
/// direction along the surface.
constexpr float kLeastSpacings = 2, kLeastDeviations = 5;
/// A quadric takes the points within so many radii, which grow in steps until these show a surface.
constexpr float kSupport = 1.6F, kGrowth = 1.35F;

/// With fewer points per vertex, learning and fit follow the accidents of the points; a vertex that has to
/// share its points costs more than its absence. Chosen by the points of
/// tests/experiments/accuracy/scan_table.py.
constexpr std::size_t kPointsPerCarried = 2;

/// One of the places that were looked at. Lengths in the frame of the points.
struct SurveyedPlace {
    NearestPoints::Place place = 0;  ///< in the cloud
    vcg::Point3f position;
    vcg::Point3f normal;  ///< of length 1, to either side
    float spacing = 0;    ///< between neighbouring points
    /// Standard deviation of the points about the local surface, a quadric: noise, without the bends of the
    /// surface on scales beyond \p radius. A fifth too low where it is some spacings.
    float deviation = 0;
    /// The least that it can be: the part of the steps of coordinates, see DepthSteps.
    float rounding = 0;
    float radius = 0;       ///< the least on which the points show a surface
    bool clutter = false;   ///< no radius shows one: leaves, grass, points between two depths
    bool on_curve = false;  ///< clutter whose points lie on a line or narrow curve
    float kurtosis = 3;     ///< as in LocalQuadric, on that radius
    float spread = 0;       ///< the same

    /// The points lie in two layers, which this scale does not tell apart. Measured: scans and open and
    /// closed models have a kurtosis of 2.8 to 3, a sheet of two noisy views 1.9, a cup whose wall is as thin
    /// as the points are apart 1.4 to 1.7. Layers closer than a fiftieth of the spacing are rounding.
    bool two_layers() const { return kurtosis < 1.75F && spread > 0.02F * spacing; }

    float variance() const { return deviation * deviation; }
    float rounding_variance() const { return rounding * rounding; }
    /// The square of the shortest edge that is not bent by the noise alone: within so many deviations a
    /// network that learns shows no direction along the surface, as the points do not.
    float least_squared_edge() const { return kLeastDeviations * kLeastDeviations * variance(); }
};

/// Medians over the places of a cloud.
struct LayerFigures {
    bool two = false;      ///< most of the points lie in two layers that cannot be told apart
    double thickness = 0;  ///< then: of the wall, twice their deviation, in the frame of the points
    double spacing = 0;    ///< then: of the points of one layer
};

/// A place for some 60 points, at most 4,000 and at least 500 (or all).
class SurfaceSurvey {
public:
    /// Of the points of \p cloud. Fewer than LocalQuadric::kLeastPoints are clutter. Does not depend on the
    /// number of threads. O(places x neighbours): 0.2 s.
    SurfaceSurvey(const NearestPoints& cloud, ThreadTeam& team);

    const std::vector<SurveyedPlace>& places() const { return places_; }
    /// The surveyed place nearest to \p p. O(log places).
    const SurveyedPlace& at(const vcg::Point3f& p) const { return places_[index_at(p)]; }
    /// The nearest one that shows a surface: the points of clutter say nothing of noise. \pre clutter() < 1
    const SurveyedPlace& orderly_at(const vcg::Point3f& p) const {
        return places_[orderly_[orderly_index_->index(orderly_index_->nearest_to(p))]];
    }
    /// The index of at(\p p) in places().
    std::size_t index_at(const vcg::Point3f& p) const { return index_.nearest_to(p); }
    /// The shares of the places that are clutter, and of those that lie on curves.
    double clutter() const { return share(&SurveyedPlace::clutter); }
    double curves() const { return share(&SurveyedPlace::on_curve); }
    /// The radius, by the spacing alone, that a quarter of the surface exceeds: its sparsest part.
    double sparse_radius() const { return static_cast<double>(sparse_radius_); }
    /// The median of the radii, which spacing and noise determine. O(places)
    double usual_radius() const { return median_of(&SurveyedPlace::radius); }
    LayerFigures layers() const;
    /// Median of the deviations, in edges of an even mesh with so many points for each vertex: 0.1 means that
    /// the points lie a tenth of an edge off the surface. Two layers are no noise. 0 if no place shows a
    /// surface. O(places)
    double noise_in_edges(double points_per_vertex) const;
    /// How many vertices \p points points carry where they show a surface: each with the area of edges that
    /// the noise does not bend, and two points. O(places). \pre clutter() < 1
    std::size_t carried_by(std::size_t points) const;

private:
    double share(bool SurveyedPlace::*what) const;
    double median_of(float SurveyedPlace::*number) const;
    float sparse_radius_ = 0;
    std::vector<SurveyedPlace> places_;  ///< in the order of index_
    NearestPoints index_;
    std::vector<std::size_t> orderly_;  ///< the places that are no clutter
    std::optional<NearestPoints> orderly_index_;
};

/// Both surveys of a cloud, each made when it is first asked for.
class Surveys {
public:
    /// Of \p points, which must stay until points() has been called.
    Surveys(const std::vector<vcg::Point3f>& points, int threads) : given_(points), threads_(threads) {}

    const CloudSurvey& points() {
        if (!points_) points_.emplace(given_, threads_);
        return *points_;
    }
    const SurfaceSurvey& surface() {
        if (!surface_) {
            ThreadTeam team(thread_count(threads_));
            surface_.emplace(points().cloud, team);
        }
        return *surface_;
    }

private:
    const std::vector<vcg::Point3f>& given_;
    int threads_;
    std::optional<CloudSurvey> points_;
    std::optional<SurfaceSurvey> surface_;
};

}  // namespace neuralmesh
