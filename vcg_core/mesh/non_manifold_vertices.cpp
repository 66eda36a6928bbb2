// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/mesh/non_manifold_vertices.h"

#include <cstddef>
#include <utility>

#include "vcg_core/base/disjoint_sets.h"
#include "vcg_core/mesh/ring.h"

namespace neuralmesh {
namespace {

/// The corners at one vertex, grouped by fans: faces that share edges at the vertex. Each fan begins with its
/// first corner in the order of \p corners.
std::vector<std::vector<int>> fans_of(const IndexedMesh<float>& mesh, std::vector<int> corners) {
    const auto neighbour = [&mesh](int corner, std::size_t ahead) {
        const auto c = static_cast<std::size_t>(corner);
        return mesh.faces[c / 3][(c % 3 + ahead) % 3];
    };
    const auto share_an_edge = [&neighbour](int a, int b) {
        return neighbour(a, 1) == neighbour(b, 2) || neighbour(a, 2) == neighbour(b, 1);
    };
    return connected_groups(std::move(corners), share_an_edge);
}

}  // namespace

void split_non_manifold_vertices(IndexedMesh<float>& mesh, std::vector<int>& source) {
    std::vector<std::vector<int>> corners(mesh.positions.size());  // of the faces around each vertex
    for (std::size_t c = 0; c < 3 * mesh.faces.size(); ++c)
        corners[static_cast<std::size_t>(mesh.faces[c / 3][c % 3])].push_back(static_cast<int>(c));
    for (std::size_t v = 0; v < corners.size(); ++v) {
        const std::vector<std::vector<int>> fans = fans_of(mesh, std::move(corners[v]));
        for (std::size_t fan = 1; fan < fans.size(); ++fan) {
            const auto copy = static_cast<VertexId>(mesh.positions.size());
            const vcg::Point3f position = mesh.positions[v];
            mesh.positions.push_back(position);
            source.push_back(source[v]);
            for (const int corner : fans[fan]) {
                const auto c = static_cast<std::size_t>(corner);
                mesh.faces[c / 3][c % 3] = copy;
            }
        }
    }
}

void drop_unused_vertices(IndexedMesh<float>& mesh, std::vector<int>& source) {
    std::vector<VertexId> moved(mesh.positions.size(), -1);
    for (const Triangle& f : mesh.faces)
        for (const VertexId v : f) moved[static_cast<std::size_t>(v)] = 0;
    std::size_t count = 0;
    for (std::size_t v = 0; v < moved.size(); ++v) {
        if (moved[v] < 0) continue;
        mesh.positions[count] = mesh.positions[v];
        source[count] = source[v];
        moved[v] = static_cast<VertexId>(count++);
    }
    mesh.positions.resize(count);
    source.resize(count);
    for (Triangle& f : mesh.faces)
        for (VertexId& v : f) v = moved[static_cast<std::size_t>(v)];
}

}  // namespace neuralmesh
