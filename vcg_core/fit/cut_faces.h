// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Takes faces that cut others away from a surface with boundary.
#pragma once

#include <vector>

#include "vcg_core/base/thread_team.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/mesh/self_crossings.h"

namespace neuralmesh {

/// Where the boundary of one sheet meets the inside of another, as a chair meets the floor, signals of the
/// other sheet draw the boundary through it. Removes faces that cut others until none do, or none can be
/// removed. Of two that cut each other the one goes that has more corners on the boundary, or else the longer
/// edges. Faces that would be left in a lesser fan at a vertex go with it. In a fold the shortest edge is
/// collapsed. Faces whose removal keeps the topology go first, then folds, then others. At most a tenth
/// of the faces go: a surface that needs more is tangled beyond repair. Vertices without faces go, too.
///
/// \param[in,out] crossings the self-crossings of the network, sorted
/// \return the number of faces removed. The result does not depend on the number of threads.
/// Cost: that of update_self_crossings() per pass; every pass but the last of each kind removes faces.
int remove_cut_faces(Network& network, std::vector<SelfCrossing>& crossings, ThreadTeam& team);

}  // namespace neuralmesh
