// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "shell_vote.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace neuralmesh {
namespace {

/// Levels first <= l < last of one topology.
struct Run {
    int first = 0, last = 0;

    double span() const { return std::sqrt(static_cast<double>(last) / static_cast<double>(first)); }
};

/// Legendre: all but 4^a (8b + 7) are sums of three squares, so some nodes may have that distance.
bool is_squared_distance(int l) {
    while (l % 4 == 0) l /= 4;
    return l % 8 != 7;
}

bool covers_two_distances(const Run& run) {
    int count = 0;
    for (int l = run.first; l < run.last && count < 2; ++l) count += is_squared_distance(l);
    return count == 2;
}

Run run_from(const std::vector<LevelTopology>& topologies, int first) {
    const auto at = [&](int l) -> const LevelTopology& { return topologies[static_cast<std::size_t>(l)]; };
    Run run{first, first + 1};
    while (run.last < static_cast<int>(topologies.size()) &&
           at(run.last).components == at(first).components && at(run.last).genus == at(first).genus)
        ++run.last;
    return run;
}

/// What speaks for one topology.
struct Votes {
    double sum = 0;
    Run best;  ///< the one with most votes on the first lattice that has one
    double best_count = 0;
    int lattice = -1;
};

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

Verdict persistent_topology(const std::vector<const std::vector<LevelTopology>*>& topologies,
                            const std::vector<double>& steps) {
    std::map<std::pair<int, int>, Votes> votes;  // by components and genus
    double all = 0;
    for (std::size_t i = 0; i < topologies.size(); ++i) {
        const int levels = static_cast<int>(topologies[i]->size());
        const double unit = steps[i] / steps[0];
        for (int l = 1; l < levels;) {
            const Run run = run_from(*topologies[i], l);
            l = run.last;
            const LevelTopology& t = (*topologies[i])[static_cast<std::size_t>(run.first)];
            if (t.components == 0 || !covers_two_distances(run)) continue;
            Votes& v = votes[{t.components, t.genus}];
            const double count = (1 / std::sqrt(static_cast<double>(run.first)) -
                                  1 / std::sqrt(static_cast<double>(run.last))) /
                                 unit;
            v.sum += count;
            all += count;
            if (v.lattice < 0) v.lattice = static_cast<int>(i);
            if (v.lattice == static_cast<int>(i) && count > v.best_count) {
                v.best = run;
                v.best_count = count;
            }
        }
    }
    Verdict verdict;
    double most = 0;
    for (const auto& [topology, v] : votes) {
        if (v.sum <= most) continue;
        most = v.sum;
        verdict = {true, topology.first, topology.second, v.sum / all, v.best.span(), v.lattice, {}};
        for (int l = v.best.first; l < std::min(v.best.last, 4 * v.best.first + 1); ++l)
            verdict.levels.push_back(l);
    }
    return verdict;
}

std::vector<std::uint8_t> solid_of(const Lattice& lattice, const std::vector<Level>& clearance,
                                   const std::vector<std::uint32_t>& counts, int level, long long enough,
                                   long long& held) {
    std::vector<std::uint8_t> seen(lattice.size(), 0), result(lattice.size(), 0);
    std::vector<std::uint32_t> nodes;
    const auto solid = [&](std::size_t i) { return clearance[i] <= level; };
    held = 0;
    for (std::size_t seed = 0; seed < lattice.size(); ++seed) {
        if (seen[seed] != 0 || !solid(seed)) continue;
        gather(lattice, seed, seen, solid, nodes);
        long long points = 0;
        for (const std::uint32_t i : nodes) points += counts[i];
        if (points < enough) continue;
        for (const std::uint32_t i : nodes) result[i] = 1;
        held += points;
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
