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
/// An edge is divided into parts of at least that many points, up to the height of its face.
constexpr float kPointsPerPart = 12;
/// Each part is at least that many spacings of points wide; in front of shorter edges points are looked for
/// beyond their ends, too.
constexpr float kLeastWidth = 2;
/// Points end at a gap of this many times the mean gap between points that follow each other.
constexpr float kUnlikelyGap = 12;
/// This many of the last points say where they end: the very last one may be an outlier.
constexpr std::size_t kLastPoints = 2;
/// The surface ends at most so many mean gaps beyond the very last point: few points would let it go too far.
constexpr float kMostBeyond = 0.5F;
/// An edge with fewer points than kFewPoints per part has less weight, and none below kTooFewPoints.
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
        face_ = corner_of_edge(surface_, edge_[0], edge_[1]).face;
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
        const float most_parts = std::min(expected / kPointsPerPart, length / least_width);
        const int parts =
            std::clamp(static_cast<int>(std::min(most_parts, 1e6F)), 1, BoundaryTarget::kMostParts);
        const auto count = static_cast<float>(parts);
        beyond_ends_ = std::max(0.0F, (least_width / length - 1) / 2);
        BoundaryTarget target{edge_[0],
                              edge_[1],
                              face_,
                              outward_,
                              length,
                              density,
                              std::min(1.0F, expected / (kFewPoints * count)),
                              parts,
                              {}};
        collect_heights(parts);
        const float most = kMostOffset * std::max(height_, length);
        for (std::size_t i = 0; static_cast<int>(i) < parts; ++i)
            target.offsets[i] =
                std::clamp(end_of(heights_[i], count / (density * std::max(length, least_width))),
                           -kMostOffset * height_, most);
        targets.push_back(target);
    }

private:
    const Vector3& at(std::size_t corner) const { return surface_.positions[edge_[corner]]; }

    /// Distributes the points around the edge's face among the parts, as distances outward from the edge.
    void collect_heights(int parts) {
        for (std::vector<float>& heights : heights_) heights.clear();
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
                const int part = parts == 1 ? 0 : static_cast<int>(share * static_cast<float>(parts));
                heights_[static_cast<std::size_t>(part)].push_back(height);
            }
        }
    }

    /// \param gap mean gap between points that follow each other
    float end_of(std::vector<float>& heights, float gap) const {
        std::sort(heights.begin(), heights.end());
        float last = -height_;
        std::size_t count = 0;
        while (count < heights.size() && heights[count] - last < kUnlikelyGap * gap) last = heights[count++];
        const std::size_t back = std::min(count, kLastPoints);
        if (back == 0) return -height_;
        return std::min(heights[count - back] + static_cast<float>(back) * gap,
                        heights[count - 1] + kMostBeyond * gap);
    }

    const Network& network_;
    const Surface& surface_;
    const PointsByFace& points_;
    const PerVertex<float> density_;
    // Of the present edge:
    Triangle edge_{};  ///< its ends and the vertex opposite
    int face_ = 0;
    Vector3 along_, normal_, outward_;
    float height_ = 0;
    float beyond_ends_ = 0;  ///< points are looked for that far beyond its ends, in its lengths
    std::vector<int> faces_;
    std::array<std::vector<float>, BoundaryTarget::kMostParts> heights_;
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
