// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Takes crossings out of a mesh before it is fitted.
#pragma once

#include "fit_crossings.h"
#include "network.h"

namespace neuralmesh {

/// Smooths \p network where its surface cuts itself, in widening surroundings, until it does so no more;
/// places where that does not help within a few rounds are left as they were. Moves no other vertices, and no
/// vertex further than a mean edge length. The same result for any \p team. \return the crossings left
std::vector<Crossing> untangle(Network& network, Team& team);

}  // namespace neuralmesh
