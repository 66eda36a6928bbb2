// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The winner of a signal: the nearest vertex of a network whose vertices move, come and go.
// vcglib's indices are static or cannot remove, so this is ours: a hashed uniform grid.
#pragma once

#include <vcg/space/point3.h>

#include <cstdint>
#include <vector>

#include "lanes.h"
#include "network.h"

namespace neuralmesh {

/// Exact nearest-vertex search. Every change of the network must be told; the grid is laid out anew when
/// the number of vertices has doubled or halved.
///
/// Ties go to the smaller id, so that the answer is that of a linear search to the bit.
/// Memory: the list links live in the network's slots; 16 bytes per hash entry, two to four entries
/// per occupied cell.
class WinnerSearch {
public:
    /// Keeps a reference to \p network. O(vertices).
    explicit WinnerSearch(Network& network);

    /// The vertex nearest to \p s. O(1) expected near the mesh; O(vertices) far from it.
    VertexId winner(const vcg::Point3f& s) const;

    /// Brings into the cache what winner(s) will read first.
    void prefetch(const vcg::Point3f& s) const;

    /// \p v has just been born. Amortised O(1).
    void add(VertexId v);
    /// \p v is about to be removed. O(1) expected.
    void remove(VertexId v);
    /// Moves \p v to \p where, in the network and in the grid. O(1) expected.
    void move(VertexId v, const vcg::Point3f& where);
    /// Lays the grid out anew if the network has outgrown it.
    void keep_up();

private:
    /// Makes all coordinates positive: the core's frame lies in [-0.5, 0.5], start meshes somewhat beyond.
    static constexpr float kOffset = 4;
    static constexpr std::uint64_t kEmpty = ~std::uint64_t{0};

    struct Cell {
        std::uint64_t key;
        VertexId head;
    };
    struct Best {
        float squared_distance;
        VertexId vertex;
    };

    static std::uint64_t key_of(std::int32_t x, std::int32_t y, std::int32_t z) {
        return static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) |
               (static_cast<std::uint64_t>(static_cast<std::uint32_t>(y)) << 21) |
               (static_cast<std::uint64_t>(static_cast<std::uint32_t>(z)) << 42);
    }
    std::int32_t cell_of(float coordinate) const {
        return static_cast<std::int32_t>((coordinate + kOffset) * inverse_edge_);
    }
    FourInts cell_of(Four position) const {
        return __builtin_convertvector((position + kOffset) * inverse_edge_, FourInts);
    }
    std::uint64_t key_at(const Slot& slot) const { return key_of(cell_of(slot.x), cell_of(slot.y), cell_of(slot.z)); }
    /// Four cells in a row along x share a cache line.
    std::size_t home_of(std::uint64_t key) const {
        return static_cast<std::size_t>(((key >> 2) * 0x9e3779b97f4a7c15u) >> hash_shift_ << 2 | (key & 3));
    }
    Cell& cell_for(std::uint64_t key);
    VertexId head_of(std::uint64_t key) const;
    void link(VertexId v, std::uint64_t key);
    void unlink(VertexId v, std::uint64_t key);
    void lay_out();
    void scan_cell(std::int32_t x, std::int32_t y, std::int32_t z, const vcg::Point3f& s, Best& best) const;
    void scan_box(const vcg::Point3f& s, float reach, Best& best) const;
    void scan_all(const vcg::Point3f& s, Best& best) const;

    Network& network_;
    std::vector<Cell> cells_;
    std::size_t used_cells_ = 0;
    int hash_shift_ = 0;
    int laid_out_for_ = 0;
    float edge_ = 1;
    float inverse_edge_ = 1;
};

}  // namespace neuralmesh
