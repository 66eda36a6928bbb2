// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The solid of a cloud without what is only there for want of points: growth that closes tunnels and never
// bridges gaps.
#pragma once

#include <cstdint>
#include <vector>

#include "vcg_core/base/thread_team.h"
#include "vcg_core/shell/level_topology.h"
#include "vcg_core/shell/region.h"
#include "vcg_core/shell/topology_vote.h"

namespace neuralmesh {

/// Grows \p solid (1: in it) over the nodes with clearance <= \p level, by rising clearance, node by node; a
/// node at which separate parts of the solid would meet is left out. So a tunnel or hole narrower than the
/// level is filled, while no new handle is made and no two components are joined: what comes out has the
/// components of \p solid, and those of its handles that persist to \p level. (Chazal and Oudot 2008: the
/// topology of a surface is what of that of an offset survives in a larger one.) Parts that come close are
/// left with a gap one node wide; cavities are filled. O(nodes + 14 x those added).
void grow_without_bridges(const Lattice& lattice, const std::vector<SquaredRadius>& clearance, int level,
                          std::vector<std::uint8_t>& solid);

/// The squared radius to which the solid at \p level is grown: twice as far; level 0 counts as 0.6.
int grown_level(int level);

/// The components at \p level that hold enough points, grown to grown_level.
std::vector<std::uint8_t> grown_solid(const Region& region, int level);

/// The topologies of the grown solids at a few levels from 0 to a third of the region's reach. Level 0 is
/// passed over if isolated groups of points would be lost there. About 0.1 microseconds per node.
std::vector<TopologyAt> grown_topologies(const Region& region, ThreadTeam& team);

}  // namespace neuralmesh
