// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A triangle mesh as two arrays: the form in which meshes are handed over. Network is the form for editing.
#pragma once

#include <vcg/space/point3.h>

#include <array>
#include <vector>

namespace neuralmesh {

/// Triangles are counter-clockwise seen from outside.
template <class Scalar>
struct IndexedMesh {
    std::vector<vcg::Point3<Scalar>> positions;
    std::vector<std::array<int, 3>> faces;  ///< indices into positions
};

}  // namespace neuralmesh
