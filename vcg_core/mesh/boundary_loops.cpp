// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/mesh/boundary_loops.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace neuralmesh {
namespace {

using vcg::Point3f;
using Edge = std::pair<VertexId, VertexId>;

Edge edge(VertexId a, VertexId b) { return {std::min(a, b), std::max(a, b)}; }

/// Cosine of the angle at \p b.
float cosine_at(const Point3f& a, const Point3f& b, const Point3f& c) {
    const Point3f p = a - b, q = c - b;
    const float lengths = std::sqrt(p.SquaredNorm() * q.SquaredNorm());
    return lengths > 0 ? p * q / lengths : -1.0F;
}

/// The edges of \p faces between two vertices of \p loop.
std::set<Edge> edges_within(std::vector<VertexId> loop, const std::vector<Triangle>& faces) {
    std::set<Edge> edges;
    std::sort(loop.begin(), loop.end());
    const auto holds = [&loop](VertexId v) { return std::binary_search(loop.begin(), loop.end(), v); };
    for (const Triangle& f : faces)
        for (std::size_t k = 0; k < 3; ++k)
            if (holds(f[k]) && holds(f[(k + 1) % 3])) edges.insert(edge(f[k], f[(k + 1) % 3]));
    return edges;
}

}  // namespace

std::vector<std::vector<VertexId>> boundary_loops(int vertices, const std::vector<Triangle>& faces) {
    // An edge in two faces is there in both directions. On a boundary each vertex has one edge that leaves
    // it.
    std::vector<Edge> edges;
    edges.reserve(3 * faces.size());
    for (const Triangle& f : faces)
        for (std::size_t k = 0; k < 3; ++k) edges.emplace_back(f[k], f[(k + 1) % 3]);
    std::sort(edges.begin(), edges.end());
    PerVertex<VertexId> next(vertices, -1);
    for (const auto& [a, b] : edges)
        if (!std::binary_search(edges.begin(), edges.end(), Edge(b, a))) next[a] = b;
    std::vector<std::vector<VertexId>> loops;
    for (VertexId start = 0; start < vertices; ++start) {
        if (next[start] < 0) continue;
        loops.emplace_back();
        for (VertexId v = start; v >= 0 && next[v] >= 0;) {
            loops.back().push_back(v);
            const VertexId after = next[v];
            next[v] = -1;
            v = after;
        }
    }
    return loops;
}

float smallest_sphere_diameter(const std::vector<Point3f>& points) {
    constexpr int kSteps = 100;
    Point3f centre = points.front();
    const auto farthest = [&] {
        return std::max_element(points.begin(), points.end(), [&](const Point3f& a, const Point3f& b) {
            return (a - centre).SquaredNorm() < (b - centre).SquaredNorm();
        });
    };
    for (int i = 1; i <= kSteps; ++i) centre += (*farthest() - centre) / static_cast<float>(i + 1);
    return 2 * (*farthest() - centre).Norm();
}

bool fill_hole(const std::vector<VertexId>& loop, const std::vector<Point3f>& positions, int most_neighbours,
               std::vector<int>& neighbours, std::vector<Triangle>& faces) {
    const auto at = [](auto& values, VertexId v) -> auto& { return values[static_cast<std::size_t>(v)]; };
    std::set<Edge> present = edges_within(loop, faces);
    std::vector<VertexId> rest = loop;
    std::vector<int> counts = neighbours;
    std::vector<Triangle> added;
    while (rest.size() > 3) {
        std::size_t best = rest.size();
        float sharpest = -2;
        for (std::size_t i = 0; i < rest.size(); ++i) {
            const VertexId a = rest[(i + rest.size() - 1) % rest.size()], b = rest[i],
                           c = rest[(i + 1) % rest.size()];
            // b comes to lie inside, where three neighbours are the least.
            if (at(counts, b) < 3 || at(counts, a) >= most_neighbours || at(counts, c) >= most_neighbours)
                continue;
            if (present.count(edge(a, c)) != 0) continue;
            const float cosine = cosine_at(at(positions, a), at(positions, b), at(positions, c));
            if (cosine <= sharpest) continue;
            sharpest = cosine;
            best = i;
        }
        if (best == rest.size()) return false;
        const VertexId a = rest[(best + rest.size() - 1) % rest.size()], b = rest[best],
                       c = rest[(best + 1) % rest.size()];
        added.push_back({a, c, b});
        present.insert(edge(a, c));
        ++at(counts, a);
        ++at(counts, c);
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(best));
    }
    if (std::any_of(rest.begin(), rest.end(), [&](VertexId v) { return at(counts, v) < 3; })) return false;
    added.push_back({rest[0], rest[2], rest[1]});
    neighbours = std::move(counts);
    faces.insert(faces.end(), added.begin(), added.end());
    return true;
}

}  // namespace neuralmesh
