// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The winner of a signal: the nearest vertex of a network whose vertices move, are added and are removed. A
// hashed uniform grid.
//
// vcglib's hash table, vcg::SpatialHashTable, takes 2.8 times as long at 10,000 vertices and 3.7 times at
// 100,000 (tests/bench/winner_search.cpp), and its removing members do not compile.
#pragma once

#include <vcg/space/point3.h>

#include <cstdint>
#include <vector>

#include "vcg_core/base/huge_pages.h"
#include "vcg_core/base/simd.h"
#include "vcg_core/engine/cell_pyramid.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// Nearest-vertex search, exact within 1.5 of the origin (the core's frame reaches to 0.5), and as far as
/// cells are large against the digits that float has left. Every change of the network must be told; the grid
/// is laid out anew when the number of vertices has doubled or fallen to a third.
///
/// The table has a list head per cell, found by hashing, and no keys: cells that share a head share a list.
/// That costs a few distances to vertices elsewhere, which cannot win, and saves every comparison of keys.
/// Ties go to the smaller id, so that the answer is that of a linear search to the bit.
/// Memory: 8 to 32 bytes per vertex and the pyramid; the list links live in the network's slots.
class WinnerSearch {
public:
    /// Which list a cell has.
    struct CellLists {
        int shift = 0;             ///< of the hash, to the number of a cache line
        std::uint32_t beyond = 0;  ///< added to that of a cell beyond the plane
        /// The mask of the plane's axis is all ones, and its first cell beyond.
        std::uint32_t along_x = 0;
        std::uint32_t along_y = 0;
        std::uint32_t along_z = 0;
        std::uint32_t first_beyond = 0;
    };

    /// Keeps a reference to \p network. O(vertices).
    explicit WinnerSearch(Network& network);

    /// The vertex nearest to \p s. O(1) expected near a mesh whose edges are about equally long where the
    /// signals are, O(log vertices) expected far from it. Many vertices in one cell cost a distance each.
    VertexId winner(const vcg::Point3f& s) const;
    /// Brings into the cache what winner(s) will read first: the lists' heads, and later, when those have
    /// come, the vertices they name.
    void prefetch_heads(const vcg::Point3f& s) const;
    void prefetch_vertices(const vcg::Point3f& s) const;

    /// \p v has just been born. O(1).
    void add(VertexId v);
    /// \p v is about to be removed. O(1) expected.
    void remove(VertexId v);
    /// A vertex that has moved from one cell to another, of which the grid does not know yet.
    struct CellChange {
        FourInts from;
        FourInts to;
        VertexId vertex;
    };
    /// Moves \p v to \p where (x, y, z, 0) in the network. If it leaves its cell it is only added to \p
    /// cell_changes, which are to be handed to follow() before the next search: so threads may move different
    /// vertices at once. O(1).
    void move(VertexId v, Four where, std::vector<CellChange>& cell_changes) {
        VertexRecord* slot = &network_.slots()[v];
        const FourInts from = cell_of(load_xyz(slot));
        const FourInts to = cell_of(where);
        if (((from[0] ^ to[0]) | (from[1] ^ to[1]) | (from[2] ^ to[2])) != 0)
            cell_changes.push_back({from, to, v});
        store_xyz(slot, where);
    }
    /// Those of one vertex must come in their order. O(1) expected for each.
    void follow(const std::vector<CellChange>& cell_changes) {
        for (const CellChange& c : cell_changes) relink(c.vertex, c.from, c.to);
    }
    /// Moves \p v to \p where, in the network and in the grid. O(1) expected.
    void move(VertexId v, const vcg::Point3f& where) {
        std::vector<CellChange> cell_changes;
        move(v, Four{where[0], where[1], where[2], 0}, cell_changes);
        follow(cell_changes);
    }
    /// From now on cells on different sides of the plane where coordinate \p axis is \p place never share a
    /// list: for two threads, one on each side, which else would look at each other's vertices all over the
    /// mesh. O(vertices).
    void split_table(int axis, float place);
    /// Lays the grid out anew if the network has outgrown it.
    void keep_up();

    /// Lays the grid out anew: to be called after vertices have got new ids.
    void lay_out();

    std::size_t bytes() const { return heads_.size() * sizeof(VertexId) + inhabited_.bytes(); }

private:
    /// Makes all coordinates positive: the core's frame lies in [-0.5, 0.5], start meshes somewhat beyond.
    static constexpr float kOffset = 4;

    FourInts cell_of(Four position) const {
        return __builtin_convertvector((position + kOffset) * inverse_edge_, FourInts);
    }
    FourInts cell_of(const vcg::Point3f& p) const { return cell_of(Four{p[0], p[1], p[2], 0}); }
    /// The first of the 2 x 2 x 2 cells nearest to s, which reach at least half a cell's edge in all
    /// directions.
    FourInts first_of_nearest(const vcg::Point3f& s) const {
        const float half = 0.5F * edge_;
        return cell_of(s - vcg::Point3f(half, half, half));
    }
    std::size_t bucket_of(std::int32_t x, std::int32_t y, std::int32_t z) const;
    std::size_t bucket_of(FourInts cell) const { return bucket_of(cell[0], cell[1], cell[2]); }
    void link(VertexId v, std::size_t bucket);
    void unlink(VertexId v, std::size_t bucket);
    void relink(VertexId v, FourInts from, FourInts to);
    void enter(FourInts cell);
    void leave(FourInts cell);
    std::uint64_t scan_box(const vcg::Point3f& s, float reach) const;
    std::uint64_t scan_far(const vcg::Point3f& s) const;
    std::uint64_t scan_all(const vcg::Point3f& s) const;

    Network& network_;
    HugeVector<VertexId> heads_;
    CellPyramid inhabited_;
    int out_of_range_ = 0;  ///< vertices so far away that the pyramid does not hold them
    CellLists lists_;
    bool divided_ = false;
    int axis_ = 0;  ///< of the plane that divides the lists
    float place_ = 0;
    int laid_out_for_ = 0;
    float edge_ = 1;
    float inverse_edge_ = 1;
};

}  // namespace neuralmesh
