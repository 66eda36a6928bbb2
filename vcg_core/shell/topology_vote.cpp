// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/shell/topology_vote.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

#include "vcg_core/base/ablation.h"

namespace neuralmesh {
namespace {

using Topologies = std::vector<TopologyAt>;

struct Radii {
    double from = 1, to = 1;
};

/// In lattice steps. Level 0, the occupied nodes alone, counts as half a step: half the width of a cell.
double radius_of(int level) { return level == 0 ? 0.5 : std::sqrt(static_cast<double>(level)); }

/// The last level of a list, after which nothing is known, counts for one lattice step.
double last_radius(const Topologies& topologies) { return radius_of(topologies.back().level) + 1; }

/// Consecutive entries first <= i < last of the same topology.
struct Persistence {
    std::size_t first = 0, last = 0;
    Radii radii;  ///< in lattice steps
};

Persistence persistence_from(const Topologies& topologies, std::size_t first) {
    const TopologyAt& topology = topologies[first];
    std::size_t last = first + 1;
    while (last < topologies.size() && topologies[last].components == topology.components &&
           topologies[last].genus == topology.genus)
        ++last;
    const double to = last < topologies.size() ? radius_of(topologies[last].level) : last_radius(topologies);
    return {first, last, {radius_of(topology.level), to}};
}

/// The radii that each lattice with topologies covers, in absolute units.
std::vector<Radii> covered_radii(const std::vector<Topologies>& topologies,
                                 const std::vector<double>& steps) {
    std::vector<Radii> covered;
    for (std::size_t i = 0; i < topologies.size(); ++i)
        if (!topologies[i].empty())
            covered.push_back(
                {steps[i] * radius_of(topologies[i].front().level), steps[i] * last_radius(topologies[i])});
    return covered;
}

/// 1/from - 1/to; each part of the range is divided by the number of lattices that cover it.
double votes_of(const Radii& radii, const std::vector<Radii>& covered) {
    std::vector<double> ends = {radii.from, radii.to};
    for (const Radii& lattice : covered)
        for (const double end : {lattice.from, lattice.to})
            if (end > radii.from && end < radii.to) ends.push_back(end);
    std::sort(ends.begin(), ends.end());
    double sum = 0;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        const double middle = (ends[i] + ends[i + 1]) / 2;
        const auto voting = std::count_if(covered.begin(), covered.end(), [&](const Radii& lattice) {
            return lattice.from <= middle && middle <= lattice.to;
        });
        sum += (1 / ends[i] - 1 / ends[i + 1]) / static_cast<double>(std::max<std::ptrdiff_t>(1, voting));
    }
    return sum;
}

/// The votes for one topology.
struct Tally {
    double votes = 0;
    int lattice = -1;  ///< the finest one with this topology
    Persistence best;  ///< the range with most votes there
    double best_votes = 0;

    void add(int from_lattice, const Persistence& range, double range_votes) {
        votes += range_votes;
        if (lattice < 0) lattice = from_lattice;
        if (lattice != from_lattice || range_votes <= best_votes) return;
        best = range;
        best_votes = range_votes;
    }
};

std::vector<int> levels_of(const Persistence& range, const Topologies& topologies) {
    std::vector<int> levels;
    for (std::size_t i = range.first; i < range.last; ++i)
        if (radius_of(topologies[i].level) <= 2 * range.radii.from) levels.push_back(topologies[i].level);
    return levels;
}

}  // namespace

TopologyVote persistent_topology(const std::vector<Topologies>& topologies,
                                 const std::vector<double>& steps) {
    if (steps.size() > 1 && skips("topology_vote")) return persistent_topology({topologies[0]}, {steps[0]});
    const std::vector<Radii> covered = covered_radii(topologies, steps);
    std::map<std::pair<int, int>, Tally> tallies;  // by components and genus
    double all = 0;
    for (std::size_t i = 0; i < topologies.size(); ++i)
        for (std::size_t first = 0; first < topologies[i].size();) {
            const Persistence range = persistence_from(topologies[i], first);
            const Radii radii{range.radii.from * steps[i], range.radii.to * steps[i]};
            const double votes = votes_of(radii, covered) * steps[0];
            tallies[{topologies[i][first].components, topologies[i][first].genus}].add(static_cast<int>(i),
                                                                                       range, votes);
            all += votes;
            first = range.last;
        }
    TopologyVote result;
    double most = 0;
    for (const auto& [topology, tally] : tallies) {
        if (tally.votes <= most) continue;
        most = tally.votes;
        result = {true,
                  topology.first,
                  topology.second,
                  tally.votes / all,
                  false,
                  tally.lattice,
                  levels_of(tally.best, topologies[static_cast<std::size_t>(tally.lattice)])};
    }
    return result;
}

}  // namespace neuralmesh
