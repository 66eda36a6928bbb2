// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/start/marching_tetrahedra.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace neuralmesh {
namespace {

using vcg::Point3f;

// Vertices stay this share of a lattice edge away from its ends, so that no face is degenerate.
constexpr float kMinEdgeShare = 0.1F;

/// Kuhn's six tetrahedra of a cube, positively oriented; corner bits: 1 = x, 2 = y, 4 = z.
constexpr std::array<std::array<int, 4>, 6> kTetrahedra = {
    {{0, 1, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 3, 2, 7}, {0, 6, 4, 7}, {0, 5, 1, 7}}};

/// Even permutations of a tetrahedron's corners: one that starts with each corner, and one that starts with
/// each pair of corners.
constexpr std::array<std::array<int, 4>, 4> kVertexFirst = {
    {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}}};
constexpr std::array<std::array<int, 4>, 6> kPairFirst = {
    {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}}};

/// A lattice edge: 8 * its lower end + the corner bits from there to its upper end.
using EdgeKey = std::size_t;

/// The node at a corner of the cube whose lowest corner is node 0.
NodeId offset(const Lattice& lattice, int corner) {
    return lattice.index(corner & 1, (corner >> 1) & 1, corner >> 2);
}

/// Adds to \p keys the lattice edges at the corners of the triangles between the \p solid_corners of a
/// tetrahedron and the others.
void add_tetrahedron(const Lattice& lattice, NodeId node, const std::array<int, 4>& corners,
                     unsigned solid_corners, std::vector<EdgeKey>& keys) {
    const auto corner = [&](int i) { return corners[static_cast<std::size_t>(i)]; };
    const auto solid = [&](int i) { return (solid_corners >> corner(i) & 1U) != 0; };
    // The corner bits of one end of a lattice edge contain those of the other.
    const auto edge = [&](int i, int j) {
        const int low = corner(i) & corner(j), high = corner(i) | corner(j);
        return static_cast<EdgeKey>(node + offset(lattice, low)) * 8 + static_cast<EdgeKey>(high - low);
    };
    const auto add = [&](EdgeKey a, EdgeKey b, EdgeKey c) { keys.insert(keys.end(), {a, b, c}); };
    const int count = solid(0) + solid(1) + solid(2) + solid(3);
    if (count == 1 || count == 3) {
        for (const auto& [p, a, b, c] : kVertexFirst) {
            if (solid(p) != (count == 1)) continue;
            add(edge(p, a), edge(p, count == 1 ? b : c), edge(p, count == 1 ? c : b));
        }
    } else if (count == 2) {
        for (const auto& [i, j, k, l] : kPairFirst) {
            if (!solid(i) || !solid(j)) continue;
            add(edge(i, k), edge(i, l), edge(j, l));
            add(edge(i, k), edge(j, l), edge(j, k));
        }
    }
}

Point3f point_on(const Lattice& lattice, const PerNode<float>& values, EdgeKey key) {
    const NodeId node = static_cast<NodeId>(key / 8);
    const int corner = static_cast<int>(key % 8);
    const Point3f along(static_cast<float>(corner & 1), static_cast<float>((corner >> 1) & 1),
                        static_cast<float>(corner >> 2));
    const float a = values[node], b = values[node + offset(lattice, corner)];
    const float t = std::min(1 - kMinEdgeShare, std::max(kMinEdgeShare, a / (a - b)));
    return lattice.position(node) + along * (t * lattice.step);
}

}  // namespace

IndexedMesh<float> marching_tetrahedra(const Lattice& lattice, const PerNode<float>& values) {
    std::vector<EdgeKey> keys;  // three for each triangle
    for_each_node(lattice, [&](int x, int y, int z) {
        if (x + 1 == lattice.nx || y + 1 == lattice.ny || z + 1 == lattice.nz) return;
        const NodeId node = lattice.index(x, y, z);
        unsigned solid = 0;
        for (int corner = 0; corner < 8; ++corner)
            if (values[node + offset(lattice, corner)] < 0) solid |= 1U << corner;
        if (solid == 0 || solid == 255) return;
        for (const std::array<int, 4>& corners : kTetrahedra)
            add_tetrahedron(lattice, node, corners, solid, keys);
    });
    constexpr int kNone = -1, kNext = -2;
    std::vector<int> vertex(8 * static_cast<std::size_t>(lattice.size()), kNone);
    for (const EdgeKey key : keys) vertex[key] = kNext;
    IndexedMesh<float> result;
    for (EdgeKey key = 0; key < vertex.size(); ++key) {
        if (vertex[key] == kNone) continue;
        vertex[key] = static_cast<int>(result.positions.size());
        result.positions.push_back(point_on(lattice, values, key));
    }
    for (std::size_t i = 0; i < keys.size(); i += 3)
        result.faces.push_back({vertex[keys[i]], vertex[keys[i + 1]], vertex[keys[i + 2]]});
    return result;
}

}  // namespace neuralmesh
