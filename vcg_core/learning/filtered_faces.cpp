// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/learning/filtered_faces.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "vcg_core/base/median.h"
#include "vcg_core/base/parallel_for.h"

namespace neuralmesh {

namespace {

using vcg::Point3f;

// Chosen by tests/experiments/paper/features.py, whose results hardly change around these values.
constexpr int kIterations = 4;
constexpr float kWidth = 6;   ///< of the filter, in medians of the squared difference of adjacent normals
constexpr float kWidest = 1;  ///< bound on the width, for meshes most of whose edges are creases

constexpr int kChunk = 512;  // faces

PerVertex<Point3f> positions_of(const Network& network) {
    PerVertex<Point3f> positions(network.slot_count(), Point3f(0, 0, 0));
    for (const VertexId v : network.vertices()) positions[v] = network.position(v);
    return positions;
}

}  // namespace

FilteredFaces::FilteredFaces(const Network& network, ThreadTeam& team)
    : FilteredFaces(network, positions_of(network), team) {}

FilteredFaces::FilteredFaces(const Network& network, const PerVertex<Point3f>& positions, ThreadTeam& team)
    : surface_(network) {
    normals_.reserve(count());
    centres_.reserve(count());
    areas_.reserve(count());
    for (const auto& [a, b, c] : surface_.faces) {
        const Point3f n = (positions[b] - positions[a]) ^ (positions[c] - positions[a]);
        areas_.push_back(n.Norm() / 2);
        normals_.push_back(unit_or_zero(n));
        centres_.push_back((positions[a] + positions[b] + positions[c]) / 3);
    }
    filter(team);
}

void FilteredFaces::filter(ThreadTeam& team) {
    const float width = std::min(kWidest, kWidth * median_difference(team) + 1e-12F);
    PerFace<Point3f> filtered(count(), Point3f(0, 0, 0));
    for (int iteration = 0; iteration < kIterations; ++iteration) {
        parallel_for(count(), kChunk, team, [&](int f) { filtered[f] = filtered_normal(f, width); });
        std::swap(normals_, filtered);
    }
}

/// Mean normal of the faces around the corners of f, weighted by area and similarity. A face that shares an
/// edge with f counts twice, f itself three times.
Point3f FilteredFaces::filtered_normal(int f, float width) const {
    Point3f sum(0, 0, 0);
    for (const VertexId v : surface_.faces[f])
        for (const int g : around(v)) {
            const float d = (normals_[g] - normals_[f]).SquaredNorm();
            sum += normals_[g] * (areas_[g] * similarity(d, width));
        }
    return unit_or_zero(sum);
}

/// Median over the inner edges of the squared difference of the normals on both sides.
float FilteredFaces::median_difference(ThreadTeam& team) const {
    const auto find = [&](int f, std::vector<float>& found) {
        for (std::size_t k = 0; k < 3; ++k) {
            const VertexId a = surface_.faces[f][k];
            const VertexId b = surface_.faces[f][(k + 1) % 3];
            for (const int g : around(a))
                if (g > f && has_corner(g, b)) found.push_back((normals_[g] - normals_[f]).SquaredNorm());
        }
    };
    std::vector<float> differences = parallel_collect<float>(count(), kChunk, team, find);
    return differences.empty() ? 0.0F : median(std::move(differences));
}

}  // namespace neuralmesh
