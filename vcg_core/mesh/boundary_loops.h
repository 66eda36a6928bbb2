// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Boundary loops of an indexed mesh: found, measured and filled.
#pragma once

#include <vcg/space/point3.h>

#include <array>
#include <cstddef>
#include <vector>

#include "vcg_core/mesh/indexed_mesh.h"
#include "vcg_core/mesh/ring.h"

namespace neuralmesh {

/// The boundary loops of an oriented manifold of \p vertices vertices, each a list of vertices such that the
/// surface lies to the left of every step. O(faces).
std::vector<std::vector<VertexId>> boundary_loops(int vertices, const std::vector<Triangle>& faces);

/// Diameter of the smallest sphere around \p points, to about 1 % (Badoiu and Clarkson, "Smaller Core-Sets
/// for Balls", 2003). O(points).
float smallest_sphere_diameter(const std::vector<vcg::Point3f>& points);

/// Fills holes of a mesh, which has to outlive it. O(faces) to set up.
class HoleFiller {
public:
    /// No vertex gets more than \p most_neighbours of them.
    HoleFiller(IndexedMesh<float>& mesh, const std::vector<std::vector<VertexId>>& loops,
               int most_neighbours);

    /// Fills the hole that \p loop, one of the loops, bounds by cutting ears, those of the smallest angle
    /// first. The mesh stays a simplicial manifold. \return false, with the mesh unchanged, if that cannot
    /// be. O(n^2).
    bool fill(const std::vector<VertexId>& loop);

private:
    /// A hole being filled: what is left of it, and what was added.
    struct Filling {
        std::vector<VertexId> rest;
        std::vector<Triangle> faces;
        std::vector<std::array<VertexId, 2>> edges;
    };
    bool full(VertexId v) const { return static_cast<int>(neighbours_[v].size()) >= most_neighbours_; }
    float sharpness(const Filling& filling, std::size_t i) const;
    bool cut_ear(Filling& filling);
    void undo(const Filling& filling);
    void join(Filling& filling, VertexId a, VertexId b);

    IndexedMesh<float>& mesh_;
    int most_neighbours_;
    PerVertex<std::vector<VertexId>> neighbours_;  ///< of the vertices of loops; the others have none
};

}  // namespace neuralmesh
