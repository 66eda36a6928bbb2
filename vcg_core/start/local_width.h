// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// How far the shell is from itself: through a thin wall, or across a narrow gap. A signal is won by the
// nearest vertex, so a start mesh with edges much longer than that gives signals to the wrong side, and walls
// crumple.
#pragma once

#include <algorithm>

#include "vcg_core/mesh/network.h"
#include "vcg_core/start/lattice.h"

namespace neuralmesh {

/// At the vertices of a shell, the surface of a solid, the thickness of the wall behind them and the width of
/// the gap before them, both between the points, which lie \p radius below the shell.
class LocalWidths {
public:
    /// Those up to \p farthest. O(vertices x farthest / step).
    LocalWidths(const Network& shell, const Lattice& lattice, const NodeSet& solid, float radius,
                float farthest);

    /// The smaller of both, at most \p farthest, at least the larger of the radius and 1.5 lattice steps,
    /// because no smaller width can be told on the lattice.
    float width(VertexId v, float farthest) const;

    /// How far the points below vertex \p v may be moved outwards, so that walls thinner than \p thick become
    /// thicker, and no wider than the gaps before them: at most half of the radius. 0 at other walls.
    /// \pre widths up to farthest_for(thick, radius) are known
    float thickening(VertexId v, float thick) const;
    static float farthest_for(float thick, float radius) { return std::max(2 * thick, 4 * radius); }

private:
    float wall(VertexId v, float farthest) const {
        return std::min(behind_[v], farthest + 2 * radius_) - 2 * radius_;
    }
    float gap(VertexId v, float farthest) const {
        return std::min(before_[v], farthest - 2 * radius_) + 2 * radius_;
    }

    float radius_, step_;
    PerVertex<float> behind_, before_;  ///< ways from the shell
};

}  // namespace neuralmesh
