// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Moves vertices far without the surface cutting itself on the way.
#pragma once

#include "vcg_core/base/thread_team.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/mesh/triangle.h"

namespace neuralmesh {

/// Moves the vertices of \p network by \p moves, in at most twelve steps, of which none exceeds MoveLimits or
/// adds a self-crossing. Self-crossings at the start are smoothed out first where untangle() can. A vertex
/// that is held up in one step goes on in the next; in the end some may be short of their places. The result
/// does not depend on the number of threads. Cost: that of untangle(), and per step of MoveLimits and some
/// searches for crossings.
void move_soundly(Network& network, PerVertex<Vector3> moves, ThreadTeam& team);

}  // namespace neuralmesh
