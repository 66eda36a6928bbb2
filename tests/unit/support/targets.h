// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Target spaces made of the shapes and clouds of shapes.h.
#pragma once

#include <cstddef>

#include "tests/unit/support/shapes.h"
#include "vcg_core/target/target_space.h"

namespace neuralmesh::targets {

inline TargetSpace target_of(const shapes::Cloud& cloud) {
    return TargetSpace::points(cloud.size(), [&](std::size_t i) { return cloud[i]; });
}

/// Signals are drawn from the faces.
inline TargetSpace target_of(const shapes::Shape& shape) {
    return TargetSpace::triangles(shape.faces.size(), [&](std::size_t i, int k) {
        return shape.positions[static_cast<std::size_t>(shape.faces[i][static_cast<std::size_t>(k)])];
    });
}

}  // namespace neuralmesh::targets
