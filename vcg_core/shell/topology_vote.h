// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Chooses the topology that persists over the largest range of radii.
#pragma once

#include <vector>

namespace neuralmesh {

/// The topology of the solid grown from a level (bridgeless_growth.h).
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
    double confidence = 0;  ///< share of the votes, in [0, 1]
    int level = 0;          ///< the first of the range
};

/// Votes on the topologies found on a lattice, by rising level. The radii from a to b over which the topology
/// stays the same give it 1/a - 1/b votes. This rewards persistence relative to the radius and, of two
/// equally persistent topologies, prefers the one at smaller radii: large balls only close handles and gaps.
/// O(levels).
TopologyVote persistent_topology(const std::vector<TopologyAt>& topologies);

}  // namespace neuralmesh
