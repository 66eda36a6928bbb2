// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/boundary_targets.h"

#include <algorithm>
#include <cmath>

#include "vcg_core/base/ablation.h"

namespace neuralmesh {

namespace {

// Chosen by tests/experiments/accuracy/open_table.py.
constexpr int kSpreads = 2;  ///< of the density, over the rings
/// In front of edges shorter than this many spacings of the points, points are looked for beyond their ends,
/// too.
constexpr float kLeastWidth = 2;
/// Points end at a gap of this many times the mean gap between points that follow each other.
constexpr float kUnlikelyGap = 12;
/// This many of the last points say where they end: the very last one may be an outlier.
constexpr std::size_t kLastPoints = 2;
/// The surface ends at most so many mean gaps beyond the very last point: few points would let it go too far.
constexpr float kMostBeyond = 0.5F;
/// An edge with fewer points than kFewPoints has less weight, and none below kTooFewPoints.
constexpr float kFewPoints = 4;
constexpr float kTooFewPoints = 0.5F;
/// Bound on the offsets: inward in heights of the face, outward in its height or its edge.
constexpr float kMostOffset = 0.5F;
/// Points farther from the plane of the face than this share of its height belong to other surface.
constexpr float kAside = 0.5F;
/// Cosine of the angle between an edge's face and faces nearby beyond which their points are not compared.
constexpr float kBent = 0.3F;

/// Finds the target of one edge after the other.
class TargetSearch {
public:
    TargetSearch(const Network& network, const Surface& surface, const PointsByFace& points)
        : network_(network),
          surface_(surface),
          points_(points),
          density_(inner_density(network, surface, points)) {}

    /// Of the boundary edge that begins at \p a.
    void add_target(VertexId a, std::vector<BoundaryTarget>& targets) {
        edge_ = {a, network_.ring(a)[0], network_.ring(a)[1]};
        const Vector3 along = at(1) - at(0);
        const Vector3 area = along.cross(at(2) - at(0));
        const float length = along.norm();
        const float density = (density_[edge_[0]] + density_[edge_[1]]) / 2;
        const float expected = density * area.norm();  // up to the height of the face
        if (!(expected > kTooFewPoints)) return;
        height_ = area.norm() / length;
        along_ = along / (length * length);
        normal_ = area.normalized();
        outward_ = along.cross(normal_).normalized();
        const float least_width = kLeastWidth / std::sqrt(density);
        beyond_ends_ = std::max(0.0F, (least_width / length - 1) / 2);
        collect_heights();
        const float end = end_of(1 / (density * std::max(length, least_width)));
        targets.push_back({edge_[0], edge_[1], outward_, std::min(1.0F, expected / kFewPoints),
                           std::clamp(end, -kMostOffset * height_, kMostOffset * std::max(height_, length))});
    }

private:
    const Vector3& at(std::size_t corner) const { return surface_.positions[edge_[corner]]; }

    /// Of the points around the edge's face, as distances outward from the edge.
    void collect_heights() {
        heights_.clear();
        collect_faces(surface_, edge_, faces_);
        for (int f : faces_) {
            if (normal_.dot(unit_normal(surface_, f)) < kBent) continue;
            for (const PointsByFace::Assignment& assigned : points_.of(f)) {
                const Vector3 p = assigned.point - at(0);
                const float share = p.dot(along_);
                const float height = p.dot(outward_);
                if (share < -beyond_ends_ || share >= 1 + beyond_ends_ || height < -height_ ||
                    std::abs(p.dot(normal_)) > kAside * height_)
                    continue;
                heights_.push_back(height);
            }
        }
    }

    /// \param gap mean gap between points that follow each other
    float end_of(float gap) {
        std::sort(heights_.begin(), heights_.end());
        float last = -height_;
        std::size_t count = 0;
        while (count < heights_.size() && heights_[count] - last < kUnlikelyGap * gap)
            last = heights_[count++];
        const std::size_t back = std::min(count, kLastPoints);
        if (back == 0) return -height_;
        return std::min(heights_[count - back] + static_cast<float>(back) * gap,
                        heights_[count - 1] + kMostBeyond * gap);
    }

    const Network& network_;
    const Surface& surface_;
    const PointsByFace& points_;
    const PerVertex<float> density_;
    // Of the present edge:
    Triangle edge_{};  ///< its ends and the vertex opposite
    Vector3 along_, normal_, outward_;
    float height_ = 0;
    float beyond_ends_ = 0;  ///< points are looked for that far beyond its ends, in its lengths
    std::vector<int> faces_;
    std::vector<float> heights_;
};

}  // namespace

PerVertex<float> inner_density(const Network& network, const Surface& surface, const PointsByFace& points) {
    PerFace<float> counts = points.counts();
    for (int f = 0; f < counts.size(); ++f)
        if (surface.on_boundary(f, 0) || surface.on_boundary(f, 1) || surface.on_boundary(f, 2))
            counts[f] = -1;
    return point_density(network, surface, counts, kSpreads);
}

std::vector<BoundaryTarget> find_boundary_targets(const Network& network, const Surface& surface,
                                                  const PointsByFace& points) {
    std::vector<BoundaryTarget> targets;
    if (!surface.has_boundary() || skips("boundary_targets")) return targets;
    TargetSearch search(network, surface, points);
    for (VertexId v : network.vertices())
        if (network.ring(v).open != 0) search.add_target(v, targets);
    return targets;
}

}  // namespace neuralmesh
