// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The network's surface as the fit works on it, and the nearest face of a point.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "vcg_core/mesh/network.h"

namespace neuralmesh {

using Vector3 = Eigen::Vector3f;

inline Vector3 to_eigen(const vcg::Point3f& p) { return {p[0], p[1], p[2]}; }
inline vcg::Point3f to_vcg(const Vector3& p) { return {p[0], p[1], p[2]}; }
inline std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// The point of a triangle that is nearest to some other point.
struct Foot {
    float squared_distance;
    std::array<float, 3> weights;  ///< barycentric; 0 for the corners that have no part in it
};

namespace detail {

inline float share_of(float part, float rest) { return part + rest > 0 ? part / (part + rest) : 0.0F; }

inline Foot foot_with(const Vector3& ab, const Vector3& ac, const Vector3& ap, float b, float c) {
    const Vector3 d = ap - b * ab - c * ac;
    return {d.squaredNorm(), {1 - b - c, b, c}};
}

}  // namespace detail

/// \p ab and \p ac are the triangle's edges from its corner a, \p ap leads from a to the point. Degenerate
/// triangles are allowed. Source: Ericson, "Real-Time Collision Detection" (2005), 5.1.5.
inline Foot foot_on_triangle(const Vector3& ab, const Vector3& ac, const Vector3& ap) {
    const float d1 = ab.dot(ap);
    const float d2 = ac.dot(ap);
    if (d1 <= 0 && d2 <= 0) return {ap.squaredNorm(), {1, 0, 0}};
    const float bb = ab.squaredNorm();
    const float bc = ab.dot(ac);
    const float cc = ac.squaredNorm();
    const float d3 = d1 - bb;
    const float d4 = d2 - bc;
    if (d3 >= 0 && d4 <= d3) return {(ap - ab).squaredNorm(), {0, 1, 0}};
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        return detail::foot_with(ab, ac, ap, detail::share_of(d1, -d3), 0);
    }
    const float d5 = d1 - bc;
    const float d6 = d2 - cc;
    if (d6 >= 0 && d5 <= d6) return {(ap - ac).squaredNorm(), {0, 0, 1}};
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return detail::foot_with(ab, ac, ap, 0, detail::share_of(d2, -d6));
    const float va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const float c = detail::share_of(d4 - d3, d5 - d6);
        Foot foot = detail::foot_with(ab, ac, ap, 1 - c, c);
        foot.weights[0] = 0;
        return foot;
    }
    const float sum = va + vb + vc;
    return detail::foot_with(ab, ac, ap, vb / sum, vc / sum);
}
inline Foot foot_on_triangle(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c) {
    return foot_on_triangle(b - a, c - a, p - a);
}

/// Along the normal of a triangle, which is counter-clockwise seen from where it points; twice its area long.
inline Vector3 area_vector(const Vector3& a, const Vector3& b, const Vector3& c) {
    return (b - a).cross(c - a);
}

/// 4 sqrt(3) area / (sum of the squared edges): 1 for an equilateral triangle, 0 for a degenerate one.
float triangle_quality(const Vector3& a, const Vector3& b, const Vector3& c);

/// A copy of the network's geometry in arrays: positions by slot, faces, and the faces around each slot.
struct Surface {
    std::vector<Vector3> at;
    std::vector<Triangle> faces;
    std::vector<int> first_face;  ///< of slot v: face_of[first_face[v]] up to face_of[first_face[v + 1] - 1]
    std::vector<int> face_of;

    explicit Surface(const Network& network);
    const Vector3& corner(int face, std::size_t k) const { return at[index(faces[index(face)][k])]; }
};

inline Vector3 area_vector(const Surface& surface, int face) {
    return area_vector(surface.corner(face, 0), surface.corner(face, 1), surface.corner(face, 2));
}

/// Unit normal of the face that has the edge a-b the other way round, b to a; 0 on a boundary.
Vector3 normal_beyond(const Surface& surface, VertexId a, VertexId b);

/// Adds to every vertex's value those of its ring, \p times over: sums over ever wider surroundings, in which
/// near vertices count more often. O(times x vertices).
template <class Value>
void spread_over_rings(const Network& network, std::vector<Value>& values, int times) {
    for (int time = 0; time < times; ++time) {
        const std::vector<Value> before = values;
        for (VertexId v = 0; v < network.slot_count(); ++v) {
            const Ring& ring = network.ring(v);
            for (int i = 0; i < ring.valence; ++i) values[index(v)] += before[index(ring[i])];
        }
    }
}

/// A face and the point of it nearest to some other point.
struct Hit {
    int face;
    Foot foot;
};

/// Where a walk to a nearest face begins: a vertex, and which of the faces around it comes first.
struct WalkStart {
    VertexId vertex = 0;
    int turn = 0;
};

/// The corner of the hit face that is nearest to the foot, and that face: where to start the walk next time.
WalkStart walk_start_of(const Surface& surface, const Hit& hit);

/// The nearest face of \p p that a walk finds: from the faces around the vertex \p start on to those around
/// the corner nearest to the foot, as long as that brings it closer. Not exact across thin gaps; many times
/// as fast as a tree if the start is near. Any turn is allowed.
Hit walk_to_nearest(const Surface& surface, const Vector3& p, WalkStart start);

/// Nearest face by a tree of bounding boxes. vcglib's grids lose against it where the faces' sizes vary by
/// hundreds, as here.
class FaceTree {
public:
    /// O(faces log faces).
    explicit FaceTree(const Surface& surface);
    /// Of some of its faces.
    FaceTree(const Surface& surface, std::vector<int> faces);
    /// The nearest face of \p p, the one of smallest index among equals. Exact in float.
    /// O(log faces) expected near the surface.
    Hit nearest(const Vector3& p) const;
    /// Calls \p visit(f, g) for every face g whose bounding box has a point in common with that of f, the
    /// \p i-th face in the order of the tree, and that comes after it there: for all i each pair once.
    template <class Visit>
    void for_overlapping(std::size_t i, const Visit& visit) const {
        for_overlapping(boxes_[i], static_cast<int>(i) + 1, [&](int g) { visit(order_[i], g); });
    }
    /// Calls \p visit(g) for every face g whose bounding box has a point in common with that of \p face of
    /// \p surface.
    template <class Visit>
    void for_overlapping(const Surface& surface, int face, const Visit& visit) const {
        for_overlapping(box_of(surface, face), 0, visit);
    }

private:
    static constexpr int kLeaf = 4;
    static constexpr std::size_t kStack = 64;

    struct Node {
        Vector3 low, high;
        int begin, end;  ///< into order_
        int right;       ///< the left child follows its parent; -1: a leaf
    };
    struct Corners {
        Vector3 a, ab, ac;
    };
    struct Box {
        Vector3 low, high;
        bool apart(const Vector3& l, const Vector3& h) const {
            return (l.array() > high.array()).any() || (h.array() < low.array()).any();
        }
    };

    static Box box_of(const Surface& surface, int face);
    int build(const std::vector<Vector3>& centres, int begin, int end);
    void set_boxes(const Surface& surface);
    template <class Visit>
    void for_overlapping(const Box& box, int first, const Visit& visit) const;

    std::vector<int> order_;
    std::vector<Corners> corners_;  ///< in order_
    std::vector<Box> boxes_;        ///< in order_
    std::vector<Node> nodes_;
};

/// Of the faces from the \p first in the order of the tree on.
template <class Visit>
void FaceTree::for_overlapping(const Box& box, int first, const Visit& visit) const {
    std::array<int, kStack> stack;
    int height = 0;
    if (!nodes_.empty()) stack[index(height++)] = 0;
    while (height > 0) {
        const int n = stack[index(--height)];
        const Node& node = nodes_[index(n)];
        if (node.end <= first || box.apart(node.low, node.high)) continue;
        if (node.right >= 0) {
            stack[index(height++)] = node.right;
            stack[index(height++)] = n + 1;
            continue;
        }
        for (int j = std::max(first, node.begin); j < node.end; ++j)
            if (!box.apart(boxes_[index(j)].low, boxes_[index(j)].high)) visit(order_[index(j)]);
    }
}

}  // namespace neuralmesh
