// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The offset of a new vertex lowers a point's distance from its face by offset x phi, where phi is the new
// vertex's hat function at the point's foot.
#include <algorithm>
#include <array>
#include <cmath>

#include "vcg_core/base/parallel_for.h"
#include "vcg_core/fit/boundary.h"
#include "vcg_core/fit/redistribute.h"

namespace neuralmesh {

namespace {

constexpr int kSplitChunk = 128;
constexpr float kMaxOffset = 0.3F;  ///< in edge lengths
/// A new vertex needs this many points, each counted by its squared hat function. The points beside an edge
/// of the shape draw a vertex that has fewer out of it, where none says how far: of a box of 9,602 points on
/// a grid, with 1,000 vertices, 78 vertices stick out by a tenth of a step and more without this, 7 with it.
constexpr float kLeastPoints = 1;

/// Sums over points for the least squares of one offset.
struct HatSums {
    float phi_residual = 0;
    float phi_phi = 0;
};
/// Of the edges 0-1, 1-2, 2-0 of a face.
using FaceHatSums = std::array<HatSums, 3>;

FaceHatSums hat_sums(const Surface& surface, const PointsByFace& points, int face) {
    FaceHatSums sums;
    const Vector3& a = surface.corner(face, 0);
    const Vector3 normal = unit_normal(surface, face);
    for (const PointsByFace::Assignment& point : points.of(face)) {
        const float residual = normal.dot(point.point - a);
        for (std::size_t k = 0; k < 3; ++k) {
            const float phi = 2 * std::min(point.foot.weights[k], point.foot.weights[(k + 1) % 3]);
            sums[k].phi_residual += point.influence * phi * residual;
            sums[k].phi_phi += point.influence * phi * phi;
        }
    }
    return sums;
}

/// Whether the corner \p gone of \p face turns it away from the viewer if it moves to \p place.
bool turns_away(const Surface& surface, int face, VertexId gone, const Vector3& place) {
    std::array<Vector3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k)
        corners[k] = surface.faces[face][k] == gone ? place : surface.positions[surface.faces[face][k]];
    return surface.turns_away(unit_normal(surface, face), unit_normal(corners[0], corners[1], corners[2]),
                              place);
}

/// The split of the edge a-b by its faces; its gain is negative if too few points are near, or if it is less
/// than \p least_gain for points of weight 1.
EdgeSplit split_of(const Surface& surface, const PointsByFace& points, const PerFace<FaceHatSums>& sums,
                   float least_gain, VertexId a, VertexId b) {
    HatSums both;
    Vector3 normal = Vector3::Zero();
    const FaceCorner left = corner_of_edge(surface, a, b), right = corner_of_edge(surface, b, a);
    const std::array<int, 2> faces{left.face, right.face < 0 ? left.face : right.face};
    for (const FaceCorner& side : {left, right}) {
        if (side.face < 0) continue;  // right of a boundary edge
        const HatSums& of_side = sums[side.face][side.corner];
        both.phi_residual += of_side.phi_residual;
        both.phi_phi += of_side.phi_phi;
        normal += unit_normal(surface, side.face);
    }
    const Vector3& at_a = surface.positions[a];
    const Vector3& at_b = surface.positions[b];
    if (!(both.phi_phi >= kLeastPoints)) return {-1, a, b, 0.5F * (at_a + at_b)};
    const float bound = kMaxOffset * (at_a - at_b).norm();
    const float offset = std::clamp(both.phi_residual / both.phi_phi, -bound, bound);
    const float gain = both.phi_residual * both.phi_residual / both.phi_phi;
    const bool enough = gain >= least_gain * points.mean_weight(faces[0], faces[1]);
    const Vector3 middle = 0.5F * (at_a + at_b);
    Vector3 way = offset * normal.normalized();
    // Along its line of sight a vertex turns no face away.
    if (surface.viewer && std::any_of(faces.begin(), faces.end(), [&](int f) {
            return turns_away(surface, f, a, middle + way) || turns_away(surface, f, b, middle + way);
        })) {
        const Vector3 sight = (*surface.viewer - middle).normalized();
        way = sight * sight.dot(way);
    }
    return {enough ? gain : -1, a, b, middle + way};
}

float cubed(float x) { return x * x * x; }

/// Adds to the split of a boundary edge what the new vertex gains by moving outward or inward, beyond what
/// the edge's ends would gain. The points between an edge and where they end, or as many missing ones, add up
/// to squared distances of density x offset^3 / 3 per length.
void add_boundary_gain(EdgeSplit& split, const BoundaryTarget& target) {
    const auto parts = static_cast<float>(target.parts);
    const auto from_middle = [&](int i) { return target.share(i) - 0.5F; };
    float mean = 0;
    float slope = 0;
    float phi_mean = 0;
    float squares = 0;
    const auto phi = [&](int i) { return 1 - 2 * std::abs(from_middle(i)); };
    for (int i = 0; i < target.parts; ++i) {
        mean += target.offset(i) / parts;
        slope += target.offset(i) * from_middle(i);
        squares += from_middle(i) * from_middle(i);
        phi_mean += phi(i) / parts;
    }
    if (squares > 0) slope /= squares;
    const auto rest = [&](int i) { return target.offset(i) - mean - slope * from_middle(i); };
    float phi_rest = 0;
    float phi_phi = 0;
    for (int i = 0; i < target.parts; ++i) {
        phi_rest += (phi(i) - phi_mean) * rest(i);
        phi_phi += (phi(i) - phi_mean) * (phi(i) - phi_mean);
    }
    if (!(phi_phi > 0)) return;  // fewer than three parts
    const float bound = kMaxOffset * target.length;
    const float offset = std::clamp(phi_rest / phi_phi, -bound, bound);
    float drop = 0;
    for (int i = 0; i < target.parts; ++i)
        drop += cubed(std::abs(rest(i))) - cubed(std::abs(rest(i) - (phi(i) - phi_mean) * offset));
    if (!(drop > 0)) return;
    split.gain = std::max(split.gain, 0.0F) + drop * target.density * target.length / (3 * parts);
    split.position += (1 - phi_mean) * offset * target.outward;
}

}  // namespace

std::vector<EdgeSplit> find_splits(const Network& network, const Surface& surface, const PointsByFace& points,
                                   float least_gain, ThreadTeam& team, const PerVertex<float>& variances) {
    const auto least_for = [&](VertexId a, VertexId b) {
        return least_gain * (variances.empty() ? 1.0F : (variances[a] + variances[b]) / 2);
    };
    PerFace<FaceHatSums> sums(surface.face_count());
    parallel_for(sums.size(), kSplitChunk, team, [&](int f) { sums[f] = hat_sums(surface, points, f); });
    const auto find = [&](VertexId a, std::vector<EdgeSplit>& found) {
        if (!network.alive(a)) return;
        const Ring& ring = network.ring(a);
        for (int i = 0; i < ring.valence; ++i) {
            if (ring[i] < a || ring.is_boundary_edge(i)) continue;
            const EdgeSplit split = split_of(surface, points, sums, least_for(a, ring[i]), a, ring[i]);
            if (split.gain >= 0) found.push_back(split);
        }
    };
    std::vector<EdgeSplit> splits =
        parallel_collect<EdgeSplit>(network.slot_count(), kSplitChunk, team, find);
    for (const BoundaryTarget& target : find_boundary_targets(network, surface, points)) {
        EdgeSplit split = split_of(surface, points, sums, 0, target.a, target.b);
        add_boundary_gain(split, target);
        if (split.gain >= least_for(target.a, target.b) * points.mean_weight(target.face, target.face))
            splits.push_back(split);
    }
    std::stable_sort(splits.begin(), splits.end(),
                     [](const EdgeSplit& x, const EdgeSplit& y) { return x.gain > y.gain; });
    return splits;
}

}  // namespace neuralmesh
