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

int euler_characteristic(const Lattice& lattice, const NodeSet& solid) {
    const LinkTopology& topology = LinkTopology::table();
    const Neighbours neighbours(lattice);
    const auto in_solid = [&](NodeId i) { return solid[i] != 0; };
    int sum = 0;
    for (NodeId i = 0; i < solid.size(); ++i) {
        if (!in_solid(i)) continue;
        const NeighbourSet before = neighbours.places(i) & kSmallerIds;
        sum += 1 - topology.euler_characteristic(neighbours_in(neighbours, i, before, in_solid));
    }
    return sum;
}

}  // namespace neuralmesh
