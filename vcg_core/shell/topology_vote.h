// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Chooses the topology that persists over the largest range of radii.
#pragma once

#include <vector>

namespace neuralmesh {

/// The topology of one solid: that of a level, or the one grown from there (bridgeless_growth.h).
struct TopologyAt {
    int level = 0;
    int components = 0;
    int genus = 0;
};

/// The topology with most votes, and the range of radii with most votes for it.
struct TopologyVote {
    bool found = false;  ///< false: there were no topologies to vote on
    int components = 0;
    int genus = 0;
    double confidence = 0;    ///< share of the votes, in [0, 1]
    bool grown = false;       ///< true: the topologies are those of grown solids
    int lattice = 0;          ///< index of the lattice of the range
    std::vector<int> levels;  ///< of the range, rising; only those of at most twice the smallest radius
};

/// Votes on the topologies found on several lattices, where topologies[i], by rising level, are those of the
/// lattice with node distance steps[i]; the finest lattice comes first. The radii from a to b over which the
/// topology of one lattice stays the same give it 1/a - 1/b votes, divided among the lattices that cover
/// the same radii. This rewards persistence relative to the radius and, of two equally persistent topologies,
/// prefers the one at smaller radii: large balls only close handles and gaps. O(levels).
TopologyVote persistent_topology(const std::vector<std::vector<TopologyAt>>& topologies,
                                 const std::vector<double>& steps);

}  // namespace neuralmesh
