// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/start/lattice.h"

#include <algorithm>
#include <cmath>

namespace neuralmesh {
namespace {

int nodes_along(float extent, float step, int margin) {
    return static_cast<int>(std::ceil(static_cast<double>(extent) / static_cast<double>(step))) + 1 +
           2 * margin;
}

}  // namespace

Lattice::Lattice(const vcg::Box3f& box, float node_step, int margin)
    : nx(nodes_along(box.DimX(), node_step, margin)),
      ny(nodes_along(box.DimY(), node_step, margin)),
      nz(nodes_along(box.DimZ(), node_step, margin)),
      step(node_step) {
    const vcg::Point3f extent(static_cast<float>(nx - 1), static_cast<float>(ny - 1),
                              static_cast<float>(nz - 1));
    corner = box.Center() - extent * (step * 0.5F);
}

NodeId Lattice::node_of(const vcg::Point3f& p) const {
    const vcg::Point3f q = (p - corner) * (1.0F / step) + vcg::Point3f(0.5F, 0.5F, 0.5F);
    // Compared as floats: a coordinate far outside does not fit into an int.
    const float fx = static_cast<float>(nx), fy = static_cast<float>(ny), fz = static_cast<float>(nz);
    if (!(q[0] >= 0 && q[1] >= 0 && q[2] >= 0 && q[0] < fx && q[1] < fy && q[2] < fz)) return size();
    return index(static_cast<int>(q[0]), static_cast<int>(q[1]), static_cast<int>(q[2]));
}

float longest_side(const vcg::Box3f& box) { return std::max({box.DimX(), box.DimY(), box.DimZ()}); }

}  // namespace neuralmesh
