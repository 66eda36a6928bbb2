// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The one-ring of a vertex, in a cache line of its own.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "vcg_core/base/indexed.h"
#include "vcg_core/base/platform.h"
#include "vcg_core/base/simd.h"

namespace neuralmesh {

using VertexId = std::int32_t;
using Triangle = std::array<VertexId, 3>;

/// One value for every vertex slot of a network.
template <class T>
using PerVertex = Indexed<T>;
/// One value for every face of a list of faces.
template <class T>
using PerFace = Indexed<T>;

/// The neighbours of a vertex, counter-clockwise seen from outside. Closed: a cycle, which may start
/// anywhere. Open (the vertex lies on a boundary): from the first boundary edge to the last.
struct alignas(64) Ring {
    static constexpr int kMaxValence = 15;

    /// Padded cyclically: neighbours[i] == neighbours[i - valence], so loops need no wrap-around test.
    std::array<VertexId, kMaxValence> neighbours;
    std::uint8_t valence;  ///< 0: the slot is free
    std::uint8_t open;     ///< 1: boundary vertex
    std::uint16_t tag;     ///< for the owner of the network, by Network::set_tag(); no part of the mesh

    /// The position of \p v, or -1.
    int find(VertexId v) const {
        for (int i = 0; i < valence; ++i)
            if (neighbours[static_cast<std::size_t>(i)] == v) return i;
        return -1;
    }
    /// find() of a neighbour that is there, without a branch that cannot be predicted.
    int find_existing(VertexId v) const {
        // Entries beyond the valence repeat the ring, so the first hit counts.
        unsigned hits = equal_mask(neighbours.data(), v) | equal_mask(neighbours.data() + 4, v) << 4;
        if (hits == 0)
            hits = equal_mask(neighbours.data() + 8, v) << 8 | equal_mask(neighbours.data() + 11, v) << 11;
        return lowest_bit(hits);
    }
    VertexId operator[](int i) const { return neighbours[static_cast<std::size_t>(i)]; }
    const VertexId* begin() const { return neighbours.data(); }
    const VertexId* end() const { return neighbours.data() + valence; }
    /// The neighbour after / before position i, cyclically.
    VertexId next(int i) const { return (*this)[i + 1 == valence ? 0 : i + 1]; }
    VertexId previous(int i) const { return (*this)[i == 0 ? valence - 1 : i - 1]; }
    int face_count() const { return valence - open; }
    /// Fills the entries beyond the valence; to be called after every change.
    void pad_cyclically() {
        for (std::size_t i = valence; i < neighbours.size() && valence > 0; ++i)
            neighbours[i] = neighbours[i - valence];
    }
};
static_assert(sizeof(Ring) == 64);

}  // namespace neuralmesh
