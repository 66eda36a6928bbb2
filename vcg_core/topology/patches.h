// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Faces that close a rim, or join two rims.
#pragma once

#include <vector>

#include "vcg_core/mesh/surface.h"

namespace neuralmesh {

/// A closed chain of vertices. Of a hole: the surface lies to the left of every step.
using Rim = std::vector<VertexId>;

/// Rims longer than this get no patch. On a mesh from a tetrahedron those of handles have up to 60 vertices.
/// With 24, feline from 20,000 points has two handles with two seeds of five instead of four.
constexpr int kLongestRim = 100;

/// Whether a network that lacks the faces to be replaced has the edge between two vertices.
class Edges {
public:
    Edges(const Network& network, const Surface& surface, const PerFace<char>& left_out)
        : network_(network), surface_(surface), left_out_(left_out) {}
    bool has(VertexId a, VertexId b) const;

private:
    const Network& network_;
    const Surface& surface_;
    const PerFace<char>& left_out_;
};

/// Faces between the vertices of \p rim that close the hole with the least sum of squared edges, by dynamic
/// programming (Barequet and Sharir, "Filling Gaps in the Boundary of a Polyhedron", 1995). None if every
/// choice needs an edge that exists, or the rim is longer than kLongestRim. O(n^3)
std::vector<Triangle> closing_patch(const Rim& rim, const PerVertex<Vector3>& positions, const Edges& edges);

/// A ring of faces from \p a to \p b, again with the least sum of squared edges. None as above, or if the
/// rims share a vertex. Of rims of more than 24 vertices the first vertex of \p a gets an edge to one of the
/// twelve nearest of \p b. O(n^3), O(n^2) for those
std::vector<Triangle> joining_patch(const Rim& a, const Rim& b, const PerVertex<Vector3>& positions,
                                    const Edges& edges);

}  // namespace neuralmesh
