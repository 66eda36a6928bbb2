// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A two-means clustering of face normals, seeded by the two most different ones.
#include "vcg_core/learning/two_planes.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "vcg_core/base/median.h"
#include "vcg_core/base/parallel_for.h"

namespace neuralmesh {

namespace {

using vcg::Point3f;

// Chosen by tests/experiments/paper/features.py, whose results hardly change around these values.
constexpr int kIterations = 4;
constexpr float kWidth = 6;   ///< of the filter, in medians of the squared difference of adjacent normals
constexpr float kWidest = 1;  ///< bound on the width, for meshes most of whose edges are creases
constexpr float kPlaneReach = 1.5F;  ///< a face this many edges away has half the weight
constexpr int kRefinements = 2;
constexpr float kPlaneWidth = 0.05F;  ///< of similarity() within a plane, in squared differences of the two
constexpr float kOpposite = -0.9F;    ///< cosine below which normals belong to the two sides of a thin part
constexpr float kTiny = 1e-30F;       ///< keeps a vertex without edge length from dividing zero by zero

constexpr int kChunk = 512;  // faces

/// Weight of a normal whose squared difference from another is \p d: 1 at 0, falling with d / \p width. A
/// rational stand-in for exp(-d / width), whose bits differ between mathematical libraries.
float similarity(float d, float width) {
    const float x = 1 + d / width;
    return 1 / (x * x);
}

}  // namespace

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

float mean_edge_at(const Network& network, VertexId v) {
    float sum = 0;
    for (const VertexId u : network.ring(v)) sum += (network.position(u) - network.position(v)).Norm();
    return sum / static_cast<float>(network.ring(v).valence);
}

Crease TwoPlanes::crease_near(const Point3f& x, float edge, VertexId v) {
    collect(x, v);
    // Opposite normals are seeds only if there are no others.
    if (!choose_seeds(kOpposite) && !choose_seeds(-2)) return {};
    for (int i = 0; i < kRefinements; ++i)
        if (!refine()) return {};
    const float e1 = normals_[0] * (x - points_[0]);
    const float e2 = normals_[1] * (x - points_[1]);
    const float cosine = normals_[0] * normals_[1];
    const float least_squared_sine = cosine < 0 ? 1 - kOpposite * kOpposite : 1e-9F;
    const float squared_sine = std::max(1 - cosine * cosine, least_squared_sine);
    const float squared_distance = std::max(0.0F, e1 * e1 + e2 * e2 - 2 * e1 * e2 * cosine) / squared_sine;
    const Point3f to_line =
        (normals_[0] * (cosine * e2 - e1) + normals_[1] * (cosine * e1 - e2)) / squared_sine;
    return {std::max(0.0F, 2 - 2 * cosine), squared_distance / (edge * edge + kTiny), to_line};
}

/// The faces of the two-ring of v, each once.
void TwoPlanes::collect(const Point3f& x, VertexId v) {
    ++collection_;
    members_.clear();
    const float reach = kPlaneReach * mean_edge_at(network_, v);
    add_faces_around(v, x, reach);
    for (const VertexId u : network_.ring(v)) add_faces_around(u, x, reach);
}

void TwoPlanes::add_faces_around(VertexId v, const Point3f& x, float reach) {
    for (const int f : faces_.around(v)) {
        if (visited_[f] == collection_) continue;
        visited_[f] = collection_;
        const float distance = (faces_.centre(f) - x).SquaredNorm() / (reach * reach + kTiny);
        members_.push_back({faces_.normal(f), faces_.centre(f), faces_.area(f) / (1 + distance)});
    }
}

/// Takes the two most different normals whose cosine is at least \p least_cosine. False if none differ.
bool TwoPlanes::choose_seeds(float least_cosine) {
    float least = 1 - 1e-6F;
    bool found = false;
    for (std::size_t i = 1; i < members_.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const float cosine = members_[i].normal * members_[j].normal;
            if (cosine >= least || cosine < least_cosine) continue;
            least = cosine;
            normals_[0] = members_[i].normal;
            normals_[1] = members_[j].normal;
            found = true;
        }
    return found;
}

/// Assigns each face to the plane with the more similar normal, then recomputes both planes. False if one has
/// no face left.
bool TwoPlanes::refine() {
    const float width = kPlaneWidth * (normals_[0] - normals_[1]).SquaredNorm() + 1e-9F;
    Point3f normals[2] = {{0, 0, 0}, {0, 0, 0}};
    Point3f points[2] = {{0, 0, 0}, {0, 0, 0}};
    float weights[2] = {0, 0};
    for (const Member& m : members_) {
        const float difference[2] = {(m.normal - normals_[0]).SquaredNorm(),
                                     (m.normal - normals_[1]).SquaredNorm()};
        const int k = difference[0] < difference[1] ? 0 : 1;
        const float w = m.weight * similarity(difference[k], width);
        normals[k] += m.normal * w;
        points[k] += m.centre * w;
        weights[k] += w;
    }
    for (int k = 0; k < 2; ++k) {
        if (!(weights[k] > 0)) return false;
        normals_[k] = unit_or_zero(normals[k]);
        points_[k] = points[k] / weights[k];
    }
    return true;
}

}  // namespace neuralmesh
