// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The nearest face by looking at all, for what searches cleverly.
#pragma once

#include <limits>

#include "vcg_core/mesh/surface.h"

namespace neuralmesh::referee {

/// The face of \p faces nearest to \p p, the first among equals; face -1 if there are none.
template <class Faces>
Hit nearest_face(const Vector3& p, const PerVertex<Vector3>& positions, const Faces& faces) {
    Hit best{-1, {std::numeric_limits<float>::max(), {1, 0, 0}}};
    int index = 0;
    for (const Triangle& face : faces) {
        const Foot foot = foot_on_triangle(p, positions[face[0]], positions[face[1]], positions[face[2]]);
        if (foot.squared_distance < best.foot.squared_distance) best = {index, foot};
        ++index;
    }
    return best;
}

}  // namespace neuralmesh::referee
