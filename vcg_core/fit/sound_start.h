// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The mesh that the fit begins with: as free of self-crossings as can be.
#pragma once

#include <optional>
#include <vector>

#include "vcg_core/base/progress.h"
#include "vcg_core/base/thread_team.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/mesh/self_crossings.h"

namespace neuralmesh {

/// Removes the self-crossings of \p network. On a closed surface by smoothing alone, see untangle(). If there
/// is a boundary and some remain, also by removing faces that cut others, see remove_cut_faces(); as many
/// vertices as go with them are inserted on the longest edges. The result does not depend on the number of
/// threads.
///
/// \param progress asked before every round of the first smoothing; if it asks to stop, the network stays
/// unchanged
/// \return the remaining self-crossings, sorted; nothing if stopped
std::optional<std::vector<SelfCrossing>> make_sound(Network& network, ThreadTeam& team, Progress& progress);

/// Where faces of \p network are turned away from its viewer, who cannot have seen them, smooths the surface
/// in the image of the viewer: vertices move at right angles to their lines of sight, towards the middle of
/// their neighbours. Points at several heights along a line of sight, as those of crowns above the ground,
/// make learning fold the surface. Boundary vertices stay. A surface that overhangs by some edges loses
/// little of that: inside of it vertices are in the middle of their neighbours already. Without a viewer
/// nothing moves. O(vertices).
void unfold(Network& network);

}  // namespace neuralmesh
