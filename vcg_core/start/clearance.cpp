// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Distances: a separable transform, one axis after the other (Saito and Toriwaki 1994). Clearances: a flood
// that takes the levels from the highest to the lowest.
#include "vcg_core/start/clearance.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace neuralmesh {
namespace {

SquaredRadius beyond(int max_radius) { return static_cast<SquaredRadius>(max_radius * max_radius + 1); }

/// Squared distances along x, by two sweeps per row.
void distances_along_rows(const Lattice& lattice, const PerNode<std::uint32_t>& occupied, int max_radius,
                          PerNode<SquaredRadius>& out) {
    const int far = max_radius + 1;
    for (NodeId row = 0; row < lattice.size(); row += lattice.nx) {
        int d = far;
        for (NodeId i = row; i < row + lattice.nx; ++i) {
            d = occupied[i] != 0 ? 0 : std::min(d + 1, far);
            out[i] = static_cast<SquaredRadius>(d);
        }
        d = far;
        for (NodeId i = row + lattice.nx; i-- > row;) {
            d = occupied[i] != 0 ? 0 : std::min(d + 1, far);
            const int best = std::min<int>(d, out[i]);
            out[i] = best > max_radius ? beyond(max_radius) : static_cast<SquaredRadius>(best * best);
        }
    }
}

}  // namespace

PerNode<SquaredRadius> squared_distances(const Lattice& lattice, const PerNode<std::uint32_t>& occupied,
                                         int max_radius) {
    PerNode<SquaredRadius> out(lattice.size());
    distances_along_rows(lattice, occupied, max_radius, out);
    const auto nearer = [](SquaredRadius here, SquaredRadius there, int rows) {
        const SquaredRadius sum = static_cast<SquaredRadius>(there + rows * rows);
        return sum < here ? sum : here;
    };
    combine_across_rows(lattice, max_radius, nearer, out);
    for (SquaredRadius& d : out) d = std::min(d, beyond(max_radius));
    return out;
}

PerNode<SquaredRadius> clearances(const Lattice& lattice, const PerNode<SquaredRadius>& distances,
                                  int max_radius, const NodeSet& inside, const std::vector<NodeId>& hollows) {
    const int far = beyond(max_radius);
    constexpr SquaredRadius kUnknown = -1, kInside = 0;
    // Neighbours beyond the sides are others on the sides, or in the margin; all are known from the
    // beginning.
    const NodeId size = lattice.size(), margin = lattice.index(1, 1, 1);
    std::vector<SquaredRadius> padded(at(size + 2 * margin), kInside);
    SquaredRadius* const out = padded.data() + margin;
    std::fill_n(out, size, kUnknown);
    // First in, first out on every level, so that inside and outside meet halfway.
    Indexed<std::vector<NodeId>> waiting(far + 1);
    const auto wait = [&](NodeId i, int level, bool in) {
        const int l = std::min<int>(level, distances[i]);
        out[i] = in ? kInside : static_cast<SquaredRadius>(l);
        waiting[l].push_back(i);
    };
    for_each_member(inside, [&](NodeId i) { wait(i, far, true); });
    for (const NodeId i : hollows) wait(i, far, false);
    for (NodeId row = 0; row < size; row += lattice.nx) {
        const int stride = lattice.is_on_side(row + 1) ? 1 : lattice.nx - 1;
        for (NodeId i = row; i < row + lattice.nx; i += stride)
            if (out[i] == kUnknown) wait(i, far, false);
    }
    const Neighbours neighbours(lattice);
    for (int level = far; level > 0; --level) {
        std::vector<NodeId>& front = waiting[level];
        for (std::size_t k = 0; k < front.size(); ++k) {
            const NodeId i = front[k];
            const SquaredRadius* const here = out + i;
            int any = 0;  // negative if one is unknown
            for (int n = 0; n < kNeighbourCount; ++n) any |= here[neighbours.difference(n)];
            if (any >= 0) continue;
            for (int n = 0; n < kNeighbourCount; ++n)
                if (here[neighbours.difference(n)] == kUnknown)
                    wait(i + neighbours.difference(n), level, *here == kInside);
        }
        std::vector<NodeId>().swap(front);
    }
    PerNode<SquaredRadius> result(size);
    // Unknown: occupied nodes all around.
    std::transform(out, out + size, result.begin(),
                   [](SquaredRadius c) { return std::max<SquaredRadius>(c, 0); });
    return result;
}

SealedSpaces enclosed_spaces(const Lattice& lattice, const PerNode<SquaredRadius>& distances,
                             const PerNode<SquaredRadius>& clearance, double width_ratio,
                             int min_squared_depth) {
    SealedSpaces result{NodeSet(lattice.size())};
    std::transform(distances.begin(), distances.end(), clearance.begin(), result.inside.begin(),
                   [](SquaredRadius d, SquaredRadius c) { return d > c ? 1 : 0; });
    for_each_component(lattice, result.inside, 1, [&](Span<const Run> space) {
        int depth = 0;
        for (const Run& run : space)
            depth = std::max<int>(depth, *std::max_element(run.begin_in(distances), run.end_in(distances)));
        const int opening = clearance[space[0].begin];  // the same for all nodes of the space
        const bool sealed =
            depth >= min_squared_depth && depth >= width_ratio * width_ratio * std::max(1, opening);
        if (sealed) result.widest_opening = std::max(result.widest_opening, opening);
        for (const Run& run : space) {
            if (sealed)
                result.nodes += run.end - run.begin;
            else
                std::fill(run.begin_in(result.inside), run.end_in(result.inside), 0);
        }
    });
    return result;
}

Solid solid_of(const Lattice& lattice, const PerNode<SquaredRadius>& clearance,
               const PerNode<std::uint32_t>& counts, int level, long long min_points) {
    Solid result{NodeSet(lattice.size())};
    std::transform(clearance.begin(), clearance.end(), result.nodes.begin(),
                   [level](SquaredRadius c) { return c <= level ? 1 : 0; });
    for_each_component(lattice, result.nodes, 1, [&](Span<const Run> component) {
        long long points = 0;
        for (const Run& run : component)
            points = std::accumulate(run.begin_in(counts), run.end_in(counts), points);
        if (points >= min_points) {
            ++result.components;
            return;
        }
        result.points_in_specks += points;
        for (const Run& run : component) std::fill(run.begin_in(result.nodes), run.end_in(result.nodes), 0);
    });
    return result;
}

}  // namespace neuralmesh
