// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/support.h"

#include <algorithm>

namespace neuralmesh {

namespace {

// Of faces.
constexpr int kFaceSpreads = 4;
/// A face lacks points if it has less than this share of those that the density gives its area ...
constexpr float kFaceShare = 0.3F;
/// ... and more than this many are missing from that.
constexpr float kFacePseudoPoints = 2;
/// Likely distance of a face without points from the points, in mean edge lengths.
constexpr float kLikelyDistance = 0.25F;
/// A change may add this many missing points per sampled point.
constexpr float kTolerance = 0.5F;
/// Faces with fewer points than kFewOnFace say nothing of the density, so their area may not grow by more
/// than this factor.
constexpr int kFewOnFace = 6;
constexpr float kStretch = 1.02F;

// Of vertices.
constexpr int kVertexSpreads = 2;
constexpr float kVertexShare = 0.7F;
constexpr float kVertexPseudoPoints = 1;

}  // namespace

Support::Support(const Network& network, const Surface& surface, const PointsByFace& points) {
    cost_per_point_ = kLikelyDistance * mean_edge_length(surface);
    cost_per_point_ *= cost_per_point_;
    density_ = point_density(network, surface, points.counts(), kFaceSpreads);
}

float Support::missing_points(const Triangle& face, float twice_area, float points) const {
    const float density = density_[face[0]] + density_[face[1]] + density_[face[2]];
    return std::max(0.0F, kFaceShare / 3 * density * (twice_area / 2) - points - kFacePseudoPoints);
}

float Support::cost_of_change(const Patch& before, const Patch& after, int points_per_sample) const {
    const float rise = after.missing_points - before.missing_points;
    const bool stretched = before.points < kFewOnFace && after.twice_area > kStretch * before.twice_area;
    if (rise > kTolerance * static_cast<float>(points_per_sample) || (stretched && !(rise < 0)))
        return kForbidden;
    return rise < 0 ? rise * cost_per_point_ : 0.0F;
}

PerVertex<float> missing_points_at_vertices(const Network& network, const Surface& surface,
                                            const PointsByFace& points) {
    const int slots = surface.positions.size();
    PerVertex<float> support(slots, 0);
    PerVertex<float> area(slots, 0);
    for (int f = 0; f < surface.face_count(); ++f) {
        const Triangle& face = surface.faces[f];
        // The integral of a squared hat function over a face is a sixth of the area.
        const float share = area_vector(surface, f).norm() / 12;
        for (VertexId v : face) area[v] += share;
        for (const PointsByFace::Assignment& a : points.of(f))
            for (std::size_t k = 0; k < 3; ++k) support[face[k]] += a.foot.weights[k] * a.foot.weights[k];
    }
    PerVertex<float> support_around = support;
    PerVertex<float> area_around = area;
    spread_over_rings(network, support_around, kVertexSpreads);
    spread_over_rings(network, area_around, kVertexSpreads);
    PerVertex<float> missing(slots, 0);
    for (VertexId v = 0; v < slots; ++v) {
        if (!(area_around[v] > 0)) continue;
        const float expected = kVertexShare * area[v] * support_around[v] / area_around[v];
        missing[v] = std::max(0.0F, expected - support[v] - kVertexPseudoPoints);
    }
    return missing;
}

}  // namespace neuralmesh
