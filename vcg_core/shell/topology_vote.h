// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Which topology to believe: the one that persists over radii.
#pragma once

#include <vector>

namespace neuralmesh {

/// The topology of the solid at a level, as it is or grown from there (shell_grow.h).
struct TopologyAt {
    int level = 0;
    int components = 0;
    int genus = 0;
};

/// The chosen topology and where it was found.
struct TopologyVote {
    bool found = false;  ///< false: there is no solid anywhere
    int components = 0;
    int genus = 0;
    double confidence = 0;    ///< share of the votes, in [0, 1]
    bool grown = false;       ///< of grown solids
    int lattice = 0;          ///< which of the lattices has that run
    std::vector<int> levels;  ///< the levels of that run, smallest radius first, up to twice that radius
};

/// Votes among the topologies found on several lattices, finest first; lattice i has steps of steps[i].
/// A run is a range of radii a to b on one lattice with one and the same topology; it has 1/a - 1/b votes,
/// shared with the other lattices that vote on the same radii. So persistence counts, and the finer of two
/// equally persistent (in proportion) topologies wins: large radii only close handles and gaps. \p
/// topologies: rising levels each. O(levels).
TopologyVote persistent_topology(const std::vector<const std::vector<TopologyAt>*>& topologies,
                                 const std::vector<double>& steps);

}  // namespace neuralmesh
