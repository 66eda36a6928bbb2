// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Breadth first from every node not seen yet.
#include "vcg_core/shell/node_groups.h"

#include <cstddef>

namespace neuralmesh {
namespace {

/// The group of adjacent nodes with solid(j) that contains \p seed, in \p nodes.
template <class Solid>
void gather(const Lattice& lattice, std::size_t seed, std::vector<std::uint8_t>& seen, const Solid& solid,
            std::vector<std::uint32_t>& nodes) {
    nodes.assign(1, static_cast<std::uint32_t>(seed));
    seen[seed] = 1;
    for (std::size_t k = 0; k < nodes.size(); ++k)
        for_each_neighbour(lattice, nodes[k], [&](std::size_t j) {
            if (seen[j] != 0 || !solid(j)) return;
            seen[j] = 1;
            nodes.push_back(static_cast<std::uint32_t>(j));
        });
}

}  // namespace

std::vector<std::uint8_t> solid_of(const Lattice& lattice, const std::vector<SquaredRadius>& clearance,
                                   const std::vector<std::uint32_t>& counts, int level, long long enough) {
    std::vector<std::uint8_t> seen(lattice.size(), 0), result(lattice.size(), 0);
    std::vector<std::uint32_t> nodes;
    const auto solid = [&](std::size_t i) { return clearance[i] <= level; };
    for (std::size_t seed = 0; seed < lattice.size(); ++seed) {
        if (seen[seed] != 0 || !solid(seed)) continue;
        gather(lattice, seed, seen, solid, nodes);
        long long points = 0;
        for (const std::uint32_t i : nodes) points += counts[i];
        if (points < enough) continue;
        for (const std::uint32_t i : nodes) result[i] = 1;
    }
    return result;
}

vcg::Box3f box_of_large_groups(const Lattice& lattice, const std::vector<std::uint32_t>& counts, double share,
                               double together) {
    std::vector<std::uint8_t> seen(lattice.size(), 0);
    std::vector<std::uint32_t> nodes;
    double total = 0, held = 0;
    for (const std::uint32_t c : counts) total += c;
    const auto occupied = [&](std::size_t i) { return counts[i] != 0; };
    vcg::Box3f box;
    for (std::size_t seed = 0; seed < lattice.size(); ++seed) {
        if (seen[seed] != 0 || !occupied(seed)) continue;
        gather(lattice, seed, seen, occupied, nodes);
        double points = 0;
        for (const std::uint32_t i : nodes) points += counts[i];
        if (points < share * total) continue;
        held += points;
        for (const std::uint32_t i : nodes) {
            const std::size_t nx = static_cast<std::size_t>(lattice.nx),
                              ny = static_cast<std::size_t>(lattice.ny);
            const vcg::Point3f p = lattice.position(static_cast<int>(i % nx), static_cast<int>(i / nx % ny),
                                                    static_cast<int>(i / nx / ny));
            const vcg::Point3f half(lattice.step * 0.5F, lattice.step * 0.5F, lattice.step * 0.5F);
            box.Add(p - half);
            box.Add(p + half);
        }
    }
    return held >= together * total ? box : vcg::Box3f();
}

}  // namespace neuralmesh
