// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/shell/topology_vote.h"

#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

namespace neuralmesh {
namespace {

/// In lattice steps. Level 0, the occupied nodes alone, counts as half a step: half the width of a cell.
double radius_of(int level) { return level == 0 ? 0.5 : std::sqrt(static_cast<double>(level)); }

/// The votes for one topology, and the first level of the range with most of them.
struct Tally {
    double votes = 0, most = 0;
    int level = 0;
};

}  // namespace

TopologyVote persistent_topology(const std::vector<TopologyAt>& topologies) {
    std::map<std::pair<int, int>, Tally> tallies;  // by components and genus
    double all = 0;
    for (std::size_t first = 0, last = 0; first < topologies.size(); first = last) {
        const TopologyAt& topology = topologies[first];
        while (last < topologies.size() && topologies[last].components == topology.components &&
               topologies[last].genus == topology.genus)
            ++last;
        // The last level of all, after which nothing is known, counts for one lattice step.
        const double from = radius_of(topology.level);
        const double to = last < topologies.size() ? radius_of(topologies[last].level)
                                                   : radius_of(topologies.back().level) + 1;
        const double votes = 1 / from - 1 / to;
        Tally& tally = tallies[{topology.components, topology.genus}];
        if (votes > tally.most) {
            tally.most = votes;
            tally.level = topology.level;
        }
        tally.votes += votes;
        all += votes;
    }
    TopologyVote result;
    for (const auto& [topology, tally] : tallies)
        if (tally.votes / all > result.confidence)
            result = {true, topology.first, topology.second, tally.votes / all, tally.level};
    return result;
}

}  // namespace neuralmesh
