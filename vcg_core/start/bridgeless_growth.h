// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Growth of a solid that fills holes and tunnels but never joins parts. It tells handles of the surface from
// gaps between its points.
#pragma once

#include <vector>

#include "vcg_core/base/thread_team.h"
#include "vcg_core/start/clearance.h"
#include "vcg_core/start/lattice.h"
#include "vcg_core/start/region.h"

namespace neuralmesh {

/// Whether a set of neighbours is connected. The empty set is not.
bool is_connected(NeighbourSet set);

/// Adds to \p solid the nodes with clearance <= \p level, one by one in order of clearance, except nodes at
/// which separate parts of the solid would meet. This fills tunnels and holes narrower than the level, makes
/// no handle and joins no components: the result has the components of \p solid and those of its handles
/// that persist to \p level. (Chazal and Oudot 2008: the topology of a surface is what survives of one offset
/// in a larger one.) Parts that come close keep a gap one node wide; cavities are filled. O(nodes + 14 x
/// nodes added).
void grow_without_bridges(const Lattice& lattice, const PerNode<SquaredRadius>& clearance, int level,
                          NodeSet& solid);

/// The level to which the solid at \p level is grown: that of twice its radius, at most Region::kMaxLevel.
/// Level 0 is grown to level 2.
int grown_level(int level);

/// The components of the solid at \p level, without specks.
NodeSet plain_solid(const Region& region, int level);

/// The same, grown to grown_level().
NodeSet grown_solid(const Region& region, int level);

/// The topology of the solid grown from a level.
struct TopologyAt {
    int level = 0;
    int components = 0;
    int genus = 0;
};

/// The topologies of the grown solids of some levels up to a third of Region::kMaxRadius. Left out are level
/// 0 if it has specks, and levels whose solid is in pieces because the radius is smaller than the distance
/// between points: no component is large enough, or 5 % of the points are in specks that join something
/// larger within four lattice steps. About 0.01 microseconds per node and level.
std::vector<TopologyAt> grown_topologies(const Region& region, ThreadTeam& team);

}  // namespace neuralmesh
