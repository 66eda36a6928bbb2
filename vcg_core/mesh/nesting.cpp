// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/mesh/nesting.h"

#include <vcg/space/box3.h>

#include <algorithm>
#include <cstddef>

namespace neuralmesh {
namespace {

using vcg::Point3d;

/// Of so many places of a component most are within another, or are not. An odd number.
constexpr std::size_t kPlaces = 9;

/// Twice the signed area of a triangle, seen along the x axis. Exact but for the last sum.
double area_along_x(const Point3d& a, const Point3d& b, const Point3d& c) {
    return (b[1] - a[1]) * (c[2] - a[2]) - (c[1] - a[1]) * (b[2] - a[2]);
}

/// Whether the line from \p p along the x axis passes the edge of \p a and \p b on its left, seen along the
/// axis. Depends on no order of the two, so that of two faces at the edge one is hit, also if it is met.
bool passes(const Point3d& p, const Point3d& a, const Point3d& b) {
    if ((a[1] > p[1]) == (b[1] > p[1])) return false;
    return (a[1] < b[1] ? area_along_x(a, b, p) : area_along_x(b, a, p)) > 0;
}

/// Whether the ray from \p p along the x axis hits the face \p a \p b \p c.
bool hits(const Point3d& p, const Point3d& a, const Point3d& b, const Point3d& c) {
    const int edges = (passes(p, a, b) ? 1 : 0) + (passes(p, b, c) ? 1 : 0) + (passes(p, c, a) ? 1 : 0);
    if (edges % 2 == 0) return false;
    const Point3d normal = (b - a) ^ (c - a);
    if (normal[0] == 0) return false;
    return (normal * (a - p)) / normal[0] > 0;
}

}  // namespace

std::vector<int> nesting_depths(const Network& network, const PerVertex<int>& component, int count) {
    const auto components = static_cast<std::size_t>(count);
    std::vector<int> depths(components, 0);
    if (count < 2) return depths;
    const auto of = [&](VertexId v) { return static_cast<std::size_t>(component[v]); };
    const auto at = [&](VertexId v) { return Point3d::Construct(network.position(v)); };
    std::vector<vcg::Box3d> boxes(components);
    std::vector<char> open(components, 0);
    std::vector<std::vector<Triangle>> faces(components);
    std::vector<std::vector<VertexId>> vertices(components);
    for (const VertexId v : network.vertices()) {
        vertices[of(v)].push_back(v);
        boxes[of(v)].Add(at(v));
        if (network.ring(v).open != 0) open[of(v)] = 1;
    }
    for (const Triangle& f : network.faces()) faces[of(f[0])].push_back(f);
    const auto is_within = [&](const Point3d& p, std::size_t j) {
        if (!boxes[j].IsIn(p)) return false;
        const auto hit = std::count_if(faces[j].begin(), faces[j].end(), [&](const Triangle& f) {
            return hits(p, at(f[0]), at(f[1]), at(f[2]));
        });
        return hit % 2 != 0;
    };
    for (std::size_t i = 0; i < components; ++i)
        for (std::size_t j = 0; j < components; ++j) {
            if (j == i || open[j] != 0) continue;
            std::size_t within = 0;
            for (std::size_t k = 0; k < kPlaces; ++k)
                within += is_within(at(vertices[i][k * vertices[i].size() / kPlaces]), j) ? 1 : 0;
            depths[i] += within > kPlaces / 2 ? 1 : 0;
        }
    return depths;
}

}  // namespace neuralmesh
