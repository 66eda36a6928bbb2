// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/noise.h"

#include <algorithm>
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

}  // namespace

float noise_variance(const Surface& surface, const PointsByFace& points, ThreadTeam& team) {
    constexpr int kMinPoints = 4;
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
    constexpr int kMinPoints = 3;
    constexpr int kRingsOfNormals = 2;
    constexpr int kSpreads = 1;
    const PerVertex<Vector3> normals = area_vectors_around(network, surface, kRingsOfNormals);
    PerVertex<Spread> spreads(surface.positions.size());
    for (int f = 0; f < surface.face_count(); ++f) {
        if (points.of(f).size() < kMinPoints) continue;
        const Triangle& t = surface.faces[f];
        const Vector3 normal = (normals[t[0]] + normals[t[1]] + normals[t[2]]).normalized();
        const Spread spread = spread_of(surface, points, f, normal);
        for (const VertexId v : t) spreads[v] += spread;
    }
    spread_over_rings(network, spreads, kSpreads);
    PerVertex<float> variances(spreads.size(), 0);
    for (const VertexId v : network.vertices())
        if (spreads[v].count > 0) variances[v] = spreads[v].squares / spreads[v].count;
    return variances;
}

}  // namespace neuralmesh
