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

/// Collects triangles whose vertices lie on lattice edges.
class EdgeTriangles {
public:
    EdgeTriangles(const Lattice& lattice, const PerNode<float>& values)
        : lattice_(lattice), values_(values) {}

    void add_cubes();
    IndexedMesh<float> mesh() const;

private:
    void add_cube(int x, int y, int z);
    void add_tetrahedron(NodeId node, const std::array<int, 4>& corners, unsigned solid_corners);
    void add_triangle(EdgeKey a, EdgeKey b, EdgeKey c) { keys_.insert(keys_.end(), {a, b, c}); }
    NodeId offset(int corner) const { return lattice_.index(corner & 1, (corner >> 1) & 1, corner >> 2); }
    Point3f point_on(EdgeKey key) const;

    const Lattice& lattice_;
    const PerNode<float>& values_;
    std::vector<EdgeKey> keys_;
};

void EdgeTriangles::add_cube(int x, int y, int z) {
    const NodeId node = lattice_.index(x, y, z);
    unsigned solid = 0;
    for (int corner = 0; corner < 8; ++corner)
        if (values_[node + offset(corner)] < 0) solid |= 1U << corner;
    if (solid == 0 || solid == 255) return;
    for (const std::array<int, 4>& corners : kTetrahedra) add_tetrahedron(node, corners, solid);
}

void EdgeTriangles::add_tetrahedron(NodeId node, const std::array<int, 4>& corners, unsigned solid_corners) {
    const auto corner = [&](int i) { return corners[static_cast<std::size_t>(i)]; };
    const auto solid = [&](int i) { return (solid_corners >> corner(i) & 1U) != 0; };
    // The corner bits of one end of a lattice edge contain those of the other.
    const auto edge = [&](int i, int j) {
        const int low = corner(i) & corner(j), high = corner(i) | corner(j);
        return static_cast<EdgeKey>(node + offset(low)) * 8 + static_cast<EdgeKey>(high - low);
    };
    const int count = solid(0) + solid(1) + solid(2) + solid(3);
    if (count == 1 || count == 3) {
        for (const auto& [p, a, b, c] : kVertexFirst) {
            if (solid(p) != (count == 1)) continue;
            if (count == 1) {
                add_triangle(edge(p, a), edge(p, b), edge(p, c));
            } else {
                add_triangle(edge(p, a), edge(p, c), edge(p, b));
            }
        }
    } else if (count == 2) {
        for (const auto& [i, j, k, l] : kPairFirst) {
            if (!solid(i) || !solid(j)) continue;
            add_triangle(edge(i, k), edge(i, l), edge(j, l));
            add_triangle(edge(i, k), edge(j, l), edge(j, k));
        }
    }
}

Point3f EdgeTriangles::point_on(EdgeKey key) const {
    const NodeId node = static_cast<NodeId>(key / 8);
    const int corner = static_cast<int>(key % 8);
    const Point3f along(static_cast<float>(corner & 1), static_cast<float>((corner >> 1) & 1),
                        static_cast<float>(corner >> 2));
    const float a = values_[node], b = values_[node + offset(corner)];
    const float t = std::min(1 - kMinEdgeShare, std::max(kMinEdgeShare, a / (a - b)));
    return lattice_.position(node) + along * (t * lattice_.step);
}

IndexedMesh<float> EdgeTriangles::mesh() const {
    constexpr int kNone = -1, kNext = -2;
    std::vector<int> vertex(8 * static_cast<std::size_t>(lattice_.size()), kNone);
    for (const EdgeKey key : keys_) vertex[key] = kNext;
    IndexedMesh<float> result;
    for (EdgeKey key = 0; key < vertex.size(); ++key) {
        if (vertex[key] == kNone) continue;
        vertex[key] = static_cast<int>(result.positions.size());
        result.positions.push_back(point_on(key));
    }
    for (std::size_t i = 0; i < keys_.size(); i += 3)
        result.faces.push_back({vertex[keys_[i]], vertex[keys_[i + 1]], vertex[keys_[i + 2]]});
    return result;
}

void EdgeTriangles::add_cubes() {
    for (int z = 0; z + 1 < lattice_.nz; ++z)
        for (int y = 0; y + 1 < lattice_.ny; ++y)
            for (int x = 0; x + 1 < lattice_.nx; ++x) add_cube(x, y, z);
}

}  // namespace

IndexedMesh<float> marching_tetrahedra(const Lattice& lattice, const PerNode<float>& values) {
    EdgeTriangles triangles(lattice, values);
    triangles.add_cubes();
    return triangles.mesh();
}

}  // namespace neuralmesh
