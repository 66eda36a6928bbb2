// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Where the caller's coordinates enter the core's own vcglib.
#include "mesh_io.h"

namespace neuralmesh::detail {

namespace {

vcg::Point3d point(const Coordinates& c) { return {c[0], c[1], c[2]}; }

}  // namespace

TargetSpace target_of_points(std::size_t count, const std::function<Coordinates(std::size_t)>& point_at) {
    return TargetSpace::points(count, [&](std::size_t i) { return point(point_at(i)); });
}

TargetSpace target_of_triangles(std::size_t count,
                                const std::function<Coordinates(std::size_t, int)>& corner_at) {
    return TargetSpace::triangles(count, [&](std::size_t i, int k) { return point(corner_at(i, k)); });
}

}  // namespace neuralmesh::detail
