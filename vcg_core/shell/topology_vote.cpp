// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Runs of radii and their votes.
#include "vcg_core/shell/topology_vote.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

namespace neuralmesh {
namespace {

constexpr double kLevelOfOccupied = 0.25;  // squared radius that level 0 stands for: half a step

/// Entries first <= i < last of one topology, and the radii from a to b, in lattice steps, they stand for.
struct Run {
    std::size_t first = 0, last = 0;
    double a = 1, b = 1;
};

double radius_of(int level) { return std::sqrt(std::max(kLevelOfOccupied, static_cast<double>(level))); }

Run run_from(const std::vector<TopologyAt>& topologies, std::size_t first) {
    Run run{first, first + 1, radius_of(topologies[first].level), 1};
    while (run.last < topologies.size() && topologies[run.last].components == topologies[first].components &&
           topologies[run.last].genus == topologies[first].genus)
        ++run.last;
    // The last level of all stands for the radii up to the next step.
    run.b = run.last < topologies.size() ? radius_of(topologies[run.last].level)
                                         : radius_of(topologies.back().level) + 1;
    return run;
}

/// The radii, from and to, of each lattice that says anything.
std::vector<std::pair<double, double>> covered_radii(
    const std::vector<const std::vector<TopologyAt>*>& topologies, const std::vector<double>& steps) {
    std::vector<std::pair<double, double>> covered;
    for (std::size_t i = 0; i < topologies.size(); ++i)
        if (!topologies[i]->empty())
            covered.emplace_back(steps[i] * radius_of(topologies[i]->front().level),
                                 steps[i] * (radius_of(topologies[i]->back().level) + 1));
    return covered;
}

/// 1/a - 1/b, every stretch divided by the number of lattices that vote there.
double votes_of(double a, double b, const std::vector<std::pair<double, double>>& covered) {
    std::vector<double> ends = {a, b};
    for (const auto& [from, to] : covered)
        for (const double end : {from, to})
            if (end > a && end < b) ends.push_back(end);
    std::sort(ends.begin(), ends.end());
    double sum = 0;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        const double middle = (ends[i] + ends[i + 1]) / 2;
        const auto voting = std::count_if(covered.begin(), covered.end(), [&](const auto& range) {
            return range.first <= middle && middle <= range.second;
        });
        sum += (1 / ends[i] - 1 / ends[i + 1]) / static_cast<double>(std::max<std::ptrdiff_t>(1, voting));
    }
    return sum;
}

/// What speaks for one topology.
struct Votes {
    double sum = 0;
    Run best;  ///< the one with most votes on the first lattice that has one
    double best_count = 0;
    int lattice = -1;
};

}  // namespace

TopologyVote persistent_topology(const std::vector<const std::vector<TopologyAt>*>& topologies,
                                 const std::vector<double>& steps) {
    std::map<std::pair<int, int>, Votes> votes;  // by components and genus
    const std::vector<std::pair<double, double>> covered = covered_radii(topologies, steps);
    double all = 0;
    for (std::size_t i = 0; i < topologies.size(); ++i) {
        const std::vector<TopologyAt>& entries = *topologies[i];
        for (std::size_t first = 0; first < entries.size();) {
            const Run run = run_from(entries, first);
            first = run.last;
            Votes& v = votes[{entries[run.first].components, entries[run.first].genus}];
            const double count = votes_of(run.a * steps[i], run.b * steps[i], covered) * steps[0];
            v.sum += count;
            all += count;
            if (v.lattice < 0) v.lattice = static_cast<int>(i);
            if (v.lattice == static_cast<int>(i) && count > v.best_count) {
                v.best = run;
                v.best_count = count;
            }
        }
    }
    TopologyVote verdict;
    double most = 0;
    for (const auto& [topology, v] : votes) {
        if (v.sum <= most) continue;
        most = v.sum;
        verdict = {true, topology.first, topology.second, v.sum / all, false, v.lattice, {}};
        const std::vector<TopologyAt>& entries = *topologies[static_cast<std::size_t>(v.lattice)];
        for (std::size_t i = v.best.first; i < v.best.last; ++i)
            if (radius_of(entries[i].level) <= 2 * v.best.a) verdict.levels.push_back(entries[i].level);
    }
    return verdict;
}

}  // namespace neuralmesh
