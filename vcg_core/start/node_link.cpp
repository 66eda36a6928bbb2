// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/start/node_link.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "vcg_core/base/platform.h"

namespace neuralmesh {
namespace {

bool adjacent(std::size_t i, std::size_t j) {
    const auto &a = kNeighbourOffsets[i], &b = kNeighbourOffsets[j];
    const NodeOffset difference = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    return std::find(kNeighbourOffsets.begin(), kNeighbourOffsets.end(), difference) !=
           kNeighbourOffsets.end();
}

/// For every neighbour of a node those neighbours that are adjacent to it.
std::array<NeighbourSet, kNeighbourCount> adjacent_sets() {
    std::array<NeighbourSet, kNeighbourCount> sets{};
    for (std::size_t i = 0; i < kNeighbourCount; ++i)
        for (std::size_t j = 0; j < kNeighbourCount; ++j)
            if (adjacent(i, j)) sets[i] |= NeighbourSet{1} << j;
    return sets;
}

std::vector<std::uint8_t> connected_sets() {
    std::vector<std::uint8_t> connected(std::size_t{1} << kNeighbourCount);
    const auto adjacent_to = adjacent_sets();
    for (NeighbourSet set = 1; set < connected.size(); ++set) {
        NeighbourSet reached = set & (~set + 1), before = 0;
        while (reached != before) {
            before = reached;
            for (std::size_t i = 0; i < kNeighbourCount; ++i)
                if ((before >> i & 1U) != 0) reached |= adjacent_to[i] & set;
        }
        connected[set] = reached == set ? 1 : 0;
    }
    return connected;
}

std::uint64_t bits_of(const std::uint8_t* nodes, int count) {
    std::uint64_t bits = 0;
    for (int i = 0; i < count; ++i) bits |= std::uint64_t{nodes[i]} << i;
    return bits;
}

/// A bit for each node; the rows along x are padded to whole words, with a bit 0 at the least.
struct Bits {
    int words;  ///< per row
    std::ptrdiff_t slice;
    std::vector<std::uint64_t> of_rows;

    Bits(const Lattice& l, const NodeSet& nodes)
        : words(l.nx / 64 + 1),
          slice(static_cast<std::ptrdiff_t>(words) * (l.ny + 1)),
          of_rows(static_cast<std::size_t>(slice * (l.nz + 1) + words + 1)) {
        for (int z = 0; z < l.nz; ++z)
            for (int y = 0; y < l.ny; ++y)
                for (int x = 0; x < l.nx; x += 64)
                    of_rows[static_cast<std::size_t>(z * slice + y * words + x / 64)] =
                        bits_of(nodes.data() + l.index(x, y, z), std::min(64, l.nx - x));
    }
};

/// Of the simplices whose lowest nodes are the 64 from \p word on. Their other nodes are corners of the cube
/// above it; each corner contains, as bits, those of the simplex before it. With the highest corner, 7, to
/// each simplex without it there is one with it, which cancel each other; so that only nodes count where it
/// is outside. Of the others, each has an edge with the two beside it in a ring.
int euler_characteristic(const Bits& bits, const std::uint64_t* word) {
    const auto corner = [&](unsigned c) {
        const std::uint64_t* at = word + ((c & 2U) != 0 ? bits.words : 0) + ((c & 4U) != 0 ? bits.slice : 0);
        return (c & 1U) != 0 ? at[0] >> 1 | at[1] << 63 : at[0];
    };
    const std::uint64_t nodes = *word & ~corner(7);
    if (nodes == 0) return 0;
    int sum = bit_count(nodes);
    std::uint64_t before = corner(5);
    for (const unsigned c : {1U, 3U, 2U, 6U, 4U, 5U}) {
        const std::uint64_t here = corner(c);
        sum += bit_count(nodes & here & before) - bit_count(nodes & here);
        before = here;
    }
    return sum;
}

}  // namespace

bool is_connected(NeighbourSet set) {
    static const std::vector<std::uint8_t> connected = connected_sets();
    return connected[set] != 0;
}

int euler_characteristic(const Lattice& lattice, const NodeSet& solid) {
    const Bits bits(lattice, solid);
    int sum = 0;
    for (std::ptrdiff_t i = 0; i < bits.slice * lattice.nz; ++i)
        sum += euler_characteristic(bits, bits.of_rows.data() + i);
    return sum;
}

}  // namespace neuralmesh
