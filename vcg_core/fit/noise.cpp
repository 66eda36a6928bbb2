// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/noise.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "vcg_core/base/median.h"
#include "vcg_core/base/parallel_for.h"

namespace neuralmesh {

namespace {

/// Sums over the points of a face: their squared distances from its mean height, and their number less one.
struct Spread {
    float squares = 0;
    float count = 0;
    Spread& operator+=(const Spread& other) {
        squares += other.squares;
        count += other.count;
        return *this;
    }
};

Spread spread_of(const Surface& surface, const PointsByFace& points, int face, const Vector3& normal) {
    float sum = 0;
    float squares = 0;
    for (const PointsByFace::Assignment& a : points.of(face)) {
        const float height = normal.dot(a.point - surface.corner(face, 0));
        sum += height;
        squares += height * height;
    }
    const auto n = static_cast<float>(points.of(face).size());
    return {std::max(0.0F, squares - sum * sum / n), n - 1};
}

// The values are those with which tests/experiments/accuracy/scan_table.py --groups outliers gave the lowest
// backward maximum.

/// The spread is this quantile of the distances, divided by that of the absolute values of a standard normal
/// deviate. The median would not see a crease that takes part of the points.
constexpr float kQuantile = 0.75F;
constexpr float kNormalQuantile = 1.15F;
/// Points closer than this share of the mean edge are not astray: they do not harm, and many of those at
/// creases are farther away than the points around.
constexpr float kLeastEdges = 0.06F;
/// Of so many nearest points, so many must have this share of the height.
constexpr std::size_t kNearest = 8;
constexpr int kCompany = 3;
constexpr float kComparable = 0.3F;
constexpr int kStrayChunk = 128;

float spread_at(const Surface& surface, const PointsByFace& points, VertexId v) {
    std::vector<float> squared;
    for (const int f : surface.faces_around(v))
        for (const PointsByFace::Assignment& a : points.of(f)) squared.push_back(a.foot.squared_distance);
    if (squared.empty()) return 0;
    const auto at =
        squared.begin() + static_cast<std::ptrdiff_t>(kQuantile * static_cast<float>(squared.size()));
    std::nth_element(squared.begin(), at, squared.end());
    return std::sqrt(*at) / kNormalQuantile;
}

}  // namespace

float noise_variance(const Surface& surface, const PointsByFace& points, ThreadTeam& team) {
    constexpr int kMinPoints = 4;  ///< of a face: its variance divides by their number less one
    constexpr int kFacesAtATime = 512;
    const auto find = [&](int f, std::vector<float>& variances) {
        if (points.of(f).size() < kMinPoints) return;
        const Spread spread = spread_of(surface, points, f, unit_normal(surface, f));
        variances.push_back(spread.squares / spread.count);
    };
    std::vector<float> variances = parallel_collect<float>(surface.face_count(), kFacesAtATime, team, find);
    return variances.empty() ? 0.0F : median(std::move(variances));
}

PerVertex<float> local_variances(const Network& network, const Surface& surface, const PointsByFace& points) {
    constexpr int kMinPoints = 3;  ///< fewer than above: the sums are over several faces
    const PerVertex<Vector3> normals = area_vectors_around(network, surface, kRingsOfNormals);
    PerVertex<Spread> spreads(surface.positions.size());
    for (int f = 0; f < surface.face_count(); ++f) {
        if (points.of(f).size() < kMinPoints) continue;
        const Triangle& t = surface.faces[f];
        const Vector3 normal = (normals[t[0]] + normals[t[1]] + normals[t[2]]).normalized();
        const Spread spread = spread_of(surface, points, f, normal);
        for (const VertexId v : t) spreads[v] += spread;
    }
    spread_over_rings(network, spreads, 1);
    PerVertex<float> variances(spreads.size(), 0);
    for (const VertexId v : network.vertices())
        if (spreads[v].count > 0) variances[v] = spreads[v].squares / spreads[v].count;
    return variances;
}

StrayPoints::StrayPoints(const Network& network, const Surface& surface, const PointsByFace& points,
                         float deviations, ThreadTeam& team)
    : surface_(surface), points_(points), limit_(surface.positions.size(), 0) {
    PerVertex<float> spread(surface.positions.size(), 0);
    parallel_for(spread.size(), kStrayChunk, team,
                 [&](VertexId v) { spread[v] = spread_at(surface, points, v); });
    const float least = kLeastEdges * mean_edge_length(surface);
    parallel_for(spread.size(), kStrayChunk, team, [&](VertexId v) {
        if (!network.alive(v)) return;
        // A vertex with few points would take the height of a stray one for the spread; its neighbours do
        // not.
        std::vector<float> around{spread[v]};
        for (const VertexId u : network.ring(v)) around.push_back(spread[u]);
        limit_[v] = std::max(deviations * median(std::move(around)), least);
    });
}

bool StrayPoints::contain(const PointsByFace::Assignment& point, int face) const {
    const Triangle& f = surface_.faces[face];
    const float limit = std::max({limit_[f[0]], limit_[f[1]], limit_[f[2]]});
    return point.foot.squared_distance > limit * limit && !is_beyond_boundary(surface_, {face, point.foot}) &&
           !has_company(point, face);
}

/// The distance from the surface, negative below \p face.
float StrayPoints::height(const PointsByFace::Assignment& point, int face) const {
    const float distance = std::sqrt(point.foot.squared_distance);
    return area_vector(surface_, face).dot(point.point - surface_.corner(face, 0)) < 0 ? -distance : distance;
}

bool StrayPoints::has_company(const PointsByFace::Assignment& point, int face) const {
    struct Near {
        float squared_distance, height;
        bool operator<(const Near& other) const {
            return squared_distance != other.squared_distance ? squared_distance < other.squared_distance
                                                              : height < other.height;
        }
    };
    std::vector<int> faces;
    collect_faces(surface_, surface_.faces[face], faces);
    std::vector<Near> near;
    for (const int f : faces)
        for (const PointsByFace::Assignment& a : points_.of(f))
            if (&a != &point) near.push_back({(a.point - point.point).squaredNorm(), height(a, f)});
    const auto end = near.begin() + static_cast<std::ptrdiff_t>(std::min(near.size(), kNearest));
    std::partial_sort(near.begin(), end, near.end());
    const float own = height(point, face);
    const auto is_comparable = [own](const Near& other) { return other.height / own >= kComparable; };
    return std::count_if(near.begin(), end, is_comparable) >= kCompany;
}

}  // namespace neuralmesh
