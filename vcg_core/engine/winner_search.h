// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The winner of a signal: the nearest vertex of a network whose vertices move, are added and are removed. A
// hashed uniform grid.
//
// vcglib's hash table, vcg::SpatialHashTable, takes longer, and its removing members do not compile.
#pragma once

#include <vcg/space/point3.h>

#include <cstdint>
#include <vector>

#include "vcg_core/base/simd.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// Nearest-vertex search. Exact within 1.5 of the origin, where the core's frame reaches to 0.5; beyond that,
/// exact up to float rounding of cell coordinates. Ties go to the smaller id, so the result is that of a
/// linear search to the bit. Report every change of the network through add(), move() and remove().
///
/// The hash table maps a cell to the head of a list of vertices. It stores no keys: cells with the same hash
/// share a list. That costs a few distances to vertices of other cells, which cannot win, and saves all
/// comparisons of keys. The table is rebuilt when the number of vertices has doubled or fallen to a third.
///
/// Memory: 8 to 32 bytes per vertex. The links of the lists are stored in the network's
/// vertex records.
class WinnerSearch {
public:
    /// Keeps a reference to \p network. O(vertices).
    explicit WinnerSearch(Network& network);

    /// The vertex nearest to \p s. O(1) expected near a mesh with edges of similar length, O(vertices) far
    /// from it and where many crowd in one cell.
    VertexId winner(const vcg::Point3f& s) const;
    /// Prefetch what winner(s) reads first: the heads of lists, then, once those are in the cache, the first
    /// vertex of each list.
    void prefetch_heads(const vcg::Point3f& s) const;
    void prefetch_vertices(const vcg::Point3f& s) const;

    /// Call after \p v was added to the network. O(1).
    void add(VertexId v);
    /// Call before \p v is removed from the network. O(1) expected.
    void remove(VertexId v);
    /// A vertex that has moved from one cell of the table to another.
    struct ChangedCell {
        VertexId vertex;
        FourInts from, to;
    };
    /// Moves \p v to \p where (x, y, z, 0) in the network, but not in the table: appends to \p changed what
    /// relink() has to be called with before the next search. Threads may place different vertices. O(1).
    void place(VertexId v, Four where, std::vector<ChangedCell>& changed) {
        store(v, where, [&changed](const ChangedCell& cell) { changed.push_back(cell); });
    }
    /// The changes of a vertex in their order. O(1) expected.
    void relink(const ChangedCell& changed) {
        unlink(changed.vertex, bucket_of(changed.from));
        link(changed.vertex, bucket_of(changed.to));
    }
    /// Moves \p v to \p where (x, y, z, 0), in the network and in the table. O(1) expected.
    void move(VertexId v, Four where) {
        store(v, where, [this](const ChangedCell& cell) { relink(cell); });
    }
    void move(VertexId v, const vcg::Point3f& where) { move(v, Four{where[0], where[1], where[2], 0}); }
    /// Rebuilds the table if the number of vertices has doubled or fallen to a third. O(1), O(vertices) then.
    void rebuild_if_outgrown();
    /// Call after the network was renumbered. O(vertices).
    void rebuild();

private:
    /// Makes cell coordinates positive: the core's frame is [-0.5, 0.5]^3, start meshes reach beyond it.
    static constexpr float kOffset = 4;

    /// Moves \p v in the network, and calls \p when_changed if its cell is another one then.
    template <class WhenChanged>
    void store(VertexId v, Four where, const WhenChanged& when_changed) {
        VertexRecord* slot = &network_.slots()[v];
        const FourInts from = cell_of(load_xyz(slot));
        const FourInts to = cell_of(where);
        store_xyz(slot, where);
        if (((from[0] ^ to[0]) | (from[1] ^ to[1]) | (from[2] ^ to[2])) != 0) when_changed({v, from, to});
    }
    FourInts cell_of(Four position) const { return to_ints((position + kOffset) * inverse_edge_); }
    FourInts cell_of(const vcg::Point3f& p) const { return cell_of(Four{p[0], p[1], p[2], 0}); }
    /// The lowest of the 2 x 2 x 2 cells nearest to s. They contain all points within half a cell's edge of
    /// s.
    FourInts first_of_nearest(const vcg::Point3f& s) const {
        const float half = 0.5F * edge_;
        return cell_of(s - vcg::Point3f(half, half, half));
    }
    std::size_t bucket_of(std::int32_t x, std::int32_t y, std::int32_t z) const;
    std::size_t bucket_of(FourInts cell) const { return bucket_of(cell[0], cell[1], cell[2]); }
    void link(VertexId v, std::size_t bucket);
    void unlink(VertexId v, std::size_t bucket);
    // Each returns the nearest vertex as a RankedVertex (see the .cpp): of the cells of a box around s, of
    // all vertices.
    std::uint64_t scan_box(const vcg::Point3f& s, float reach) const;
    std::uint64_t scan_all(const vcg::Point3f& s) const;

    Network& network_;
    std::vector<VertexId> heads_;
    int shift_ = 0;      ///< right shift that makes the hash of a cell the number of a cache line
    int built_for_ = 0;  ///< number of vertices at the last rebuild()
    float edge_ = 1;     ///< of a cell
    float inverse_edge_ = 1;
};

}  // namespace neuralmesh
