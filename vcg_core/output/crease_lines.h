// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The creases of a mesh as polylines.
#pragma once

#include <vcg/space/point3.h>

#include <array>
#include <vector>

#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// Lines that meet at corners, in the frame of the network.
struct CreaseGraph {
    std::vector<VertexId> vertices;         ///< of the network, in rising order: those near the lines' own
    std::vector<vcg::Point3f> positions;    ///< of the lines' vertices
    std::vector<std::array<int, 2>> edges;  ///< indices into vertices, the smaller one first, in rising order
    int lines = 0;                          ///< from corner or end to corner or end, or closed
    int corners = 0;                        ///< vertices of three or more edges
};

/// The creases of \p network, chained from its sharp edges:
/// 1. Edges count whose faces differ by more than 30 degrees and whose ends both have a \p measure, that of
///    CreaseMeasure, of at least .7. The normals are those of FilteredFaces, without most of the noise.
/// 2. Gaps of up to two mean edges of the mesh are bridged where a line goes on straight.
/// 3. Edges shorter than half a mean edge are contracted: strips of small faces along a crease become a line.
/// 4. Ends beside a corner join it. Of two short lines between the same corners the more creased one stays.
///    Branches of one or two edges and separate lines of up to three go.
/// 5. Vertices along a line move to where two planes meet (TwoPlanes), which noise moves less than the mesh.
///    Corners and ends stay where the vertices are.
///
/// Boundaries are no creases. Two creases nearer to each other than half a mean edge may come out as one.
/// O(vertices log vertices).
CreaseGraph crease_lines(const Network& network, const PerVertex<float>& measure);

}  // namespace neuralmesh
