// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Conversion from and to the caller's mesh, of any vcg type. No other file of the core knows that type.
#pragma once

#include <vcg/complex/complex.h>
#include <vcg/math/matrix44.h>
#include <vcg/space/color4.h>
#include <vcg/space/point3.h>

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "vcg_core/base/colors_and_normals.h"
#include "vcg_core/cloud/target_space.h"
#include "vcg_core/mesh/indexed_mesh.h"
#include "vcg_core/mesh_counters.h"
#include "vcg_core/result.h"
#include "vcg_core/settings.h"

namespace neuralmesh {

/// The target space of \p mesh in world coordinates; \p transform is the layer's matrix. Deleted elements are
/// skipped. If \p colored, its points have the colours of the mesh's vertices. If settings.draw_from_faces
/// and the mesh has faces, it is sampled over their area, else its vertices are the cloud;
/// settings.selected_only restricts either to the selected ones. If settings.use_normals, vertices that are
/// the cloud keep their normals; zero vectors are none. \throws InputError as TargetSpace does, if
/// selected_only finds no selection, and if coordinates are not finite in the mesh or after the transform
/// O(elements); 8 bytes of temporary memory per element besides the target space.
template <class MeshType, class Matrix>
TargetSpace target_space_of(const MeshType& mesh, const Matrix& transform, const Settings& settings,
                            bool colored = false);

/// The faces of \p mesh that are not deleted, with all its vertices, also those that no face uses, in world
/// coordinates. \throws InputError if coordinates of the faces' corners are not finite in the mesh or after
/// the transform. O(elements).
template <class MeshType, class Matrix>
IndexedMesh<double> indexed_mesh_of(const MeshType& mesh, const Matrix& transform);

using Coordinates = std::array<double, 3>;

/// The point that the coordinates of a mesh of MeshType should be relative to, so that rounding to its scalar
/// type does not damage the surface of \p result. It is the world's origin if rounding there moves no vertex
/// by more than 1e-5 of the bounding box's diagonal, or if the alternative does not halve the rounding. The
/// alternative is the translation of the layer's matrix \p transform: with it, unlike with the centre of the
/// result, both layers have the same frame, also in files. O(vertices).
template <class MeshType, class Matrix>
Coordinates origin_of(const NeuralMesh& result, const Matrix& transform);

/// Writes \p result into the empty mesh \p out: coordinates relative to \p origin, faces, the counter as
/// vertex quality and, if there are any, vertex colours and, if the settings ask for it, vertex selection.
/// Skips vertex attributes that MeshType lacks. O(vertices + faces).
template <class MeshType>
void write_mesh(const NeuralMesh& result, const Settings& settings, MeshType& out,
                const Coordinates& origin = {});

/// Writes \p lines into the empty mesh \p out, whose type has edges: coordinates relative to \p origin,
/// edges, and the crease measure as vertex quality. O(vertices + edges).
template <class MeshType>
void write_creases(const CreaseLines& lines, MeshType& out, const Coordinates& origin = {});

/// Writes \p result into \p mesh, whose indexed_mesh_of() it was made of: the vertex quality and, if the
/// settings ask for it, the selection of vertices. Skips deleted vertices. Throws nothing. O(vertices).
template <class MeshType>
void write_counters(const MeshCounters& result, const Settings& settings, MeshType& mesh);

namespace detail {

// The caller may be compiled against another release of vcglib than the core, which may pass Point3 in
// another way. So only standard types cross these calls.
TargetSpace target_of_points(std::size_t count, const std::function<Coordinates(std::size_t)>& point_at);
TargetSpace target_of_triangles(std::size_t count,
                                const std::function<Coordinates(std::size_t, int)>& corner_at);

/// See float_step(). \p at(i): the coordinates of point i in the layer.
double rounding_of(std::size_t count, const std::function<Coordinates(std::size_t)>& at,
                   const std::array<Coordinates, 3>& rows_of_matrix);

/// See origin_of(). \p rounding: relative error of the mesh's scalar type.
Coordinates better_origin(const NeuralMesh& result, const Coordinates& of_layer, double rounding);

bool is_finite(const Coordinates& c);
[[noreturn]] void refuse_not_finite(std::size_t not_finite, std::size_t count);
[[noreturn]] void refuse_matrix();

/// \throws InputError if a vertex is not finite, or not finite in world coordinates. \p vertex_at(i), i in
/// [0, count), may give a vertex more than once; the message counts it once.
template <class VertexAt, class InWorld>
void check_finite(std::size_t count, std::size_t all, const VertexAt& vertex_at, const InWorld& in_world) {
    std::set<const void*> not_finite;
    bool world_is_finite = true;
    for (std::size_t i = 0; i < count; ++i) {
        const auto& vertex = vertex_at(i);
        const auto& p = vertex.cP();
        if (!is_finite({double(p[0]), double(p[1]), double(p[2])})) {
            not_finite.insert(&vertex);
        } else {
            world_is_finite = world_is_finite && is_finite(in_world(p));
        }
    }
    if (!not_finite.empty()) refuse_not_finite(not_finite.size(), all);
    if (!world_is_finite) refuse_matrix();
}

/// The elements of a vcg container to learn. \p kind: their name in the error message.
template <class Container>
std::vector<const typename Container::value_type*> elements_of(const Container& all, bool selected_only,
                                                               const std::string& kind) {
    std::vector<const typename Container::value_type*> elements;
    elements.reserve(all.size());
    for (const auto& element : all)
        if (!element.IsD() && (element.IsS() || !selected_only)) elements.push_back(&element);
    if (selected_only && elements.empty())
        throw InputError("Only the selected " + kind +
                         " of the layer are to be learned, but none are selected: select some, or switch "
                         "'Selected only' off.");
    return elements;
}

template <class Point>
Coordinates in_world(const vcg::Matrix44d& to_world, const Point& p) {
    const vcg::Point3d q = to_world * vcg::Point3d::Construct(p);
    return {q[0], q[1], q[2]};
}

/// What normals become where positions are transformed by \p to_world: outward ones stay outward, also if it
/// mirrors. The inverse transpose, up to a positive factor, and defined for matrices without inverse.
struct NormalTransform {
    explicit NormalTransform(const std::array<Coordinates, 3>& rows_of_matrix);
    PackedNormal operator()(const Coordinates& normal) const;
    std::array<Coordinates, 3> rows;
};

/// \p color_at(i), i in [0, count), returns a vcg colour.
template <class ColorAt>
std::vector<Color> colors_of(std::size_t count, const ColorAt& color_at) {
    std::vector<Color> colors(count);
    for (std::size_t i = 0; i < count; ++i) {
        const auto& c = color_at(i);
        colors[i] = {c[0], c[1], c[2]};
    }
    return colors;
}

/// The upper left part of \p matrix.
inline std::array<Coordinates, 3> rows_of(const vcg::Matrix44d& matrix) {
    std::array<Coordinates, 3> rows{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k)
            rows[i][k] = matrix.ElementAt(static_cast<int>(i), static_cast<int>(k));
    return rows;
}

/// The normals of \p vertices, in world coordinates.
template <class Vertex>
std::vector<PackedNormal> normals_of(const std::vector<const Vertex*>& vertices,
                                     const vcg::Matrix44d& to_world) {
    const NormalTransform in_world(rows_of(to_world));
    std::vector<PackedNormal> normals;
    normals.reserve(vertices.size());
    for (const Vertex* v : vertices) {
        const auto& n = v->cN();
        normals.push_back(in_world({double(n[0]), double(n[1]), double(n[2])}));
    }
    return normals;
}

/// Adds vertices with \p quality to \p out, at \p positions relative to \p origin.
template <class MeshType>
void add_vertices(const std::vector<vcg::Point3d>& positions, const std::vector<float>& quality,
                  MeshType& out, const Coordinates& origin) {
    const vcg::Point3d from(origin[0], origin[1], origin[2]);
    auto vertex = vcg::tri::Allocator<MeshType>::AddVertices(out, positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i, ++vertex) {
        vertex->P() = MeshType::CoordType::Construct(positions[i] - from);
        if (vcg::tri::HasPerVertexQuality(out)) vertex->Q() = quality[i];
    }
}

/// Makes \p element, a face or an edge of \p out, the one of the vertices \p indices.
template <class Element, class Indices, class MeshType>
void set_vertices(Element& element, const Indices& indices, MeshType& out) {
    int k = 0;
    for (const int i : indices) element.V(k++) = &out.vert[static_cast<std::size_t>(i)];
}

}  // namespace detail

template <class MeshType, class Matrix>
TargetSpace target_space_of(const MeshType& mesh, const Matrix& transform, const Settings& settings,
                            bool colored) {
    vcg::Matrix44d to_world;
    to_world.Import(transform);
    const auto in_world = [&to_world](const auto& p) { return detail::in_world(to_world, p); };
    if (settings.draw_from_faces && mesh.fn > 0) {
        const auto faces = detail::elements_of(mesh.face, settings.selected_only, "faces");
        detail::check_finite(
            3 * faces.size(), static_cast<std::size_t>(mesh.vn),
            [&](std::size_t i) -> const auto& { return *faces[i / 3]->cV(static_cast<int>(i % 3)); },
            in_world);
        TargetSpace target = detail::target_of_triangles(
            faces.size(), [&](std::size_t i, int k) { return in_world(faces[i]->cP(k)); });
        if (colored)
            target.set_colors(detail::colors_of(3 * faces.size(), [&](std::size_t i) {
                return faces[i / 3]->cV(static_cast<int>(i % 3))->cC();
            }));
        return target;
    }
    const auto vertices = detail::elements_of(mesh.vert, settings.selected_only && mesh.vn > 0, "vertices");
    detail::check_finite(
        vertices.size(),
        static_cast<std::size_t>(mesh.vn), [&](std::size_t i) -> const auto& { return *vertices[i]; },
        in_world);
    TargetSpace target =
        detail::target_of_points(vertices.size(), [&](std::size_t i) { return in_world(vertices[i]->cP()); });
    const auto in_layer = [&](std::size_t i) {
        const auto& p = vertices[i]->cP();
        return Coordinates{double(p[0]), double(p[1]), double(p[2])};
    };
    target.set_rounding(detail::rounding_of(vertices.size(), in_layer, detail::rows_of(to_world)));
    if (colored)
        target.set_colors(
            detail::colors_of(vertices.size(), [&](std::size_t i) { return vertices[i]->cC(); }));
    if (settings.use_normals && vcg::tri::HasPerVertexNormal(mesh))
        target.set_normals(detail::normals_of(vertices, to_world));
    return target;
}

template <class MeshType, class Matrix>
IndexedMesh<double> indexed_mesh_of(const MeshType& mesh, const Matrix& transform) {
    vcg::Matrix44d to_world;
    to_world.Import(transform);
    const auto faces = detail::elements_of(mesh.face, false, "faces");
    detail::check_finite(
        3 * faces.size(), static_cast<std::size_t>(mesh.vn),
        [&](std::size_t i) -> const auto& { return *faces[i / 3]->cV(static_cast<int>(i % 3)); },
        [&](const auto& p) { return detail::in_world(to_world, p); });
    IndexedMesh<double> result;
    for (const auto& v : mesh.vert) {
        const Coordinates c = detail::in_world(to_world, v.cP());
        result.positions.emplace_back(c[0], c[1], c[2]);
    }
    for (const auto* face : faces) {
        result.faces.emplace_back();
        for (int k = 0; k < 3; ++k)
            result.faces.back()[static_cast<std::size_t>(k)] =
                static_cast<int>(vcg::tri::Index(mesh, face->cV(k)));
    }
    return result;
}

template <class MeshType, class Matrix>
Coordinates origin_of(const NeuralMesh& result, const Matrix& transform) {
    using Scalar = typename MeshType::ScalarType;
    vcg::Matrix44d to_world;
    to_world.Import(transform);
    const vcg::Point3d image = to_world * vcg::Point3d(0, 0, 0);
    Coordinates of_layer{};
    // Rounded to the scalar type of the result's matrix, which will hold it.
    for (std::size_t k = 0; k < 3; ++k)
        of_layer[k] = static_cast<double>(static_cast<Scalar>(image[static_cast<int>(k)]));
    return detail::better_origin(result, of_layer, std::numeric_limits<Scalar>::epsilon() / 2);
}

template <class MeshType>
void write_mesh(const NeuralMesh& result, const Settings& settings, MeshType& out,
                const Coordinates& origin) {
    detail::add_vertices(result.positions, result.counters, out, origin);
    for (std::size_t i = 0; i < result.positions.size(); ++i) {
        if (!result.colors.empty() && vcg::tri::HasPerVertexColor(out)) {
            const Color& c = result.colors[i];
            out.vert[i].C() = vcg::Color4b(c[0], c[1], c[2], 255);
        }
        if (settings.select_features && result.features[i] != 0) out.vert[i].SetS();
    }
    auto face = vcg::tri::Allocator<MeshType>::AddFaces(out, result.faces.size());
    for (const std::array<int, 3>& corners : result.faces) detail::set_vertices(*face++, corners, out);
}

template <class MeshType>
void write_creases(const CreaseLines& lines, MeshType& out, const Coordinates& origin) {
    detail::add_vertices(lines.positions, lines.measures, out, origin);
    auto edge = vcg::tri::Allocator<MeshType>::AddEdges(out, lines.edges.size());
    for (const std::array<int, 2>& ends : lines.edges) detail::set_vertices(*edge++, ends, out);
}

template <class MeshType>
void write_counters(const MeshCounters& result, const Settings& settings, MeshType& mesh) {
    for (std::size_t i = 0; i < result.counters.size(); ++i) {
        auto& vertex = mesh.vert[i];
        if (vertex.IsD()) continue;
        vertex.Q() = result.counters[i];
        if (!settings.select_features) continue;
        if (result.features[i] != 0) {
            vertex.SetS();
        } else {
            vertex.ClearS();
        }
    }
}

}  // namespace neuralmesh
