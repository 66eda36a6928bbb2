// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// How far a growing network may change its topology.
#pragma once

#include <limits>

namespace neuralmesh {

struct TopologyRules {
    /// Handles form while the mesh is coarse, too: a tetrahedron knows none. A shell has most of them, and a
    /// coarse mesh takes a narrow gap between two parts for a handle.
    bool from_tetrahedron = false;
    /// At the end of growth a membrane that nothing replaces becomes a hole if the smallest sphere around its
    /// rim has at least this diameter, in the core's frame. Infinite: the mesh stays closed.
    float opens_from = std::numeric_limits<float>::infinity();
};

}  // namespace neuralmesh
