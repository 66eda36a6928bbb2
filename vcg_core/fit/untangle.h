// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Takes crossings out of a mesh before it is fitted.
#pragma once

#include <optional>
#include <vector>

#include "vcg_core/base/progress.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/mesh/self_crossings.h"

namespace neuralmesh {

/// Smooths \p network where its surface cuts itself, in widening surroundings, until it does so no more;
/// places where that does not help within a few rounds are left as they were. Moves no other vertices, and no
/// vertex further than a mean edge length. Leaves the network as it was where so many faces lie in each other
/// that smoothing could not part them (by their boxes a hundred near each face), and if \p progress, which is
/// asked before every round, wants it to stop. The same result for any \p team.
/// \return the crossings left; nothing if it was stopped
std::optional<std::vector<Crossing>> untangle(Network& network, ThreadTeam& team, Progress& progress);

}  // namespace neuralmesh
