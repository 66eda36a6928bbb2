// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/mesh/surface.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace neuralmesh {

Surface::Surface(const Network& network)
    : positions(network.slot_count(), Vector3::Zero()),
      faces(network.faces()),
      first_face_(network.slot_count() + 1, 0),
      face_of_(3 * faces.vector().size()) {
    for (VertexId v = 0; v < network.slot_count(); ++v) positions[v] = to_eigen(network.position(v));
    for (const Triangle& face : faces)
        for (VertexId v : face) ++first_face_[v + 1];
    std::partial_sum(first_face_.begin(), first_face_.end(), first_face_.begin());
    PerVertex<int> next = first_face_;
    for (int f = 0; f < faces.size(); ++f)
        for (VertexId v : faces[f]) face_of_[static_cast<std::size_t>(next[v]++)] = f;
    mark_boundary(network);
    if (network.viewer()) viewer = to_eigen(*network.viewer());
}

void Surface::mark_boundary(const Network& network) {
    for (const VertexId v : network.vertices()) {
        const Ring& ring = network.ring(v);
        if (ring.open == 0) continue;
        if (boundary_.empty()) boundary_.resize(face_count(), 0);
        for (const int f : faces_around(v))
            for (unsigned k = 0; k < 3; ++k)
                if (faces[f][k] == v && faces[f][(k + 1) % 3] == ring[0])
                    boundary_[f] = static_cast<std::uint8_t>(boundary_[f] | 1U << k);
    }
}

FaceCorner corner_of_edge(const Surface& surface, VertexId a, VertexId b) {
    for (int f : surface.faces_around(a)) {
        const Triangle& face = surface.faces[f];
        for (std::size_t k = 0; k < 3; ++k)
            if (face[k] == a && face[(k + 1) % 3] == b) return {f, k};
    }
    return {};
}

Vector3 normal_beyond(const Surface& surface, VertexId a, VertexId b) {
    const FaceCorner beyond = corner_of_edge(surface, b, a);
    if (beyond.face < 0) return Vector3::Zero();
    return unit_normal(surface.positions[b], surface.positions[a],
                       surface.positions[surface.faces[beyond.face][(beyond.corner + 2) % 3]]);
}

float squared_distance_from(const Surface& surface, Span<const int> faces, const Vector3& p) {
    float least = std::numeric_limits<float>::max();
    for (const int f : faces)
        least = std::min(least,
                         foot_on_triangle(p, surface.corner(f, 0), surface.corner(f, 1), surface.corner(f, 2))
                             .squared_distance);
    return least;
}

float mean_edge_length(const Surface& surface) {
    double sum = 0;
    for (int f = 0; f < surface.face_count(); ++f)
        for (int k = 0; k < 3; ++k)
            sum += static_cast<double>((surface.corner(f, k) - surface.corner(f, (k + 1) % 3)).norm());
    return static_cast<float>(sum / (3 * static_cast<double>(surface.face_count())));
}

float mean_edge_length_at(const PerVertex<Vector3>& positions, const Ring& ring, VertexId v) {
    float sum = 0;
    for (const VertexId u : ring) sum += (positions[u] - positions[v]).norm();
    return sum / static_cast<float>(ring.valence);
}

void place_vertices(Network& network, const PerVertex<Vector3>& positions) {
    for (const VertexId v : network.vertices()) network.set_position(v, to_vcg(positions[v]));
}

PerVertex<Vector3> area_vectors_around(const Network& network, const Surface& surface, int rings) {
    PerVertex<Vector3> sums(surface.positions.size(), Vector3::Zero());
    for (int f = 0; f < surface.face_count(); ++f) {
        const Vector3 area = area_vector(surface, f);
        for (VertexId v : surface.faces[f]) sums[v] += area;
    }
    spread_over_rings(network, sums, rings);
    return sums;
}

PerVertex<float> point_density(const Network& network, const Surface& surface, const PerFace<float>& points,
                               int rings) {
    struct Sums {
        float points = 0, area = 0;
        void operator+=(const Sums& other) {
            points += other.points;
            area += other.area;
        }
    };
    PerVertex<Sums> sums(surface.positions.size());
    for (int f = 0; f < surface.face_count(); ++f) {
        if (points[f] < 0) continue;
        const Sums of_face{points[f], area_vector(surface, f).norm() / 2};
        for (const VertexId v : surface.faces[f]) sums[v] += of_face;
    }
    spread_over_rings(network, sums, rings);
    PerVertex<float> density(sums.size(), 0.0F);
    for (VertexId v = 0; v < sums.size(); ++v)
        if (sums[v].area > 0) density[v] = sums[v].points / sums[v].area;
    return density;
}

namespace {

/// Whether no other face of a smooth surface can be nearer: whatever is nearer to the point than its foot
/// lies within twice their distance of the foot, and the foot is further than that from every edge.
bool is_settled(const Foot& foot, const Vector3& ab, const Vector3& ac) {
    const float least = std::min({foot.weights[0], foot.weights[1], foot.weights[2]});
    const float longest = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
    // The smallest height of the triangle is 2 area / longest edge; the foot is at least least x that height
    // away from every edge.
    return least > 0 && least * least * ab.cross(ac).squaredNorm() > 4 * foot.squared_distance * longest;
}

/// The corner of the hit face that is nearest to the foot.
VertexId nearest_corner(const Surface& surface, const Hit& hit) {
    const auto& w = hit.foot.weights;
    return surface.faces[hit.face][w[0] >= w[1] ? (w[0] >= w[2] ? 0U : 2U) : (w[1] >= w[2] ? 1U : 2U)];
}

}  // namespace

WalkStart walk_start_of(const Surface& surface, const Hit& hit) {
    const VertexId v = nearest_corner(surface, hit);
    const Span<const int> around = surface.faces_around(v);
    return {v, static_cast<int>(std::find(around.begin(), around.end(), hit.face) - around.begin())};
}

Hit walk_to_nearest(const Surface& surface, const Vector3& p, WalkStart start) {
    Hit best{-1, {std::numeric_limits<float>::max(), {1, 0, 0}}};
    /// Returns whether the search is over.
    const auto look_at = [&](int face) {
        const Vector3& a = surface.corner(face, 0);
        const Vector3 ab = surface.corner(face, 1) - a;
        const Vector3 ac = surface.corner(face, 2) - a;
        const Foot foot = foot_on_triangle(ab, ac, p - a);
        if (!(foot.squared_distance < best.foot.squared_distance)) return false;
        best = {face, foot};
        return is_settled(foot, ab, ac);
    };
    VertexId v = start.vertex;
    const Span<const int> first = surface.faces_around(v);
    if (start.turn < first.size() && look_at(first[start.turn])) return best;
    for (;;) {
        const float before = best.foot.squared_distance;
        for (int face : surface.faces_around(v))
            if (look_at(face)) return best;
        const VertexId next = nearest_corner(surface, best);
        if (next == v || (v != start.vertex && !(best.foot.squared_distance < before))) return best;
        v = next;
    }
}

}  // namespace neuralmesh
