// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/shell/node_link.h"

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

/// Adds the neighbours at the place \p k in kNeighbourOffsets to the lower links of the nodes of row (y, z).
void add_to_links_of_row(const Lattice& l, int y, int z, int k, const PerNode<std::int16_t>& values,
                         PerNode<std::uint16_t>& links) {
    const auto [dx, dy, dz] = kNeighbourOffsets[static_cast<std::size_t>(k)];
    if (!l.contains(0, y + dy, z + dz)) return;
    const std::ptrdiff_t begin = dx < 0 ? 1 : 0, end = dx > 0 ? l.nx - 1 : l.nx;
    const std::int16_t* const here = values.data() + l.index(0, y, z);
    const std::int16_t* const there = here + l.index(dx, dy, dz);
    std::uint16_t* const out = links.data() + l.index(0, y, z);
    const auto bit = static_cast<std::uint16_t>(1U << k);
    if ((kSmallerIds >> k & 1U) != 0) {
        for (std::ptrdiff_t x = begin; x < end; ++x) out[x] |= there[x] <= here[x] ? bit : 0;
    } else {
        for (std::ptrdiff_t x = begin; x < end; ++x) out[x] |= there[x] < here[x] ? bit : 0;
    }
}

}  // namespace

LinkTopology::LinkTopology()
    : connected_(std::size_t{1} << kNeighbourCount), euler_(std::size_t{1} << kNeighbourCount) {
    const auto adjacent_to = adjacent_sets();
    for (NeighbourSet set = 1; set < connected_.size(); ++set) {
        NeighbourSet reached = set & (~set + 1), before = 0;
        while (reached != before) {
            before = reached;
            for (std::size_t i = 0; i < kNeighbourCount; ++i)
                if ((before >> i & 1U) != 0) reached |= adjacent_to[i] & set;
        }
        connected_[set] = reached == set ? 1 : 0;
    }
    for (NeighbourSet set = 1; set < euler_.size(); ++set) {
        const auto last = static_cast<std::size_t>(highest_bit(set));
        const NeighbourSet rest = set & ~(NeighbourSet{1} << last), beside = rest & adjacent_to[last];
        int edges = 0;  // between neighbours of the last
        for (std::size_t i = 0; i < last; ++i)
            if ((beside >> i & 1U) != 0) edges += bit_count(adjacent_to[i] & beside);
        euler_[set] = static_cast<std::int8_t>(euler_[rest] + 1 - bit_count(beside) + edges / 2);
    }
}

const LinkTopology& LinkTopology::table() {
    static const LinkTopology table;
    return table;
}

PerNode<std::uint16_t> lower_links(const Lattice& l, const PerNode<std::int16_t>& values) {
    PerNode<std::uint16_t> links(l.size(), 0);
    for (int z = 0; z < l.nz; ++z)
        for (int y = 0; y < l.ny; ++y)
            for (int k = 0; k < kNeighbourCount; ++k) add_to_links_of_row(l, y, z, k, values, links);
    return links;
}

}  // namespace neuralmesh
