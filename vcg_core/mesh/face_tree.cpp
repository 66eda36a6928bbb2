// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/mesh/face_tree.h"

#include <limits>
#include <numeric>
#include <utility>

namespace neuralmesh {

namespace {

std::vector<int> all_faces(const Surface& surface) {
    std::vector<int> faces(surface.faces.vector().size());
    std::iota(faces.begin(), faces.end(), 0);
    return faces;
}

}  // namespace

FaceTree::FaceTree(const Surface& surface) : FaceTree(surface, all_faces(surface)) {}

FaceTree::FaceTree(const Surface& surface, std::vector<int> faces)
    : order_(std::move(faces)), corners_(order_.size()), boxes_(order_.size()) {
    PerFace<Vector3> centres(surface.face_count(), Vector3::Zero());
    for (int f : order_) centres[f] = surface.corner(f, 0) + surface.corner(f, 1) + surface.corner(f, 2);
    nodes_.reserve(order_.size());
    if (!order_.empty()) build(centres, 0, order_.size());
    set_boxes(surface);
}

FaceTree::Box FaceTree::box_of(const Surface& surface, int face) {
    Box box(surface.corner(face, 0));
    box.extend(surface.corner(face, 1));
    box.extend(surface.corner(face, 2));
    return box;
}

int FaceTree::build(const PerFace<Vector3>& centres, int begin, int end) {
    const int node = nodes_.size();
    nodes_.push_back({Box(), begin, end, -1});
    if (end - begin <= kLeafFaces) return node;
    Box box;
    for (int i = begin; i < end; ++i) box.extend(centres[order_[i]]);
    Eigen::Index axis = 0;
    box.sizes().maxCoeff(&axis);
    const int middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](int f, int g) {
                         const float x = centres[f][axis];
                         const float y = centres[g][axis];
                         return x < y || (x == y && f < g);
                     });
    build(centres, begin, middle);
    const int right = build(centres, middle, end);
    nodes_[node].right = right;
    return node;
}

void FaceTree::set_boxes(const Surface& surface) {
    for (int i = 0; i < order_.size(); ++i) {
        const Vector3& a = surface.corner(order_[i], 0);
        corners_[i] = {a, surface.corner(order_[i], 1) - a, surface.corner(order_[i], 2) - a};
        boxes_[i] = box_of(surface, order_[i]);
    }
    // Children come after their parents.
    for (int n = nodes_.size() - 1; n >= 0; --n) {
        Node& node = nodes_[n];
        if (node.is_leaf()) {
            for (int i = node.begin; i < node.end; ++i) node.box.extend(boxes_[i]);
        } else {
            node.box = nodes_[n + 1].box.merged(nodes_[node.right].box);
        }
    }
}

Hit FaceTree::nearest(const Vector3& p) const {
    struct Entry {
        float squared_distance;
        int node;
    };
    const auto entry_of = [&](int n) { return Entry{nodes_[n].box.squaredExteriorDistance(p), n}; };
    Hit best{-1, {std::numeric_limits<float>::max(), {1, 0, 0}}};
    std::array<Entry, kStack> stack;
    std::size_t height = 0;
    if (!nodes_.empty()) stack[height++] = entry_of(0);
    while (height > 0) {
        Entry nearer = stack[--height];
        // Down to a leaf by the nearer child; the other waits.
        while (nearer.squared_distance <= best.foot.squared_distance && !nodes_[nearer.node].is_leaf()) {
            Entry further = entry_of(nodes_[nearer.node].right);
            nearer = entry_of(nearer.node + 1);
            if (further.squared_distance < nearer.squared_distance) std::swap(nearer, further);
            if (further.squared_distance <= best.foot.squared_distance) stack[height++] = further;
        }
        if (nearer.squared_distance > best.foot.squared_distance) continue;
        const Node& leaf = nodes_[nearer.node];
        for (int i = leaf.begin; i < leaf.end; ++i) {
            const Foot foot = foot_on_triangle(corners_[i].ab, corners_[i].ac, p - corners_[i].a);
            const int face = order_[i];
            if (foot.squared_distance < best.foot.squared_distance ||
                (foot.squared_distance == best.foot.squared_distance && face < best.face))
                best = {face, foot};
        }
    }
    return best;
}

}  // namespace neuralmesh
