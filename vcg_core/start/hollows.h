// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Tells the hollows of a body, whose surface is seen from within, from its material.
//
// How: from places of the cloud one looks along the normal to both sides, up to the first void: the outside
// or a sealed space. Between the two voids lies one layer of points, or two if the place has a layer opposite
// and both are passed: a wall too thin for the lattice. One layer separates material from void, two void from
// void. From the outside inward this decides what each sealed space is.
#pragma once

#include <vector>

#include "vcg_core/cloud/opposite_layers.h"
#include "vcg_core/start/clearance.h"
#include "vcg_core/start/lattice.h"

namespace neuralmesh {

/// Takes the hollows out of \p inside, which holds the nodes of all sealed spaces. \p clearance is that
/// without sealed spaces. A hollow shows at one in a hundred of \p places at least. O(nodes). \return one
/// node of each hollow, the one farthest from the points
std::vector<NodeId> take_hollows_out(const Lattice& lattice, const PerNode<SquaredRadius>& distances,
                                     const PerNode<SquaredRadius>& clearance,
                                     const std::vector<LayerPlace>& places, NodeSet& inside);

}  // namespace neuralmesh
