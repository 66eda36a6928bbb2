// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/mesh/face_walk.h"

#include <algorithm>
#include <limits>

namespace neuralmesh {

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
