// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The Basic Step of the paper's section 2, one signal at a time. This is the definition: the learning itself
// runs engine/eight_steps, which computes the same for eight signals at once and is tested against this.
#pragma once

#include <vcg/space/point3.h>

#include <array>

#include "vcg_core/engine/step_rates.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

using Positions = PerVertex<vcg::Point3d>;

/// What a Basic Step changes: the positions of the winner and of its 1-ring. All other vertices stay.
struct BasicStep {
    VertexId winner;
    vcg::Point3d winner_position;
    std::array<vcg::Point3d, Ring::kMaxValence> ring_positions;  ///< in the order of the ring
    double delta;  ///< variation of the winner's normal, in [0, 2]
};

/// The vertex nearest to \p s, the smallest id among equally near ones; -1 if there is none. O(vertices).
VertexId find_winner(const Network& network, const Positions& positions, const vcg::Point3d& s);

/// Moves the winner \p w towards the signal \p s, then smooths its 1-ring C_L times, all ring vertices at
/// once (Jacobi). Boundary vertices of the ring stand still meanwhile.
///
/// A winner on a boundary then smooths its two neighbours there by rate_along_boundary(alpha_L) (L(v) -
/// L(w)), where L(v) leads from a vertex to the middle between its two neighbours on the boundary. L(v) alone
/// would shrink the boundary; on a circle, L(v) and L(w) are about the same. O(sum of the ring's valences).
BasicStep basic_step(const Network& network, const Positions& positions, VertexId w, const vcg::Point3d& s,
                     const StepRates& rates);

}  // namespace neuralmesh
