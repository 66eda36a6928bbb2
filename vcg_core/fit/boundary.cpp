// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/boundary.h"

#include <algorithm>
#include <cmath>

#include "vcg_core/base/ablation.h"
#include "vcg_core/base/median.h"
#include "vcg_core/fit/face_rules.h"

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

/// Points per area around every vertex, over two rings. Faces with a boundary edge do not count: the points
/// beyond the boundary are theirs, too. 0 where there are no other faces. O(vertices).
PerVertex<float> inner_density(const Network& network, const Surface& surface, const PointsByFace& points) {
    PerFace<float> counts = points.counts();
    for (int f = 0; f < counts.size(); ++f)
        if (surface.on_boundary(f, 0) || surface.on_boundary(f, 1) || surface.on_boundary(f, 2))
            counts[f] = -1;
    return point_density(network, surface, counts, kSpreads);
}

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

// Chosen by tests/experiments/accuracy/open_table.py.
constexpr float kWidest = -0.2F;      ///< cosine of the widest angle of a notch
constexpr float kNarrowNotch = 0.7F;  ///< cosine of the angle below which a notch need not hold points ...
constexpr float kFewInNotch = 4;      ///< ... if no more than these are expected
constexpr float kLeastShare = 0.5F;   ///< of the points expected
constexpr float kFlatNotch = 0.5F;    ///< least cosine between the normals of the new face and its neighbours

/// The face that would fill the notch at v: v and its neighbours before and after it.
struct Notch {
    Vector3 here, to_before, to_after, area;

    Notch(const Surface& surface, const Ring& ring, VertexId v)
        : here(surface.positions[v]),
          to_before(surface.positions[ring[ring.valence - 1]] - here),
          to_after(surface.positions[ring[0]] - here),
          area(to_before.cross(to_after)) {}

    float cosine() const { return to_before.dot(to_after) / (to_before.norm() * to_after.norm()); }

    bool holds(const Vector3& point) const {
        const Vector3 p = point - here;
        const float before = p.cross(to_after).dot(area);
        const float after = to_before.cross(p).dot(area);
        return before >= 0 && after >= 0 && before + after <= area.squaredNorm();
    }

    bool is_sound(const Surface& surface, const Ring& ring) const {
        const auto at = [&](int i) { return surface.positions[ring[i]]; };
        const int last = ring.valence - 1;
        const Vector3 normal = area.normalized();
        return normal.dot(unit_normal(here, at(0), at(1))) > kFlatNotch &&
               normal.dot(unit_normal(here, at(last - 1), at(last))) > kFlatNotch &&
               triangle_quality(here, at(last), at(0)) > kFlipRules.sliver;
    }
};

bool is_notch(const Network& network, const Surface& surface, const PointsByFace& points, float density,
              VertexId v) {
    if (!network.can_fill_notch(v)) return false;
    const Notch notch(surface, network.ring(v), v);
    if (!(notch.cosine() > kWidest) || !notch.is_sound(surface, network.ring(v))) return false;
    const float expected = density * notch.area.norm() / 2;
    if (notch.cosine() > kNarrowNotch && expected < kFewInNotch) return true;
    int count = 0;
    for (int f : surface.faces_around(v))
        for (const PointsByFace::Assignment& assigned : points.of(f))
            if (is_beyond_boundary(surface, {f, assigned.foot}) && notch.holds(assigned.point)) ++count;
    return count > 0 && static_cast<float>(count) >= kLeastShare * expected;
}

// Tried with tests/experiments/accuracy/open_table.py, one value each.
constexpr int kRingsOfWeb = 3;        ///< of the density
constexpr float kFewestExpected = 8;  ///< fewer say nothing
constexpr float kMostShare = 0.1F;    ///< of the points expected

/// The faces within kRingsOfWeb rings of \p f, rising.
std::vector<int> faces_near(const Surface& surface, int f) {
    std::vector<int> near{f};
    for (int ring = 0; ring < kRingsOfWeb; ++ring) {
        std::vector<int> wider;
        for (const int g : near)
            for (const VertexId v : surface.faces[g])
                wider.insert(wider.end(), surface.faces_around(v).begin(), surface.faces_around(v).end());
        std::sort(wider.begin(), wider.end());
        wider.erase(std::unique(wider.begin(), wider.end()), wider.end());
        near = std::move(wider);
    }
    return near;
}

/// Points per area as most points near face \p f see them: the median, over these points, of the others on
/// the point's face. However large a web is, its faces hardly count, since few points are on them.
float density_near(const Surface& surface, const PointsByFace& points, int f) {
    std::vector<float> seen;
    for (const int g : faces_near(surface, f)) {
        const int count = points.of(g).size();
        const float area = area_vector(surface, g).norm() / 2;
        if (area > 0)
            seen.insert(seen.end(), static_cast<std::size_t>(count), static_cast<float>(count - 1) / area);
    }
    return seen.empty() ? 0 : median(std::move(seen));
}

/// Whether the face lacks the points that the surface around it lets expect. Points whose foot is on an edge
/// lie beyond it, on other surface.
bool is_web(const Surface& surface, const PointsByFace& points, int f) {
    const float expected = density_near(surface, points, f) * area_vector(surface, f).norm() / 2;
    if (!(expected >= kFewestExpected)) return false;
    int count = 0;
    for (const PointsByFace::Assignment& assigned : points.of(f)) {
        const auto& w = assigned.foot.weights;
        if (w[0] > 0 && w[1] > 0 && w[2] > 0) ++count;
    }
    return static_cast<float>(count) <= kMostShare * expected;
}

}  // namespace

std::vector<BoundaryTarget> find_boundary_targets(const Network& network, const Surface& surface,
                                                  const PointsByFace& points) {
    std::vector<BoundaryTarget> targets;
    if (!surface.has_boundary() || skips("boundary_targets")) return targets;
    TargetSearch search(network, surface, points);
    for (VertexId v : network.vertices())
        if (network.ring(v).open != 0) search.add_target(v, targets);
    return targets;
}

std::vector<VertexId> find_notches(const Network& network, const Surface& surface,
                                   const PointsByFace& points) {
    std::vector<VertexId> notches;
    if (!surface.has_boundary() || skips("notches")) return notches;
    const PerVertex<float> density = inner_density(network, surface, points);
    for (VertexId v : network.vertices())
        if (is_notch(network, surface, points, density[v], v)) notches.push_back(v);
    return notches;
}

int fill_notches(Network& network, const std::vector<VertexId>& notches, const PerVertex<char>& barred) {
    PerVertex<char> touched = barred;
    int filled = 0;
    for (VertexId v : notches) {
        if (!network.can_fill_notch(v)) continue;
        const Ring& ring = network.ring(v);
        const Triangle corners{v, ring[0], ring[ring.valence - 1]};
        if (touched[corners[0]] + touched[corners[1]] + touched[corners[2]] > 0) continue;
        for (VertexId u : corners) touched[u] = 1;
        network.fill_notch(v);
        ++filled;
    }
    return filled;
}

int open_webs(Network& network, const Surface& surface, const PointsByFace& points,
              const PerVertex<char>& barred) {
    if (!surface.has_boundary() || skips("webs")) return 0;
    std::vector<VertexId> starts;  // of the boundary edges to look at
    for (const VertexId v : network.vertices())
        if (network.ring(v).open != 0) starts.push_back(v);
    int opened = 0;
    for (std::size_t i = 0; i < starts.size(); ++i) {
        const VertexId v = starts[i];
        if (!network.can_open_face(v)) continue;
        const VertexId after = network.ring(v)[0], corner = network.ring(v)[1];
        if (barred[v] + barred[after] + barred[corner] > 0) continue;
        const int f = corner_of_edge(surface, v, after).face;
        if (f < 0 || !is_web(surface, points, f)) continue;
        network.open_face(v);
        ++opened;
        starts.push_back(v);
        starts.push_back(corner);
    }
    return opened;
}

}  // namespace neuralmesh
