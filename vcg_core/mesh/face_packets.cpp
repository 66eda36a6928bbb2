// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The nearest faces of many points: packets of eight points that are near each other pass through the tree
// together. Source: Wald et al., "Interactive Rendering with Coherent Ray Tracing" (2001), for rays.
#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>

#include "vcg_core/base/parallel_for.h"
#include "vcg_core/base/z_order.h"
#include "vcg_core/mesh/face_tree.h"
#include "vcg_core/mesh/triangle_lanes.h"

namespace neuralmesh {

namespace {

constexpr std::size_t kLanes = 8;
constexpr std::size_t kPackets = 64;  ///< per task of a thread

/// Sorts points by cells along the Z-order curve: about as many cells as points, in \p box.
std::vector<std::uint32_t> along_z_order(const std::vector<Vector3>& points, const Eigen::AlignedBox3f& box,
                                         ThreadTeam& team) {
    constexpr int kMostBits = 7;
    int bits = 1;
    while (bits < kMostBits && std::size_t{1} << (3 * bits) < points.size()) ++bits;
    const auto cells = static_cast<float>(1 << bits);
    constexpr float kLeastSize = 1e-20F;  // of a flat box
    const Vector3 scale = cells * box.sizes().cwiseMax(kLeastSize).cwiseInverse();
    std::vector<std::uint32_t> cell(points.size());
    for_chunks(points.size(), kLanes * kPackets, team, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Vector3 at = (points[i] - box.min()).cwiseProduct(scale).cwiseMax(0.0F).cwiseMin(cells - 1);
            cell[i] = static_cast<std::uint32_t>(z_order(static_cast<std::uint64_t>(at[0]),
                                                         static_cast<std::uint64_t>(at[1]),
                                                         static_cast<std::uint64_t>(at[2])));
        }
    });
    std::vector<std::uint32_t> next((std::size_t{1} << (3 * bits)) + 1, 0);
    for (const std::uint32_t c : cell) ++next[c + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    std::vector<std::uint32_t> order(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) order[next[cell[i]]++] = static_cast<std::uint32_t>(i);
    return order;
}

NEURALMESH_ALWAYS_INLINE void larger(const Eight& a, const Eight& b, Eight& result) {
    choose(a > b, a, b, result);
}

/// AlignedBox::squaredExteriorDistance() of eight points.
NEURALMESH_ALWAYS_INLINE void squared_distance_to(const Eigen::AlignedBox3f& box, const EightVectors& p,
                                                  Eight& result) {
    const Eight zero = Eight{};
    Eight x, y, z;
    larger(box.min()[0] - p.x, p.x - box.max()[0], x);
    larger(box.min()[1] - p.y, p.y - box.max()[1], y);
    larger(box.min()[2] - p.z, p.z - box.max()[2], z);
    larger(x, zero, x);
    larger(y, zero, y);
    larger(z, zero, z);
    result = x * x + y * y + z * z;
}

}  // namespace

struct FaceTree::Packet {
    EightVectors points;
    Eight least;      ///< squared distance so far
    Eight bound;      ///< on the squared distance of boxes to look at
    EightInts face;   ///< at the least distance; -1: none
    EightInts place;  ///< of the face in the order of the tree

    NEURALMESH_MULTIVERSIONED static void search(Packet& packet, const FaceTree& tree);
    NEURALMESH_ALWAYS_INLINE static void look_at(Packet& packet, const FaceTree& tree, int place);
};

void FaceTree::Packet::look_at(Packet& packet, const FaceTree& tree, int place) {
    Eight squared;
    squared_distance_to(tree.boxes_[place], packet.points, squared);
    if (!any(~(squared > packet.bound))) return;
    const Corners& corners = tree.corners_[place];
    const EightVectors ap{packet.points.x - corners.a[0], packet.points.y - corners.a[1],
                          packet.points.z - corners.a[2]};
    squared_distance_to_triangle(corners.ab, corners.ac, ap, squared);
    const EightInts face = EightInts{} + tree.order_[place];
    const EightInts better = (squared < packet.least) | ((squared == packet.least) & (face < packet.face));
    choose(better, squared, packet.least, packet.least);
    packet.bound = packet.least * kShare + kSquaredRounding;
    choose(better, face, packet.face, packet.face);
    choose(better, EightInts{} + place, packet.place, packet.place);
}

/// The descent follows a point in the middle of the packet.
void FaceTree::Packet::search(Packet& packet, const FaceTree& tree) {
    constexpr std::size_t kMiddle = kLanes / 2;
    struct Waiting {
        Eight squared_distance;
        int node;
    };
    Waiting stack[kStack];
    std::size_t height = 0;
    stack[height++] = {Eight{}, 0};
    while (height > 0) {
        const Waiting& top = stack[--height];
        if (!any(~(top.squared_distance > packet.bound))) continue;
        int n = top.node;
        while (!tree.nodes_[n].is_leaf()) {
            const int left = n + 1, right = tree.nodes_[n].right;
            Eight to_left, to_right;
            squared_distance_to(tree.nodes_[left].box, packet.points, to_left);
            squared_distance_to(tree.nodes_[right].box, packet.points, to_right);
            const bool goes_left = any(~(to_left > packet.bound));
            const bool goes_right = any(~(to_right > packet.bound));
            if (!goes_left && !goes_right) break;
            if (goes_left && goes_right) {
                const bool left_first = to_left[kMiddle] <= to_right[kMiddle];
                stack[height++] = left_first ? Waiting{to_right, right} : Waiting{to_left, left};
                n = left_first ? left : right;
            } else {
                n = goes_left ? left : right;
            }
        }
        const Node& leaf = tree.nodes_[n];
        for (int i = leaf.begin; leaf.is_leaf() && i < leaf.end; ++i) look_at(packet, tree, i);
    }
}

std::vector<Hit> FaceTree::nearest(const std::vector<Vector3>& points, ThreadTeam& team) const {
    constexpr float kFar = std::numeric_limits<float>::max();
    std::vector<Hit> hits(points.size(), {-1, {kFar, {1, 0, 0}}});
    if (nodes_.empty()) return hits;
    const std::vector<std::uint32_t> order = along_z_order(points, nodes_[0].box, team);
    const auto search_packet = [&](std::size_t first, std::size_t last) {
        Packet packet;
        packet.least = packet.bound = Eight{} + kFar;
        packet.face = packet.place = EightInts{} - 1;
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const Vector3& p = points[order[std::min(first + lane, last)]];
            packet.points.x[lane] = p[0];
            packet.points.y[lane] = p[1];
            packet.points.z[lane] = p[2];
        }
        Packet::search(packet, *this);
        for (std::size_t lane = 0; lane < kLanes && first + lane <= last; ++lane) {
            if (packet.face[lane] < 0) continue;
            const Corners& corners = corners_[packet.place[lane]];
            const std::size_t i = order[first + lane];
            hits[i] = {packet.face[lane], foot_on_triangle(corners.ab, corners.ac, points[i] - corners.a)};
        }
    };
    for_chunks(points.size(), kLanes * kPackets, team, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; i += kLanes) search_packet(i, end - 1);
    });
    return hits;
}

Hit FaceTree::nearest(const Vector3& p) const {
    ThreadTeam alone(1);
    return nearest(std::vector<Vector3>{p}, alone).front();
}

}  // namespace neuralmesh
