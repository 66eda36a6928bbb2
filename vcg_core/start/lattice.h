// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A regular lattice of nodes over a box: indices, adjacency, passes of separable sums, maxima and distances,
// and the topology of sets of nodes.
#pragma once

#include <vcg/space/box3.h>
#include <vcg/space/point3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <vector>

#include "vcg_core/base/indexed.h"
#include "vcg_core/base/platform.h"

namespace neuralmesh {

using NodeId = std::int32_t;
/// One value for every node of a lattice.
template <class T>
using PerNode = Indexed<T>;
/// 1 for the members, 0 for the other nodes.
using NodeSet = PerNode<std::uint8_t>;

/// Nodes at equal distances along three axes; node (x, y, z) has the id (z * ny + y) * nx + x. At most 2^31 -
/// 1 nodes.
struct Lattice {
    static constexpr float kRayStride = 0.5F;  ///< between two looks at the nodes along a ray, in steps

    int nx = 0, ny = 0, nz = 0;
    float step = 1;                ///< distance between nodes
    vcg::Point3f corner{0, 0, 0};  ///< position of node (0, 0, 0)

    Lattice() = default;
    /// Covers \p box and \p margin further nodes on each side, centred on the box.
    Lattice(const vcg::Box3f& box, float node_step, int margin) : step(node_step) {
        const auto nodes = [&](float extent) {
            const double steps = static_cast<double>(extent) / static_cast<double>(node_step);
            return static_cast<int>(std::ceil(steps)) + 1 + 2 * margin;
        };
        nx = nodes(box.DimX());
        ny = nodes(box.DimY());
        nz = nodes(box.DimZ());
        const vcg::Point3f extent(static_cast<float>(nx - 1), static_cast<float>(ny - 1),
                                  static_cast<float>(nz - 1));
        corner = box.Center() - extent * (step * 0.5F);
    }

    NodeId size() const { return nx * ny * nz; }
    NodeId index(int x, int y, int z) const { return (z * ny + y) * nx + x; }
    /// The inverse of index().
    std::array<int, 3> coordinates(NodeId i) const {
        // Unsigned division is the faster one, and this is called for every node and neighbour.
        const auto width = static_cast<std::uint32_t>(nx), height = static_cast<std::uint32_t>(ny);
        const auto node = static_cast<std::uint32_t>(i), row = node / width;
        return {static_cast<int>(node - row * width), static_cast<int>(row % height),
                static_cast<int>(row / height)};
    }
    bool contains(int x, int y, int z) const {
        return x >= 0 && x < nx && y >= 0 && y < ny && z >= 0 && z < nz;
    }
    /// Whether a node is on a side of the box, and so has fewer neighbours than others.
    bool is_on_side(int x, int y, int z) const {
        return x == 0 || y == 0 || z == 0 || x + 1 == nx || y + 1 == ny || z + 1 == nz;
    }
    bool is_on_side(NodeId i) const {
        const auto [x, y, z] = coordinates(i);
        return is_on_side(x, y, z);
    }
    vcg::Point3f position(int x, int y, int z) const {
        return corner +
               vcg::Point3f(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)) * step;
    }
    vcg::Point3f position(NodeId i) const {
        const auto [x, y, z] = coordinates(i);
        return position(x, y, z);
    }
    /// The node nearest to \p p, or size() if no node is within half a step along each axis.
    NodeId node_of(const vcg::Point3f& p) const {
        const vcg::Point3f q = (p - corner) * (1.0F / step) + vcg::Point3f(0.5F, 0.5F, 0.5F);
        // Compared as floats: a coordinate far outside does not fit into an int.
        const float fx = static_cast<float>(nx), fy = static_cast<float>(ny), fz = static_cast<float>(nz);
        if (!(q[0] >= 0 && q[1] >= 0 && q[2] >= 0 && q[0] < fx && q[1] < fy && q[2] < fz)) return size();
        return index(static_cast<int>(q[0]), static_cast<int>(q[1]), static_cast<int>(q[2]));
    }
};

inline float longest_side(const vcg::Box3f& box) { return std::max({box.DimX(), box.DimY(), box.DimZ()}); }

/// Nodes are adjacent if an edge of the Freudenthal subdivision joins them (Kuhn's six tetrahedra per cube).
/// On it foreground and background have the same connectivity, so that marching tetrahedra give a mesh of
/// exactly the topology counted on the nodes.
inline constexpr int kNeighbourCount = 14;
using NodeOffset = std::array<int, 3>;
/// Along the edges of the cube, the diagonals of its faces and its own diagonal, in both directions.
inline constexpr std::array<NodeOffset, kNeighbourCount> kNeighbourOffsets = {
    NodeOffset{1, 0, 0}, {-1, 0, 0}, {0, 1, 0},   {0, -1, 0}, {0, 0, 1},   {0, 0, -1}, {1, 1, 0},
    {-1, -1, 0},         {1, 0, 1},  {-1, 0, -1}, {0, 1, 1},  {0, -1, -1}, {1, 1, 1},  {-1, -1, -1}};

/// Some of the neighbours of a node, as bits in the order of kNeighbourOffsets.
using NeighbourSet = std::uint32_t;
inline constexpr NeighbourSet kAllNeighbours = (NeighbourSet{1} << kNeighbourCount) - 1;

/// The neighbours of nodes. For loops over many nodes: the differences of the ids are computed once.
class Neighbours {
public:
    explicit Neighbours(const Lattice& lattice) : lattice_(lattice) {
        for (std::size_t k = 0; k < kNeighbourCount; ++k) {
            const auto& [dx, dy, dz] = kNeighbourOffsets[k];
            differences_[k] = lattice.index(dx, dy, dz);
        }
    }
    /// From a node to its neighbour at the place \p k in kNeighbourOffsets, if it has one.
    NodeId difference(int k) const { return differences_[at(k)]; }
    /// The places in kNeighbourOffsets at which node \p i has a neighbour: all, but for nodes on a side.
    NeighbourSet places(NodeId i) const {
        const Lattice& l = lattice_;
        const auto [x, y, z] = l.coordinates(i);
        if (!l.is_on_side(x, y, z)) return kAllNeighbours;
        NeighbourSet set = 0;
        for (int k = 0; k < kNeighbourCount; ++k) {
            const auto& [dx, dy, dz] = kNeighbourOffsets[static_cast<std::size_t>(k)];
            if (l.contains(x + dx, y + dy, z + dz)) set |= NeighbourSet{1} << k;
        }
        return set;
    }
    /// Calls visit(j, k) for the neighbours j of node \p i at the places k of \p places.
    template <class Visit>
    void for_each_at(NodeId i, NeighbourSet places, const Visit& visit) const {
        if (places == kAllNeighbours) {
            for (int k = 0; k < kNeighbourCount; ++k) visit(i + difference(k), k);
        } else {
            for (; places != 0; places &= places - 1) {
                const int k = lowest_bit(places);
                visit(i + difference(k), k);
            }
        }
    }

private:
    Lattice lattice_;  // a copy, so that the compiler need not reload its numbers after each store of an id
    std::array<NodeId, kNeighbourCount> differences_{};
};

/// Calls visit(x, y, z) for all nodes in the order of their ids.
template <class Visit>
void for_each_node(const Lattice& l, const Visit& visit) {
    for (int z = 0; z < l.nz; ++z)
        for (int y = 0; y < l.ny; ++y)
            for (int x = 0; x < l.nx; ++x) visit(x, y, z);
}

/// Calls visit(i) for the members of \p nodes, in order. O(nodes), a hundred at a time, + O(members).
template <class Visit>
void for_each_member(const NodeSet& nodes, const Visit& visit) {
    const std::uint8_t* const begin = nodes.data();
    const std::uint8_t* const end = begin + nodes.size();
    for (const std::uint8_t* i = begin; i != end; ++i) {
        i = static_cast<const std::uint8_t*>(std::memchr(i, 1, static_cast<std::size_t>(end - i)));
        if (i == nullptr) return;
        visit(static_cast<NodeId>(i - begin));
    }
}

/// Replaces each value v of row i by combine(v, w, i - j) for the values w at the same place of the rows j
/// within \p reach of i, for \p count rows of \p width values, \p stride apart from \p first on. \p combine
/// must not depend on the order of the rows. \p scratch is for a copy of them. O(count * width * reach).
template <class T, class Combine>
void combine_rows(T* first, int count, std::ptrdiff_t stride, int width, int reach, const Combine& combine,
                  std::vector<T>& scratch) {
    const std::ptrdiff_t w = width;
    scratch.resize(static_cast<std::size_t>(count * w));
    for (int i = 0; i < count; ++i) std::copy_n(first + i * stride, w, scratch.data() + i * w);
    for (int i = 0; i < count; ++i) {
        T* out = first + i * stride;
        for (int j = std::max(0, i - reach); j <= std::min(count - 1, i + reach); ++j) {
            if (j == i) continue;
            const T* in = scratch.data() + j * w;
            for (std::ptrdiff_t x = 0; x < w; ++x) out[x] = combine(out[x], in[x], i - j);
        }
    }
}

/// combine_rows() of all rows along x with those beside them along y, then along z.
template <class T, class Combine>
void combine_across_rows(const Lattice& l, int reach, const Combine& combine, PerNode<T>& values) {
    std::vector<T> scratch;
    const std::ptrdiff_t row = l.nx, slice = row * l.ny;
    for (int z = 0; z < l.nz; ++z)
        combine_rows(values.data() + z * slice, l.ny, row, l.nx, reach, combine, scratch);
    for (int y = 0; y < l.ny; ++y)
        combine_rows(values.data() + y * row, l.nz, slice, l.nx, reach, combine, scratch);
}

/// Consecutive nodes of a row along x.
struct Run {
    NodeId begin, end;

    /// Their range of \p values.
    template <class T>
    auto begin_in(T& values) const {
        return values.begin() + begin;
    }
    template <class T>
    auto end_in(T& values) const {
        return values.begin() + end;
    }
};

/// Calls visit(runs) for each connected component of the nodes i with nodes[i] = \p value, 0 or 1, in order
/// of their smallest nodes; the runs are in ascending order. \p visit may change \p nodes. O(nodes), a
/// hundred at a time, + O(runs).
void for_each_component(const Lattice& lattice, const NodeSet& nodes, std::uint8_t value,
                        const std::function<void(Span<const Run>)>& visit);

/// Euler characteristic of the simplices all of whose nodes are in \p solid: components - handles + cavities.
/// O(nodes), 64 at a time.
int euler_characteristic(const Lattice& lattice, const NodeSet& solid);

}  // namespace neuralmesh
