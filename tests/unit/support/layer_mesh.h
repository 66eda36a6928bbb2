// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A mesh with the vertex and face components that the filter uses of a host's layer, in single precision.
#pragma once

#include <vcg/complex/complex.h>

#include "tests/unit/support/prelude.h"
#include "tests/unit/support/shapes.h"

namespace neuralmesh::layer_mesh {

class Vertex;
class Face;
struct Types : vcg::UsedTypes<vcg::Use<Vertex>::AsVertexType, vcg::Use<Face>::AsFaceType> {};
class Vertex : public vcg::Vertex<Types, vcg::vertex::Coord3f, vcg::vertex::Normal3f, vcg::vertex::Qualityf,
                                  vcg::vertex::Color4b, vcg::vertex::BitFlags> {
public:
    Vertex() { N().SetZero(); }  // as MeshLab has it where a file gives none
};
class Face : public vcg::Face<Types, vcg::face::VertexRef, vcg::face::BitFlags> {};
class Mesh : public vcg::tri::TriMesh<std::vector<Vertex>, std::vector<Face>> {};

/// Adds the vertices of \p shape, and if \p with_faces its faces, to the empty \p mesh.
inline void fill(Mesh& mesh, const Shape& shape, bool with_faces) {
    for (const vcg::Point3d& p : shape.positions)
        vcg::tri::Allocator<Mesh>::AddVertex(mesh, vcg::Point3f::Construct(p));
    if (!with_faces) return;
    for (const auto& [a, b, c] : shape.faces)
        vcg::tri::Allocator<Mesh>::AddFace(mesh, static_cast<std::size_t>(a), static_cast<std::size_t>(b),
                                           static_cast<std::size_t>(c));
}

}  // namespace neuralmesh::layer_mesh
