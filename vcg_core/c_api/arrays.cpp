// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/c_api/arrays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "vcg_core/base/color.h"
#include "vcg_core/base/packed_normal.h"
#include "vcg_core/rounded_coordinates.h"

namespace neuralmesh::c_api {

namespace {

template <class T>
T value_in(const neural_mesh_array& array, std::size_t row, int k) {
    T value;
    std::memcpy(&value,
                static_cast<const char*>(array.data) + static_cast<std::ptrdiff_t>(row) * array.row_step +
                    k * array.value_step,
                sizeof value);
    return value;
}

std::array<double, 3> coordinates(const neural_mesh_array& array, std::size_t row) {
    if (array.type == NEURAL_MESH_DOUBLE)
        return {value_in<double>(array, row, 0), value_in<double>(array, row, 1),
                value_in<double>(array, row, 2)};
    return {static_cast<double>(value_in<float>(array, row, 0)),
            static_cast<double>(value_in<float>(array, row, 1)),
            static_cast<double>(value_in<float>(array, row, 2))};
}

Color color(const neural_mesh_array& array, std::size_t row) {
    return {value_in<unsigned char>(array, row, 0), value_in<unsigned char>(array, row, 1),
            value_in<unsigned char>(array, row, 2)};
}

/// \throws InputError if the face names no row of an array of \p count
std::array<int, 3> corners(const neural_mesh_array& faces, std::size_t row, std::size_t count) {
    std::array<int, 3> result{};
    for (int k = 0; k < 3; ++k) {
        const std::int64_t index = faces.type == NEURAL_MESH_INT64 ? value_in<std::int64_t>(faces, row, k)
                                                                   : value_in<std::int32_t>(faces, row, k);
        if (index < 0 || static_cast<std::uint64_t>(index) >= count)
            throw InputError("Face " + std::to_string(row) + " has the corner " + std::to_string(index) +
                             ", but corners are numbers from 0 of " + std::to_string(count) +
                             " points: correct the faces.");
        result[static_cast<std::size_t>(k)] = static_cast<int>(index);
    }
    return result;
}

void check_one_each(const neural_mesh_array& array, const neural_mesh_array& points, const char* name) {
    if (array.rows != points.rows)
        throw CallError("There are " + std::to_string(array.rows) + ' ' + name + " for " +
                        std::to_string(points.rows) + " points: give one for each.");
}

/// The element of the cloud for each corner of its faces, in their order; for points without faces, itself.
template <class Element>
auto for_each_position(const Cloud& cloud, bool by_faces, const Element& element) {
    std::vector<decltype(element(std::size_t{}))> elements;
    elements.reserve(by_faces ? 3 * cloud.faces.rows : cloud.points.rows);
    if (by_faces) {
        for (std::size_t row = 0; row < cloud.faces.rows; ++row)
            for (const int corner : corners(cloud.faces, row, cloud.points.rows))
                elements.push_back(element(static_cast<std::size_t>(corner)));
    } else {
        for (std::size_t row = 0; row < cloud.points.rows; ++row) elements.push_back(element(row));
    }
    return elements;
}

TargetSpace target_of_faces(const Cloud& cloud) {
    for (std::size_t row = 0; row < cloud.faces.rows; ++row) corners(cloud.faces, row, cloud.points.rows);
    return TargetSpace::triangles(cloud.faces.rows, [&cloud](std::size_t row, int k) {
        const std::array<int, 3> face = corners(cloud.faces, row, cloud.points.rows);
        return point(cloud.points, static_cast<std::size_t>(face[static_cast<std::size_t>(k)]));
    });
}

TargetSpace target_of_points(const Cloud& cloud, const Settings& settings) {
    const neural_mesh_array& points = cloud.points;
    TargetSpace target =
        TargetSpace::points(points.rows, [&](std::size_t row) { return point(points, row); });
    target.set_rounding(
        float_step(points.rows, [&](std::size_t row) { return coordinates(points, row); }, {1, 1, 1}));
    if (settings.use_normals && cloud.normals.rows > 0)
        target.set_normals(for_each_position(
            cloud, false, [&](std::size_t row) { return packed(coordinates(cloud.normals, row)); }));
    return target;
}

}  // namespace

neural_mesh_array checked(const neural_mesh_array* given, const char* name,
                          std::initializer_list<int> types) {
    if (given == nullptr) return {};
    if (std::find(types.begin(), types.end(), given->type) == types.end())
        throw CallError(std::string("The type of the array of ") + name + " is none of those allowed.");
    if (given->data == nullptr && given->rows > 0)
        throw CallError(std::string("The array of ") + name + " has rows, but no data.");
    return *given;
}

vcg::Point3d point(const neural_mesh_array& array, std::size_t row) {
    const auto [x, y, z] = coordinates(array, row);
    return {x, y, z};
}

TargetSpace target_space_of(const Cloud& cloud, const Settings& settings) {
    if (cloud.colors.rows > 0) check_one_each(cloud.colors, cloud.points, "colours");
    if (cloud.normals.rows > 0) check_one_each(cloud.normals, cloud.points, "normals");
    const bool by_faces = settings.draw_from_faces && cloud.faces.rows > 0;
    TargetSpace target = by_faces ? target_of_faces(cloud) : target_of_points(cloud, settings);
    if (settings.vertex_color == kCloudColors && cloud.colors.rows > 0)
        target.set_colors(
            for_each_position(cloud, by_faces, [&](std::size_t row) { return color(cloud.colors, row); }));
    return target;
}

IndexedMesh<double> indexed_mesh_of(const neural_mesh_array& positions, const neural_mesh_array& faces) {
    IndexedMesh<double> mesh;
    mesh.positions.reserve(positions.rows);
    for (std::size_t row = 0; row < positions.rows; ++row) mesh.positions.push_back(point(positions, row));
    mesh.faces.reserve(faces.rows);
    for (std::size_t row = 0; row < faces.rows; ++row) {
        mesh.faces.push_back(corners(faces, row, positions.rows));
        for (const int corner : mesh.faces.back()) {
            const vcg::Point3d& p = mesh.positions[static_cast<std::size_t>(corner)];
            if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2]))
                throw InputError("Vertex " + std::to_string(corner) +
                                 " of the given mesh has coordinates that are not finite (NaN or infinite): "
                                 "remove it, and its faces.");
        }
    }
    return mesh;
}

}  // namespace neuralmesh::c_api
