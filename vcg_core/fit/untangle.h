// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Removes self-crossings from a mesh before it is fitted.
#pragma once

#include <optional>
#include <vector>

#include "vcg_core/base/progress.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/mesh/self_crossings.h"

namespace neuralmesh {

/// Laplacian smoothing of \p network around its self-crossings, over neighbourhoods that widen from round to
/// round; boundary vertices move along the boundary only. Where self-crossings remain, the surface around
/// them gets its old positions back. No other vertex moves. Gives up, leaving the network unchanged, if more
/// than 100 pairs of face boxes per face overlap. The result does not depend on the number of threads.
///
/// \param progress asked before every round; if it asks to stop, the network stays unchanged
/// \return the remaining self-crossings, sorted; nothing if stopped
///
/// Cost: that of self_crossings() once and of update_self_crossings() per round.
std::optional<std::vector<SelfCrossing>> untangle(Network& network, ThreadTeam& team, Progress& progress);

}  // namespace neuralmesh
