// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Why the learning stopped.
#pragma once

namespace neuralmesh {

/// The values are part of the filter's results: they never change.
enum class StopReason : int {
    target_reached = 0,  ///< the network has the number of vertices asked for
    converged = 1,       ///< the normals turn less per signal than the bound (see eq 8)
    cancelled = 2,       ///< the caller's progress object asked to stop
    cut_short = 3,       ///< the bound on signals was reached before the target
};

}  // namespace neuralmesh
