// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The topology of a cloud, from lattices of several resolutions, and the solids that have it.
//
// A solid is grown so that it fills holes and tunnels but never joins parts. That tells handles of the
// surface from gaps between its points.
#pragma once

#include <vcg/space/box3.h>
#include <vcg/space/point3.h>

#include <vector>

#include "vcg_core/base/progress.h"
#include "vcg_core/base/thread_team.h"
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

/// With a smaller share of the votes the topology is uncertain.
inline constexpr double kLowConfidence = 0.5;

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
/// Radii above two lattice steps at which the solid is in pieces vote for nothing. O(levels).
TopologyVote persistent_topology(const std::vector<TopologyAt>& topologies);

/// The lattice that tells the topology best.
struct LatticeSurvey {
    Region region;
    TopologyVote vote;
    float step = 0;  ///< of the first lattice examined
};

/// Examines a lattice as fine as the points allow. If the vote there is uncertain, coarser ones, for clouds
/// with noise and gaps. If no lattice has a topology, the choice is the largest ball on the coarsest one. \p
/// places tell hollows. Does not depend on the number of threads.
LatticeSurvey survey_lattices(const std::vector<vcg::Point3f>& points, const std::vector<LayerPlace>& places,
                              const vcg::Box3f& box, ThreadTeam& team, Progress& progress);

}  // namespace neuralmesh
