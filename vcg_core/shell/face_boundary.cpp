// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/shell/face_boundary.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <tuple>
#include <vector>

#include "vcg_core/base/disjoint_sets.h"
#include "vcg_core/base/indexed.h"
#include "vcg_core/mesh/boundary_loops.h"

namespace neuralmesh {
namespace {

using vcg::Point3f;
using PlaceEdge = std::array<std::size_t, 2>;

/// By corner, the first corner at the same place.
std::vector<std::size_t> places_of(const std::vector<Point3f>& corners) {
    std::vector<std::size_t> order(corners.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto key = [&](std::size_t i) {
        return std::make_tuple(corners[i][0], corners[i][1], corners[i][2], i);
    };
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return key(i) < key(j); });
    std::vector<std::size_t> places(corners.size());
    for (std::size_t k = 0; k < order.size(); ++k)
        places[order[k]] =
            k > 0 && corners[order[k]] == corners[order[k - 1]] ? places[order[k - 1]] : order[k];
    return places;
}

/// Edges by the number of their faces; faces without area have none.
struct Edges {
    std::vector<PlaceEdge> of_one, of_many;  ///< many: three or more
};

Edges edges_of(const std::vector<std::size_t>& places) {
    std::vector<PlaceEdge> edges;
    for (std::size_t f = 0; f + 2 < places.size(); f += 3) {
        const std::array<std::size_t, 3> at{places[f], places[f + 1], places[f + 2]};
        if (at[0] == at[1] || at[1] == at[2] || at[2] == at[0]) continue;
        for (std::size_t k = 0; k < 3; ++k)
            edges.push_back({std::min(at[k], at[(k + 1) % 3]), std::max(at[k], at[(k + 1) % 3])});
    }
    std::sort(edges.begin(), edges.end());
    Edges result;
    for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
        while (end < edges.size() && edges[end] == edges[i]) ++end;
        if (end - i == 1) result.of_one.push_back(edges[i]);
        if (end - i > 2) result.of_many.push_back(edges[i]);
    }
    return result;
}

}  // namespace

double widest_face_boundary(const TargetSpace& target) {
    const std::vector<Point3f>& corners = target.positions();
    const Edges edges = edges_of(places_of(corners));
    DisjointSets sets(static_cast<int>(corners.size()));
    const auto find = [&sets](std::size_t v) { return at(sets.find(static_cast<int>(v))); };
    for (const PlaceEdge& edge : edges.of_one)
        sets.join(static_cast<int>(edge[0]), static_cast<int>(edge[1]));
    std::vector<char> of_fin(corners.size(), 0);  // by root
    for (const PlaceEdge& edge : edges.of_many)
        for (const std::size_t v : edge) of_fin[find(v)] = 1;
    std::vector<std::array<std::size_t, 2>> members;  // root and place
    for (const PlaceEdge& edge : edges.of_one)
        for (const std::size_t v : edge)
            if (of_fin[find(v)] == 0) members.push_back({find(v), v});
    std::sort(members.begin(), members.end());
    float widest = 0;
    std::vector<Point3f> points;
    for (std::size_t i = 0; i < members.size(); ++i) {
        points.push_back(corners[members[i][1]]);
        if (i + 1 < members.size() && members[i + 1][0] == members[i][0]) continue;
        widest = std::max(widest, smallest_sphere_diameter(points));
        points.clear();
    }
    return static_cast<double>(widest);
}

}  // namespace neuralmesh
