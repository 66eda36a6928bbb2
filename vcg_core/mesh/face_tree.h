// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A bounding-volume hierarchy over the faces of a surface.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "vcg_core/base/thread_team.h"
#include "vcg_core/mesh/surface.h"

namespace neuralmesh {

/// A binary tree of axis-aligned boxes, divided at the median of the faces' centres along the longest side.
/// Queries may run at the same time in several threads. vcglib's grids are slower here, where the sizes of
/// faces differ by factors of hundreds. Eigen's KdBVH finds the same faces, but makes a whole run 14 % longer
/// (100,000 points, 10,000 vertices, one thread).
class FaceTree {
public:
    /// O(faces log faces).
    FaceTree(const Surface& surface, ThreadTeam& team);
    /// Over the given \p faces of the surface only.
    FaceTree(const Surface& surface, std::vector<int> faces, ThreadTeam& team);

    /// The nearest face of each of \p points, the one of smallest index among equals; face -1 if the tree is
    /// empty. Exact by foot_on_triangle() for faces up to about 1. Does not depend on the number of threads.
    /// O(points x log faces) expected near the surface.
    std::vector<Hit> nearest(const std::vector<Vector3>& points, ThreadTeam& team) const;
    /// That of one point, in more time than that of one of many.
    Hit nearest(const Vector3& p) const;

    /// The number of nodes. The faces of a leaf are a group; the groups of the other nodes are empty.
    int group_count() const { return nodes_.size(); }
    /// Calls \p visit(f, g) for every two faces whose bounding boxes touch, where f is of the \p i-th group
    /// and g of the same or of a later one. Over all groups this gives each pair once.
    template <class Visit>
    void for_overlapping_pairs(int i, const Visit& visit) const;
    /// Calls \p visit(g) for every face g of the tree whose bounding box touches that of \p face of \p
    /// surface.
    template <class Visit>
    void for_overlapping(const Surface& surface, int face, const Visit& visit) const {
        for_overlapping(box_of(surface, face), visit);
    }
    /// The same for a given \p box.
    template <class Visit>
    void for_overlapping(const Eigen::AlignedBox3f& box, const Visit& visit) const {
        for_leaves(box, 0, [&](const Node& leaf) {
            for (int j = leaf.begin; j < leaf.end; ++j)
                if (box.intersects(boxes_[j])) visit(order_[j]);
        });
    }

private:
    using Box = Eigen::AlignedBox3f;

    static constexpr int kLeafFaces = 4;
    /// The tree is balanced, so this is more than its height.
    static constexpr std::size_t kStack = 64;
    /// The computed squared distance of a face has an error of some roundings of the face's size, which is at
    /// most about 1. So boxes are looked at up to kShare x the least distance found + kSquaredRounding.
    static constexpr float kShare = 1.001F, kSquaredRounding = 2e-10F;

    struct Node {
        Box box;
        int begin, end;  ///< into order_
        int right;       ///< the left child follows its parent; -1: a leaf
        bool is_leaf() const { return right < 0; }
    };
    struct Corners {
        Vector3 a, ab, ac;
    };
    /// A face while the tree is built, with three times its centre.
    struct Entry {
        Vector3 centre;
        int face;
    };

    /// A node while the tree is built, with its faces.
    struct Part {
        int node, begin, end;
    };

    static Box box_of(const Surface& surface, int face);
    static int node_count(int faces);
    void divide(Indexed<Entry>& entries, const Part& part, int levels, std::vector<Part>& below);
    void set_boxes(const Surface& surface, ThreadTeam& team);
    struct Packet;
    template <class Visit>
    void for_leaves(const Box& box, int first, const Visit& visit) const;

    Indexed<int> order_;
    Indexed<Corners> corners_;  ///< in order_
    Indexed<Box> boxes_;        ///< in order_
    Indexed<Node> nodes_;
};

/// Calls \p visit(leaf) for every leaf whose box touches \p box and that does not end before the face \p
/// first in the order of the tree.
template <class Visit>
void FaceTree::for_leaves(const Box& box, int first, const Visit& visit) const {
    std::array<int, kStack> stack;
    std::size_t height = 0;
    if (!nodes_.empty()) stack[height++] = 0;
    while (height > 0) {
        const int n = stack[--height];
        const Node& node = nodes_[n];
        if (node.end <= first || !box.intersects(node.box)) continue;
        if (!node.is_leaf()) {
            stack[height++] = node.right;
            stack[height++] = n + 1;
            continue;
        }
        visit(node);
    }
}

template <class Visit>
void FaceTree::for_overlapping_pairs(int i, const Visit& visit) const {
    const Node& leaf = nodes_[i];
    if (!leaf.is_leaf()) return;
    for_leaves(leaf.box, leaf.begin, [&](const Node& other) {
        for (int f = leaf.begin; f < leaf.end; ++f) {
            if (!boxes_[f].intersects(other.box)) continue;
            for (int g = std::max(f + 1, other.begin); g < other.end; ++g)
                if (boxes_[f].intersects(boxes_[g])) visit(order_[f], order_[g]);
        }
    });
}

}  // namespace neuralmesh
