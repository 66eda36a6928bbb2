// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Distances: a separable transform, one axis after the other (Saito and Toriwaki 1994). Clearances: with an
// inside, a flood that takes the levels from the highest to the lowest; without one, which is a morphological
// reconstruction (Vincent 1993), sweeps through the rows to and fro, several times as fast.
#include "vcg_core/shell/clearance.h"

#include <algorithm>
#include <cstddef>
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

/// Calls visit(i) for the nodes on the walls of the lattice, in the order of their ids.
template <class Visit>
void for_each_wall_node(const Lattice& l, const Visit& visit) {
    for (int z = 0; z < l.nz; ++z)
        for (int y = 0; y < l.ny; ++y) {
            const bool all = z == 0 || y == 0 || z == l.nz - 1 || y == l.ny - 1;
            for (int x = 0; x < l.nx; x += all ? 1 : std::max(1, l.nx - 1)) visit(l.index(x, y, z));
        }
}

/// Raises the clearances \p out of row (y, z) to what those of its neighbours and its \p distances allow.
/// \p best has nx elements. \return whether any was raised
bool raise_row(const Lattice& l, int y, int z, const PerNode<SquaredRadius>& distances,
               PerNode<SquaredRadius>& out, std::vector<SquaredRadius>& best) {
    const std::ptrdiff_t nx = l.nx;
    SquaredRadius* const row = out.data() + l.index(0, y, z);
    const SquaredRadius* const most = distances.data() + l.index(0, y, z);
    SquaredRadius* const b = best.data();
    std::copy_n(row, nx, b);
    for (const auto& [dx, dy, dz] : kNeighbourOffsets) {
        if ((dy == 0 && dz == 0) || !l.contains(0, y + dy, z + dz)) continue;
        const SquaredRadius* const other = out.data() + l.index(0, y + dy, z + dz);
        const std::ptrdiff_t begin = dx < 0 ? 1 : 0, end = dx > 0 ? nx - 1 : nx;
        for (std::ptrdiff_t x = begin; x < end; ++x) b[x] = std::max(b[x], other[x + dx]);
    }
    SquaredRadius last = 0;
    for (std::ptrdiff_t x = 0; x < nx; ++x)
        b[x] = last = std::max(row[x], std::min(most[x], std::max(b[x], last)));
    last = 0;
    for (std::ptrdiff_t x = nx; x-- > 0;) b[x] = last = std::max(b[x], std::min(most[x], last));
    const bool raised = !std::equal(row, row + nx, b);
    std::copy_n(b, nx, row);
    return raised;
}

/// clearances() without an inside and hollows. A row is visited again once a row beside it has changed: each
/// is visited twice, and a few again. O(nodes) where most paths are straight.
PerNode<SquaredRadius> clearances_from_walls(const Lattice& l, const PerNode<SquaredRadius>& distances) {
    PerNode<SquaredRadius> out(l.size(), 0);
    for_each_wall_node(l, [&](NodeId i) { out[i] = distances[i]; });
    const int rows = l.ny * l.nz;
    Indexed<char> due(rows, 1);
    std::vector<SquaredRadius> best(static_cast<std::size_t>(l.nx));
    bool any = true;
    for (bool forward = true; any; forward = !forward) {
        any = false;
        for (int i = 0; i < rows; ++i) {
            const int row = forward ? i : rows - 1 - i;
            const int y = row % l.ny, z = row / l.ny;
            if (due[row] == 0) continue;
            if (raise_row(l, y, z, distances, out, best)) {
                any = true;
                for (const auto& [dx, dy, dz] : kNeighbourOffsets)
                    if (l.contains(0, y + dy, z + dz)) due[row + dz * l.ny + dy] = 1;
            }
            due[row] = 0;
        }
    }
    return out;
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
    if (inside.empty() && hollows.empty()) return clearances_from_walls(lattice, distances);
    const int far = beyond(max_radius);
    constexpr SquaredRadius kUnknown = -1, kInside = 0;
    PerNode<SquaredRadius> out(lattice.size(), kUnknown);
    // First in, first out on every level, so that inside and outside meet halfway.
    Indexed<std::vector<NodeId>> waiting(far + 1);
    const auto wait = [&](NodeId i, int level, bool in) {
        const int l = std::min<int>(level, distances[i]);
        out[i] = in ? kInside : static_cast<SquaredRadius>(l);
        waiting[l].push_back(i);
    };
    for (NodeId i = 0; i < inside.size(); ++i)
        if (inside[i] != 0) wait(i, far, true);
    for (const NodeId i : hollows) wait(i, far, false);
    for_each_wall_node(lattice, [&](NodeId i) {
        if (out[i] == kUnknown) wait(i, far, false);
    });
    const Neighbours neighbours(lattice);
    for (int level = far; level > 0; --level) {
        std::vector<NodeId>& front = waiting[level];
        for (std::size_t k = 0; k < front.size(); ++k) {
            const bool in = out[front[k]] == kInside;
            neighbours.for_each(front[k], [&](NodeId j, int) {
                if (out[j] == kUnknown) wait(j, level, in);
            });
        }
        std::vector<NodeId>().swap(front);
    }
    for (SquaredRadius& c : out) c = std::max(c, kInside);  // unknown: occupied nodes all around
    return out;
}

SealedSpaces enclosed_spaces(const Lattice& lattice, const PerNode<SquaredRadius>& distances,
                             const PerNode<SquaredRadius>& clearance, double width_ratio,
                             int min_squared_depth) {
    SealedSpaces result;
    result.inside.assign(lattice.size(), 0);
    const auto hidden = [&](NodeId i) { return distances[i] > clearance[i]; };
    for_each_component(lattice, hidden, [&](const std::vector<NodeId>& space) {
        int depth = 0;
        for (const NodeId i : space) depth = std::max<int>(depth, distances[i]);
        const int opening = clearance[space.front()];  // the same for all nodes of the space
        if (depth < min_squared_depth || depth < width_ratio * width_ratio * std::max(1, opening)) return;
        for (const NodeId i : space) result.inside[i] = 1;
        result.nodes += static_cast<long long>(space.size());
        result.widest_opening = std::max(result.widest_opening, opening);
    });
    return result;
}

NodeSet solid_of(const Lattice& lattice, const PerNode<SquaredRadius>& clearance,
                 const PerNode<std::uint32_t>& counts, int level, long long min_points) {
    NodeSet result(lattice.size(), 0);
    const auto solid = [&](NodeId i) { return clearance[i] <= level; };
    for_each_component(lattice, solid, [&](const std::vector<NodeId>& component) {
        long long points = 0;
        for (const NodeId i : component) points += counts[i];
        if (points < min_points) return;
        for (const NodeId i : component) result[i] = 1;
    });
    return result;
}

}  // namespace neuralmesh
