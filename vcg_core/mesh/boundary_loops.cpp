// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/mesh/boundary_loops.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace neuralmesh {
namespace {

using vcg::Point3f;

/// Cosine of the angle at \p b.
float cosine_at(const Point3f& a, const Point3f& b, const Point3f& c) {
    const Point3f p = a - b, q = c - b;
    const float lengths = std::sqrt(p.SquaredNorm() * q.SquaredNorm());
    return lengths > 0 ? p * q / lengths : -1.0F;
}

}  // namespace

std::vector<std::vector<VertexId>> boundary_loops(int vertices, const std::vector<Triangle>& faces) {
    // The vertices that edges of faces lead to, by the vertex where they begin.
    PerVertex<std::int32_t> first(vertices + 1, 0);
    for (const Triangle& f : faces)
        for (const VertexId v : f) ++first[v + 1];
    for (VertexId v = 0; v < vertices; ++v) first[v + 1] += first[v];
    Indexed<VertexId> to(first[vertices], -1);
    PerVertex<std::int32_t> end = first;
    for (const Triangle& f : faces)
        for (std::size_t k = 0; k < 3; ++k) to[end[f[k]]++] = f[(k + 1) % 3];
    // An edge in two faces is there in both directions. On a boundary each vertex has one edge that leaves
    // it.
    PerVertex<VertexId> next(vertices, -1);
    for (VertexId v = 0; v < vertices; ++v)
        for (std::int32_t i = first[v]; i < first[v + 1]; ++i) {
            const VertexId w = to[i];
            if (std::find(to.data() + first[w], to.data() + first[w + 1], v) == to.data() + first[w + 1])
                next[v] = w;
        }
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
    // n steps leave the radius at most 1 / sqrt(n) too large (Badoiu and Clarkson 2003).
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

HoleFiller::HoleFiller(IndexedMesh<float>& mesh, const std::vector<std::vector<VertexId>>& loops,
                       int most_neighbours)
    : mesh_(mesh), most_neighbours_(most_neighbours), neighbours_(static_cast<int>(mesh.positions.size())) {
    PerVertex<char> on_loop(neighbours_.size(), 0);
    for (const auto& loop : loops)
        for (const VertexId v : loop) on_loop[v] = 1;
    const auto add = [&](VertexId a, VertexId b) {
        if (on_loop[a] == 0) return;
        std::vector<VertexId>& around = neighbours_[a];
        if (std::find(around.begin(), around.end(), b) == around.end()) around.push_back(b);
    };
    for (const Triangle& f : mesh.faces)
        for (std::size_t k = 0; k < 3; ++k) {
            add(f[k], f[(k + 1) % 3]);
            add(f[(k + 1) % 3], f[k]);
        }
}

/// Cosine of the ear's angle at vertex i of the rest; less than any cosine if the ear cannot be cut.
float HoleFiller::sharpness(const Filling& filling, std::size_t i) const {
    constexpr float kNever = -2;
    const std::vector<VertexId>& rest = filling.rest;
    const VertexId a = rest[(i + rest.size() - 1) % rest.size()], b = rest[i],
                   c = rest[(i + 1) % rest.size()];
    // b comes to lie inside, where three neighbours are the least.
    if (neighbours_[b].size() < 3 || full(a) || full(c)) return kNever;
    if (std::find(neighbours_[a].begin(), neighbours_[a].end(), c) != neighbours_[a].end()) return kNever;
    const auto at = [this](VertexId v) { return mesh_.positions[static_cast<std::size_t>(v)]; };
    return cosine_at(at(a), at(b), at(c));
}

void HoleFiller::join(Filling& filling, VertexId a, VertexId b) {
    neighbours_[a].push_back(b);
    neighbours_[b].push_back(a);
    filling.edges.push_back({a, b});
}

bool HoleFiller::cut_ear(Filling& filling) {
    std::vector<VertexId>& rest = filling.rest;
    std::size_t best = rest.size();
    float sharpest = -2;
    for (std::size_t i = 0; i < rest.size(); ++i) {
        const float cosine = sharpness(filling, i);
        if (cosine <= sharpest) continue;
        sharpest = cosine;
        best = i;
    }
    if (best == rest.size()) return false;
    const VertexId a = rest[(best + rest.size() - 1) % rest.size()], c = rest[(best + 1) % rest.size()];
    filling.faces.push_back({a, c, rest[best]});
    join(filling, a, c);
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(best));
    return true;
}

/// Takes back what \p filling has done to the neighbours.
void HoleFiller::undo(const Filling& filling) {
    for (auto edge = filling.edges.rbegin(); edge != filling.edges.rend(); ++edge)
        for (const VertexId v : *edge) neighbours_[v].pop_back();
}

bool HoleFiller::fill(const std::vector<VertexId>& loop) {
    Filling filling;
    filling.rest = loop;
    while (filling.rest.size() > 3 && cut_ear(filling)) {
    }
    const std::vector<VertexId>& rest = filling.rest;
    const bool closes = rest.size() == 3 && std::all_of(rest.begin(), rest.end(), [&](VertexId v) {
                            return neighbours_[v].size() >= 3;
                        });
    if (!closes) {
        undo(filling);
        return false;
    }
    filling.faces.push_back({rest[0], rest[2], rest[1]});
    mesh_.faces.insert(mesh_.faces.end(), filling.faces.begin(), filling.faces.end());
    return true;
}

}  // namespace neuralmesh
