// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/start/components.h"

#include <cstring>
#include <numeric>

#include "vcg_core/base/disjoint_sets.h"

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

}  // namespace neuralmesh
