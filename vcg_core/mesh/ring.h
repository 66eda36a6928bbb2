// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The one-ring of a vertex, stored in one cache line.
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

/// The neighbours of a vertex in counter-clockwise order, seen from outside. The ring of an inner vertex is
/// closed: a cycle with any start. The ring of a boundary vertex is open: it begins and ends with the
/// neighbours along the boundary.
struct alignas(64) Ring {
    static constexpr int kMaxValence = 15;

    /// Padded cyclically: neighbours[i] == neighbours[i - valence], so loops need no wrap-around test.
    std::array<VertexId, kMaxValence> neighbours;
    std::uint8_t valence;  ///< number of neighbours; 0 in a free slot
    std::uint8_t open;     ///< 1 for a boundary vertex, else 0

    VertexId operator[](int i) const { return neighbours[static_cast<std::size_t>(i)]; }
    VertexId& operator[](int i) { return neighbours[static_cast<std::size_t>(i)]; }
    const VertexId* begin() const { return neighbours.data(); }
    const VertexId* end() const { return neighbours.data() + valence; }
    VertexId* begin() { return neighbours.data(); }
    VertexId* end() { return neighbours.data() + valence; }

    /// The position of \p v, or -1.
    int find(VertexId v) const {
        for (int i = 0; i < valence; ++i)
            if ((*this)[i] == v) return i;
        return -1;
    }
    /// As find(), for a \p v that is in the ring; without unpredictable branches.
    int find_existing(VertexId v) const {
        // The padding repeats the ring, so the first hit is the position.
        unsigned hits = equal_mask(neighbours.data(), v) | equal_mask(neighbours.data() + 4, v) << 4;
        if (hits == 0)
            hits = equal_mask(neighbours.data() + 8, v) << 8 | equal_mask(neighbours.data() + 11, v) << 11;
        return lowest_bit(hits);
    }
    /// The neighbour after position i, cyclically.
    VertexId next(int i) const { return (*this)[i + 1 == valence ? 0 : i + 1]; }
    /// The neighbour before position i, cyclically.
    VertexId previous(int i) const { return (*this)[i == 0 ? valence - 1 : i - 1]; }
    /// Whether the edge to the neighbour at position i lies on the boundary.
    bool is_boundary_edge(int i) const { return open != 0 && (i == 0 || i + 1 == valence); }
    /// Number of faces at the vertex.
    int face_count() const { return valence - open; }
    /// The least valence that keeps the mesh a manifold.
    int min_valence() const { return open != 0 ? 2 : 3; }
    /// Restores the padding; required after every change of neighbours or valence.
    void pad_cyclically() {
        for (int i = valence; i < kMaxValence && valence > 0; ++i) (*this)[i] = (*this)[i - valence];
    }
};
static_assert(sizeof(Ring) == 64);

}  // namespace neuralmesh
