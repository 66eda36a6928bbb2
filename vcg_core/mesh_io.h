// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Any vcg mesh in, any vcg mesh out: the only place where the core meets the caller's mesh type.
#pragma once

#include <vcg/complex/complex.h>
#include <vcg/math/matrix44.h>
#include <vcg/space/color4.h>
#include <vcg/space/point3.h>

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "counter_colors.h"
#include "neural_mesh.h"
#include "settings.h"
#include "target_space.h"

namespace neuralmesh {

/// The target space of \p mesh under \p transform (the layer's matrix; identity: nothing changes).
/// Deleted elements are skipped; settings.selected_only keeps the selected vertices (or faces) alone;
/// settings.draw_from_faces makes a mesh with faces be sampled over its area. The mesh is not changed.
/// \throws InputError as TargetSpace does, and if selected_only finds no selection
/// O(vertices), or O(faces); 8 bytes of passing memory per element beside the target space itself.
template <class MeshType, class Matrix>
TargetSpace target_space_of(const MeshType& mesh, const Matrix& transform, const Settings& settings);

/// Writes \p result into the empty mesh \p out: coordinates, faces, quality = counter, and as the settings
/// ask: vertex colour and vertex selection. Components that MeshType lacks are left out. O(vertices + faces).
template <class MeshType>
void write_mesh(const NeuralMesh& result, const Settings& settings, MeshType& out);

namespace detail {

using Coordinates = std::array<double, 3>;

// The caller may be compiled against another vcglib than the core, and the two pass Point3 in different
// ways. So only standard types cross here.
TargetSpace target_of_points(std::size_t count, const std::function<Coordinates(std::size_t)>& point_at);
TargetSpace target_of_triangles(std::size_t count,
                                const std::function<Coordinates(std::size_t, int)>& corner_at);

/// The elements of a vcg container that are to be learned, \p kind being their name for the user.
template <class Container>
std::vector<const typename Container::value_type*> elements_of(const Container& all, bool selected_only,
                                                               const std::string& kind) {
    std::vector<const typename Container::value_type*> elements;
    elements.reserve(all.size());
    for (const auto& element : all)
        if (!element.IsD() && (element.IsS() || !selected_only)) elements.push_back(&element);
    if (selected_only && elements.empty())
        throw InputError("Only the selected " + kind +
                         " of the layer are to be learned, but none is selected: select "
                         "some, or switch selected_only off.");
    return elements;
}

}  // namespace detail

template <class MeshType, class Matrix>
TargetSpace target_space_of(const MeshType& mesh, const Matrix& transform, const Settings& settings) {
    vcg::Matrix44d to_world;
    to_world.Import(transform);
    const auto in_world = [&to_world](const auto& p) {
        const vcg::Point3d q = to_world * vcg::Point3d::Construct(p);
        return detail::Coordinates{q[0], q[1], q[2]};
    };
    if (settings.draw_from_faces && mesh.fn > 0) {
        const auto faces = detail::elements_of(mesh.face, settings.selected_only, "faces");
        return detail::target_of_triangles(faces.size(),
                                           [&](std::size_t i, int k) { return in_world(faces[i]->cP(k)); });
    }
    const auto vertices = detail::elements_of(mesh.vert, settings.selected_only && mesh.vn > 0, "vertices");
    return detail::target_of_points(vertices.size(),
                                    [&](std::size_t i) { return in_world(vertices[i]->cP()); });
}

template <class MeshType>
void write_mesh(const NeuralMesh& result, const Settings& settings, MeshType& out) {
    using Coord = typename MeshType::CoordType;
    auto vertex = vcg::tri::Allocator<MeshType>::AddVertices(out, result.positions.size());
    const std::vector<Color> colors =
        settings.color_by_counter ? counter_colors(result.counters) : std::vector<Color>();
    for (std::size_t i = 0; i < result.positions.size(); ++i, ++vertex) {
        vertex->P() = Coord::Construct(result.positions[i]);
        if (vcg::tri::HasPerVertexQuality(out)) vertex->Q() = result.counters[i];
        if (settings.color_by_counter && vcg::tri::HasPerVertexColor(out))
            vertex->C() = vcg::Color4b(colors[i][0], colors[i][1], colors[i][2], 255);
        if (settings.select_features && result.features[i] != 0) vertex->SetS();
    }
    auto face = vcg::tri::Allocator<MeshType>::AddFaces(out, result.faces.size());
    for (const std::array<int, 3>& corners : result.faces) {
        for (int k = 0; k < 3; ++k)
            face->V(k) = &out.vert[static_cast<std::size_t>(corners[static_cast<std::size_t>(k)])];
        ++face;
    }
}

}  // namespace neuralmesh
