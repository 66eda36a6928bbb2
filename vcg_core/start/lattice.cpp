// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Components and Euler characteristics, from runs and words of nodes instead of one by one.
#include "vcg_core/start/lattice.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <numeric>

#include "vcg_core/base/disjoint_sets.h"
#include "vcg_core/base/platform.h"

namespace neuralmesh {
namespace {

/// The runs of a set of nodes, row by row.
struct Runs {
    std::vector<Run> all;
    std::vector<int> row_begin{0};

    Runs(const Lattice& lattice, const NodeSet& nodes, std::uint8_t value) {
        for (NodeId row = 0; row < lattice.size(); row += lattice.nx) {
            const NodeId end = row + lattice.nx;
            const auto first = [&](NodeId from, int wanted) {
                const void* found = std::memchr(nodes.data() + from, wanted, at(end - from));
                return found == nullptr
                           ? end
                           : static_cast<NodeId>(static_cast<const std::uint8_t*>(found) - nodes.data());
            };
            for (NodeId i = first(row, value); i < end; i = first(i, value)) {
                all.push_back({i, first(i, 1 - value)});
                i = all.back().end;
            }
            row_begin.push_back(count());
        }
    }
    int count() const { return static_cast<int>(all.size()); }
    const Run& operator[](int i) const { return all[at(i)]; }
};

/// A node is adjacent to those at its own place and at the one before in the rows with smaller ids.
void join_rows(const Lattice& lattice, const Runs& runs, int row, int other, DisjointSets& sets) {
    int j = runs.row_begin[at(other)];
    const int end = runs.row_begin[at(other) + 1];
    const NodeId shift = (row - other) * lattice.nx;
    for (int i = runs.row_begin[at(row)]; i < runs.row_begin[at(row) + 1]; ++i) {
        while (j < end && runs[j].end + shift < runs[i].begin) ++j;
        for (int k = j; k < end && runs[k].begin + shift < runs[i].end; ++k) sets.join(i, k);
    }
}

DisjointSets joined(const Lattice& lattice, const Runs& runs) {
    DisjointSets sets(runs.count());
    for (int z = 0, row = 0; z < lattice.nz; ++z)
        for (int y = 0; y < lattice.ny; ++y, ++row) {
            if (y > 0) join_rows(lattice, runs, row, row - 1, sets);
            if (z > 0) join_rows(lattice, runs, row, row - lattice.ny, sets);
            if (y > 0 && z > 0) join_rows(lattice, runs, row, row - lattice.ny - 1, sets);
        }
    return sets;
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

void for_each_component(const Lattice& lattice, const NodeSet& nodes, std::uint8_t value,
                        const std::function<void(Span<const Run>)>& visit) {
    const Runs runs(lattice, nodes, value);
    DisjointSets sets = joined(lattice, runs);
    std::vector<int> begin(at(runs.count()) + 1, 0);  // of each set in the sorted runs
    for (int i = 0; i < runs.count(); ++i) ++begin[at(sets.find(i)) + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<Run> sorted(runs.all.size());
    std::vector<int> next = begin;
    for (int i = 0; i < runs.count(); ++i) sorted[at(next[at(sets.find(i))]++)] = runs[i];
    for (std::size_t i = 0; i + 1 < begin.size(); ++i)
        if (begin[i] < begin[i + 1]) visit({sorted.data() + begin[i], sorted.data() + begin[i + 1]});
}

int euler_characteristic(const Lattice& lattice, const NodeSet& solid) {
    const Bits bits(lattice, solid);
    int sum = 0;
    for (std::ptrdiff_t i = 0; i < bits.slice * lattice.nz; ++i)
        sum += euler_characteristic(bits, bits.of_rows.data() + i);
    return sum;
}

}  // namespace neuralmesh
