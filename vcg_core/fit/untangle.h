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

/// How far untangle() goes.
struct Untangling {
    int rounds;
    float longest_move;  ///< of a vertex, in mean edge lengths
    int restored_rings;  ///< around self-crossings that remain; they get their old positions back
    bool draws_back;     ///< whether boundary vertices move inwards, too, not only along the boundary
};
/// Leaves boundaries where they are.
constexpr Untangling kGentle{10, 1, 6, false};
/// For boundaries that pierce another part of the surface.
constexpr Untangling kThorough{20, 3, 1, true};

/// Laplacian smoothing of \p network around its self-crossings, over neighbourhoods that widen from round to
/// round. Where self-crossings remain, the surface around them gets its old positions back. No other vertex
/// moves. Gives up, leaving the network unchanged, if more than 100 pairs of face boxes per face overlap. The
/// result does not depend on the number of threads.
///
/// \param progress asked before every round; if it asks to stop, the network stays unchanged
/// \return the remaining self-crossings, sorted; nothing if stopped
///
/// Cost: that of self_crossings() once and of update_self_crossings() per round.
std::optional<std::vector<SelfCrossing>> untangle(Network& network, const Untangling& how, ThreadTeam& team,
                                                  Progress& progress);

}  // namespace neuralmesh
