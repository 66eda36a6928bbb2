// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/mesh/face_tree.h"

#include <numeric>
#include <utility>

#include "vcg_core/base/parallel_for.h"

namespace neuralmesh {

namespace {

constexpr int kChunk = 512;

std::vector<int> all_faces(const Surface& surface) {
    std::vector<int> faces(surface.faces.vector().size());
    std::iota(faces.begin(), faces.end(), 0);
    return faces;
}

}  // namespace

FaceTree::FaceTree(const Surface& surface) : FaceTree(surface, all_faces(surface)) {}

FaceTree::FaceTree(const Surface& surface, ThreadTeam& team) : FaceTree(surface, all_faces(surface), team) {}

FaceTree::FaceTree(const Surface& surface, std::vector<int> faces) : order_(std::move(faces)) {
    ThreadTeam alone(1);
    build(surface, alone);
}

FaceTree::FaceTree(const Surface& surface, std::vector<int> faces, ThreadTeam& team)
    : order_(std::move(faces)) {
    build(surface, team);
}

void FaceTree::build(const Surface& surface, ThreadTeam& team) {
    if (order_.empty()) return;
    Indexed<Entry> entries(order_.size());
    parallel_for(entries.size(), kChunk, team, [&](int i) {
        const int f = order_[i];
        entries[i] = {surface.corner(f, 0) + surface.corner(f, 1) + surface.corner(f, 2), f};
    });
    nodes_.resize(node_count(order_.size()));
    divide(entries, 0, 0, order_.size());
    for (int i = 0; i < order_.size(); ++i) order_[i] = entries[i].face;
    set_boxes(surface, team);
}

FaceTree::Box FaceTree::box_of(const Surface& surface, int face) {
    Box box(surface.corner(face, 0));
    box.extend(surface.corner(face, 1));
    box.extend(surface.corner(face, 2));
    return box;
}

/// Of a tree of so many faces. On a level of \p parts nodes their faces differ by 1 at most.
int FaceTree::node_count(int faces) {
    int parts = 1;
    while (faces / parts > kLeafFaces) parts *= 2;
    const int divided = faces / parts == kLeafFaces ? faces % parts : 0;
    return 2 * (parts + divided) - 1;
}

/// Makes the node of the faces from \p begin to \p end, and, divided at the median, those below it.
void FaceTree::divide(Indexed<Entry>& entries, int node, int begin, int end) {
    nodes_[node] = {Box(), begin, end, -1};
    if (end - begin <= kLeafFaces) return;
    Box box;
    for (int i = begin; i < end; ++i) box.extend(entries[i].centre);
    Eigen::Index axis = 0;
    box.sizes().maxCoeff(&axis);
    const int middle = begin + (end - begin) / 2;
    std::nth_element(entries.begin() + begin, entries.begin() + middle, entries.begin() + end,
                     [axis](const Entry& a, const Entry& b) {
                         const float x = a.centre[axis];
                         const float y = b.centre[axis];
                         return x < y || (x == y && a.face < b.face);
                     });
    nodes_[node].right = node + 1 + node_count(middle - begin);
    divide(entries, node + 1, begin, middle);
    divide(entries, nodes_[node].right, middle, end);
}

void FaceTree::set_boxes(const Surface& surface, ThreadTeam& team) {
    corners_ = Indexed<Corners>(order_.size());
    boxes_ = Indexed<Box>(order_.size());
    parallel_for(order_.size(), kChunk, team, [&](int i) {
        const Vector3& a = surface.corner(order_[i], 0);
        corners_[i] = {a, surface.corner(order_[i], 1) - a, surface.corner(order_[i], 2) - a};
        boxes_[i] = box_of(surface, order_[i]);
    });
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

}  // namespace neuralmesh
