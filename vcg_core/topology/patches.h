// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Faces that close a rim, or join several.
#pragma once

#include <vector>

#include "vcg_core/mesh/surface.h"

namespace neuralmesh {

/// A closed chain of vertices. Of a hole: the surface lies to the left of every step.
using Rim = std::vector<VertexId>;

/// Rims longer than this get no patch. On a mesh from a tetrahedron those of handles have up to 60 vertices.
/// With 24, feline from 20,000 points has two handles with two seeds of five instead of four.
constexpr int kLongestRim = 100;

/// The edges between the vertices of a network, with and without the faces to be replaced.
class Edges {
public:
    Edges(const Network& network, const Surface& surface, const PerFace<char>& left_out)
        : network_(network), surface_(surface), left_out_(left_out) {}
    float squared_length(VertexId a, VertexId b) const;
    /// The squared length as well; infinite if the edge exists, also without these faces.
    float new_edge(VertexId a, VertexId b) const;

private:
    const Network& network_;
    const Surface& surface_;
    const PerFace<char>& left_out_;
};

/// Faces between the vertices of each of \p rims that close its hole with the least sum of squared edges, by
/// dynamic programming (Barequet and Sharir, "Filling Gaps in the Boundary of a Polyhedron", 1995). None if
/// for one every choice needs an edge that exists, or it is longer than kLongestRim. O(n^3)
std::vector<Triangle> closing_patches(const std::vector<Rim>& rims, const Edges& edges);

/// Faces between two and more \p rims, a sphere with as many holes, again with the least sum of squared edges
/// as far as it looks. Between two rims, faces by turns along one and the other. Three and more become one
/// polygon by the shortest edges between them. None as above, if rims share a vertex, or if three and more
/// have more than twice kLongestRim vertices together. O(n^3)
std::vector<Triangle> joining_patch(const std::vector<Rim>& rims, const Edges& edges);

}  // namespace neuralmesh
