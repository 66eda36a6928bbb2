// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/mesh/face_tree.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

#include "vcg_core/base/parallel_for.h"
#include "vcg_core/base/z_order.h"

namespace neuralmesh {

namespace {

constexpr int kChunk = 512;

std::vector<int> all_faces(const Surface& surface) {
    std::vector<int> faces(surface.faces.vector().size());
    std::iota(faces.begin(), faces.end(), 0);
    return faces;
}

}  // namespace

FaceTree::FaceTree(const Surface& surface, ThreadTeam& team) : FaceTree(surface, all_faces(surface), team) {}

FaceTree::FaceTree(const Surface& surface, std::vector<int> faces, ThreadTeam& team)
    : order_(std::move(faces)) {
    if (order_.empty()) return;
    Indexed<Entry> entries(order_.size());
    parallel_for(entries.size(), kChunk, team, [&](int i) {
        const int f = order_[i];
        entries[i] = {surface.corner(f, 0) + surface.corner(f, 1) + surface.corner(f, 2), f};
    });
    nodes_.resize(node_count(order_.size()));
    std::vector<Part> parts{{0, 0, order_.size()}};
    for (const int levels : {1, 1, 1, 1, static_cast<int>(kStack)})
        parts = parallel_collect<Part>(
            static_cast<int>(parts.size()), 1, team,
            [&](int i, std::vector<Part>& below) { divide(entries, parts[i], levels, below); });
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

/// Makes \p levels levels of nodes, divided at the median, and appends the parts of those below.
void FaceTree::divide(Indexed<Entry>& entries, const Part& part, int levels, std::vector<Part>& below) {
    const auto [node, begin, end] = part;
    if (levels == 0) {
        below.push_back(part);
        return;
    }
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
    divide(entries, {node + 1, begin, middle}, levels - 1, below);
    divide(entries, {nodes_[node].right, middle, end}, levels - 1, below);
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

// The nearest faces: packets of eight points that are near each other pass through the tree together. Source:
// Wald et al., "Interactive Rendering with Coherent Ray Tracing" (2001), for rays.
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
