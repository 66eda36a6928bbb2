// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Target spaces made of the shapes and clouds of shapes.h, and networks in their frames.
#pragma once

#include <cstddef>

#include "tests/unit/support/referee.h"
#include "tests/unit/support/shapes.h"
#include "vcg_core/cloud/target_space.h"

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

/// The shape, in the coordinates of the cloud, as a network in the frame of \p target. Every vertex is moved
/// by up to \p noise, in diagonals of the target's bounding box.
inline Network network_in_frame(const TargetSpace& target, shapes::Shape shape, double noise = 0) {
    for (vcg::Point3d& p : shape.positions) p = vcg::Point3d::Construct(target.frame().inside(p));
    return referee::network_of(shape, noise);
}

}  // namespace neuralmesh::targets
