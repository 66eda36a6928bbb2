// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Figures of a mesh of equilateral triangles, which "mean edge" refers to.
#pragma once

namespace neuralmesh {

/// Area of an even mesh for each of its vertices, in squared edges: twice that of an equilateral triangle.
constexpr double kAreaPerVertex = 0.8660254037844386;

}  // namespace neuralmesh
