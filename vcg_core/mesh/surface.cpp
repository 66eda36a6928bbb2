// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Feet of points on triangles, and a tree of bounding boxes over the faces.
#include "vcg_core/mesh/surface.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace neuralmesh {

float triangle_quality(const Vector3& a, const Vector3& b, const Vector3& c) {
    constexpr float kTwoSqrtThree = 3.4641016F;
    const float edges = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
    return edges > 0 ? kTwoSqrtThree * area_vector(a, b, c).norm() / edges : 0.0F;
}

Surface::Surface(const Network& network) : faces(network.faces()) {
    const auto slots = index(network.slot_count());
    at.resize(slots, Vector3(0, 0, 0));
    for (VertexId v = 0; v < network.slot_count(); ++v) at[index(v)] = to_eigen(network.position(v));
    first_face.assign(slots + 1, 0);
    for (const Triangle& f : faces)
        for (const VertexId v : f) ++first_face[index(v) + 1];
    std::partial_sum(first_face.begin(), first_face.end(), first_face.begin());
    face_of.resize(3 * faces.size());
    std::vector<int> next(first_face.begin(), first_face.end() - 1);
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (const VertexId v : faces[f]) face_of[index(next[index(v)]++)] = static_cast<int>(f);
}

Vector3 normal_beyond(const Surface& surface, VertexId a, VertexId b) {
    for (int i = surface.first_face[index(b)]; i < surface.first_face[index(b) + 1]; ++i) {
        const Triangle& f = surface.faces[index(surface.face_of[index(i)])];
        for (std::size_t k = 0; k < 3; ++k) {
            if (f[k] != b || f[(k + 1) % 3] != a) continue;
            const Vector3& c = surface.at[index(f[(k + 2) % 3])];
            return (surface.at[index(a)] - surface.at[index(b)]).cross(c - surface.at[index(b)]).normalized();
        }
    }
    return Vector3::Zero();
}

namespace {

/// Whether the foot lies so deep in its face that no face around can be nearer: what is nearer to the point
/// than its foot is lies within twice their distance of the foot, and the way to another face leads over an
/// edge.
bool settled(const Foot& foot, const Vector3& ab, const Vector3& ac) {
    const float least = std::min({foot.weights[0], foot.weights[1], foot.weights[2]});
    const float longest = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
    // The least height is 2 area / longest edge, and the foot has least x height to every edge or more.
    return least > 0 && least * least * ab.cross(ac).squaredNorm() > 4 * foot.squared_distance * longest;
}

/// The corner of the hit face that is nearest to the foot.
VertexId nearest_corner(const Surface& surface, const Hit& hit) {
    const auto& w = hit.foot.weights;
    return surface.faces[index(hit.face)][w[0] >= w[1] ? (w[0] >= w[2] ? 0U : 2U) : (w[1] >= w[2] ? 1U : 2U)];
}

std::vector<int> all_faces(const Surface& surface) {
    std::vector<int> faces(surface.faces.size());
    std::iota(faces.begin(), faces.end(), 0);
    return faces;
}

}  // namespace

WalkStart walk_start_of(const Surface& surface, const Hit& hit) {
    const VertexId v = nearest_corner(surface, hit);
    const auto around = surface.face_of.begin() + surface.first_face[index(v)];
    return {v, static_cast<int>(std::find(around, surface.face_of.end(), hit.face) - around)};
}

Hit walk_to_nearest(const Surface& surface, const Vector3& p, WalkStart start) {
    Hit best{-1, {std::numeric_limits<float>::max(), {1, 0, 0}}};
    /// Whether the search is over.
    const auto look_at = [&](int face) {
        const Vector3& a = surface.corner(face, 0);
        const Vector3 ab = surface.corner(face, 1) - a;
        const Vector3 ac = surface.corner(face, 2) - a;
        const Foot foot = foot_on_triangle(ab, ac, p - a);
        if (!(foot.squared_distance < best.foot.squared_distance)) return false;
        best = {face, foot};
        return settled(foot, ab, ac);
    };
    VertexId v = start.vertex;
    const int first = surface.first_face[index(v)] + start.turn;
    if (first < surface.first_face[index(v) + 1] && look_at(surface.face_of[index(first)])) return best;
    for (;;) {
        const float before = best.foot.squared_distance;
        for (int i = surface.first_face[index(v)]; i < surface.first_face[index(v) + 1]; ++i)
            if (look_at(surface.face_of[index(i)])) return best;
        const VertexId next = nearest_corner(surface, best);
        if (next == v || (v != start.vertex && !(best.foot.squared_distance < before))) return best;
        v = next;
    }
}

FaceTree::FaceTree(const Surface& surface) : FaceTree(surface, all_faces(surface)) {}

FaceTree::FaceTree(const Surface& surface, std::vector<int> faces)
    : order_(std::move(faces)), corners_(order_.size()), boxes_(order_.size()) {
    std::vector<Vector3> centres(surface.faces.size());
    for (const int f : order_)
        centres[index(f)] = surface.corner(f, 0) + surface.corner(f, 1) + surface.corner(f, 2);
    nodes_.reserve(order_.size());
    if (!order_.empty()) build(centres, 0, static_cast<int>(order_.size()));
    set_boxes(surface);
}

FaceTree::Box FaceTree::box_of(const Surface& surface, int face) {
    const Vector3& a = surface.corner(face, 0);
    const Vector3& b = surface.corner(face, 1);
    const Vector3& c = surface.corner(face, 2);
    return {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
}

int FaceTree::build(const std::vector<Vector3>& centres, int begin, int end) {
    const int node = static_cast<int>(nodes_.size());
    nodes_.push_back({Vector3::Zero(), Vector3::Zero(), begin, end, -1});
    if (end - begin <= kLeaf) return node;
    Vector3 low = centres[index(order_[index(begin)])];
    Vector3 high = low;
    for (int i = begin; i < end; ++i) {
        low = low.cwiseMin(centres[index(order_[index(i)])]);
        high = high.cwiseMax(centres[index(order_[index(i)])]);
    }
    Eigen::Index axis = 0;
    (high - low).maxCoeff(&axis);
    const int middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](int f, int g) {
                         const float x = centres[index(f)][axis];
                         const float y = centres[index(g)][axis];
                         return x < y || (x == y && f < g);
                     });
    build(centres, begin, middle);
    const int right = build(centres, middle, end);
    nodes_[index(node)].right = right;
    return node;
}

void FaceTree::set_boxes(const Surface& surface) {
    for (std::size_t i = 0; i < order_.size(); ++i) {
        const Vector3& a = surface.corner(order_[i], 0);
        corners_[i] = {a, surface.corner(order_[i], 1) - a, surface.corner(order_[i], 2) - a};
        boxes_[i] = box_of(surface, order_[i]);
    }
    for (std::size_t n = nodes_.size(); n-- > 0;) {
        Node& node = nodes_[n];
        if (node.right >= 0) {
            node.low = nodes_[n + 1].low.cwiseMin(nodes_[index(node.right)].low);
            node.high = nodes_[n + 1].high.cwiseMax(nodes_[index(node.right)].high);
            continue;
        }
        node.low = boxes_[index(node.begin)].low;
        node.high = boxes_[index(node.begin)].high;
        for (int i = node.begin + 1; i < node.end; ++i) {
            node.low = node.low.cwiseMin(boxes_[index(i)].low);
            node.high = node.high.cwiseMax(boxes_[index(i)].high);
        }
    }
}

Hit FaceTree::nearest(const Vector3& p) const {
    struct Entry {
        float squared_distance;
        int node;
    };
    const auto box_distance = [&](int n) {
        const Node& node = nodes_[index(n)];
        return (node.low - p).cwiseMax(p - node.high).cwiseMax(0).squaredNorm();
    };
    Hit best{-1, {std::numeric_limits<float>::max(), {1, 0, 0}}};
    std::array<Entry, kStack> stack;
    int height = 0;
    if (!nodes_.empty()) stack[index(height++)] = {box_distance(0), 0};
    while (height > 0) {
        const Entry entry = stack[index(--height)];
        if (entry.squared_distance > best.foot.squared_distance) continue;
        int n = entry.node;
        while (nodes_[index(n)].right >= 0) {
            Entry left{box_distance(n + 1), n + 1};
            Entry right{box_distance(nodes_[index(n)].right), nodes_[index(n)].right};
            if (right.squared_distance < left.squared_distance) std::swap(left, right);
            if (right.squared_distance <= best.foot.squared_distance) stack[index(height++)] = right;
            n = left.node;
            if (left.squared_distance > best.foot.squared_distance) break;
        }
        if (nodes_[index(n)].right >= 0) continue;
        for (int i = nodes_[index(n)].begin; i < nodes_[index(n)].end; ++i) {
            const Corners& t = corners_[index(i)];
            const Foot foot = foot_on_triangle(t.ab, t.ac, p - t.a);
            const int face = order_[index(i)];
            if (foot.squared_distance < best.foot.squared_distance ||
                (foot.squared_distance == best.foot.squared_distance && face < best.face))
                best = {face, foot};
        }
    }
    return best;
}

}  // namespace neuralmesh
