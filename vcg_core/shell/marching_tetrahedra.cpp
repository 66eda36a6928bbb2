// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/shell/marching_tetrahedra.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "vcg_core/base/platform.h"

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
using EdgeKey = std::uint64_t;

/// A set of lattice edges, each with the number of those with smaller keys.
class RankedEdges {
public:
    /// \p keys: below 8 * \p nodes
    RankedEdges(const std::vector<EdgeKey>& keys, NodeId nodes)
        : words_(nodes / (kBits / kKeysPerNode) + 1, 0), first_(words_.size()) {
        for (const EdgeKey key : keys) words_[word_of(key)] |= std::uint64_t{1} << (key % kBits);
        for (int w = 0; w < words_.size(); ++w) {
            first_[w] = count_;
            count_ += bit_count(words_[w]);
        }
    }
    int size() const { return count_; }
    int rank(EdgeKey key) const {
        const std::uint64_t smaller = (std::uint64_t{1} << (key % kBits)) - 1;
        return first_[word_of(key)] + bit_count(words_[word_of(key)] & smaller);
    }
    /// Calls visit(key) in rising order.
    template <class Visit>
    void for_each(const Visit& visit) const {
        for (int w = 0; w < words_.size(); ++w)
            for (std::uint64_t left = words_[w]; left != 0; left &= left - 1)
                visit(static_cast<EdgeKey>(w) * kBits + static_cast<EdgeKey>(lowest_bit(left)));
    }

private:
    static constexpr int kBits = 64, kKeysPerNode = 8;
    static int word_of(EdgeKey key) { return static_cast<int>(key / kBits); }

    Indexed<std::uint64_t> words_;
    Indexed<int> first_;  ///< number of the keys in the words before
    int count_ = 0;
};

/// Collects triangles whose vertices lie on lattice edges.
class EdgeTriangles {
public:
    EdgeTriangles(const Lattice& lattice, const PerNode<float>& values, const TetrahedronFilter& wanted)
        : lattice_(lattice), values_(values), wanted_(wanted) {}

    void add_cubes();
    /// \p nodes: receives for every vertex one end of the lattice edge it lies on
    IndexedMesh<float> mesh(std::vector<NodeId>& nodes) const;

private:
    void add_cube(int x, int y, int z);
    void add_tetrahedron(NodeId node, const std::array<int, 4>& corners, unsigned solid_corners);
    void add_triangle(EdgeKey a, EdgeKey b, EdgeKey c) { keys_.insert(keys_.end(), {a, b, c}); }
    NodeId offset(int corner) const { return lattice_.index(corner & 1, (corner >> 1) & 1, corner >> 2); }
    Point3f point_on(EdgeKey key) const;

    const Lattice& lattice_;
    const PerNode<float>& values_;
    const TetrahedronFilter& wanted_;
    std::vector<EdgeKey> keys_;
};

void EdgeTriangles::add_cube(int x, int y, int z) {
    const NodeId node = lattice_.index(x, y, z);
    unsigned solid = 0;
    for (int corner = 0; corner < 8; ++corner)
        if (values_[node + offset(corner)] < 0) solid |= 1U << corner;
    if (solid == 0 || solid == 255) return;
    for (const std::array<int, 4>& corners : kTetrahedra) {
        if (wanted_ && !wanted_({node + offset(corners[0]), node + offset(corners[1]),
                                 node + offset(corners[2]), node + offset(corners[3])}))
            continue;
        add_tetrahedron(node, corners, solid);
    }
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

IndexedMesh<float> EdgeTriangles::mesh(std::vector<NodeId>& nodes) const {
    const RankedEdges edges(keys_, lattice_.size());
    IndexedMesh<float> result;
    result.positions.reserve(static_cast<std::size_t>(edges.size()));
    edges.for_each([&](EdgeKey key) {
        result.positions.push_back(point_on(key));
        nodes.push_back(static_cast<NodeId>(key / 8));
    });
    result.faces.reserve(keys_.size() / 3);
    for (std::size_t i = 0; i < keys_.size(); i += 3)
        result.faces.push_back({edges.rank(keys_[i]), edges.rank(keys_[i + 1]), edges.rank(keys_[i + 2])});
    return result;
}

void EdgeTriangles::add_cubes() {
    for (int z = 0; z + 1 < lattice_.nz; ++z)
        for (int y = 0; y + 1 < lattice_.ny; ++y)
            for (int x = 0; x + 1 < lattice_.nx; ++x) add_cube(x, y, z);
}

}  // namespace

IndexedMesh<float> marching_tetrahedra(const Lattice& lattice, const PerNode<float>& values,
                                       const TetrahedronFilter& wanted, std::vector<NodeId>& nodes) {
    EdgeTriangles triangles(lattice, values, wanted);
    triangles.add_cubes();
    return triangles.mesh(nodes);
}

IndexedMesh<float> marching_tetrahedra(const Lattice& lattice, const PerNode<float>& values) {
    std::vector<NodeId> nodes;
    return marching_tetrahedra(lattice, values, {}, nodes);
}

}  // namespace neuralmesh
