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

#include "vcg_core/base/colors_and_normals.h"
#include "vcg_core/rounded_coordinates.h"

namespace neuralmesh::c_api {

namespace {

template <class T>
std::array<T, 3> row_of(const neural_mesh_array& array, std::size_t row) {
    std::array<T, 3> values;
    const char* at = static_cast<const char*>(array.data) + static_cast<std::ptrdiff_t>(row) * array.row_step;
    for (T& value : values) {
        std::memcpy(&value, at, sizeof value);
        at += array.value_step;
    }
    return values;
}

std::array<double, 3> coordinates(const neural_mesh_array& array, std::size_t row) {
    if (array.type == NEURAL_MESH_DOUBLE) return row_of<double>(array, row);
    const auto [x, y, z] = row_of<float>(array, row);
    return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
}

std::array<std::int64_t, 3> indices(const neural_mesh_array& array, std::size_t row) {
    if (array.type == NEURAL_MESH_INT64) return row_of<std::int64_t>(array, row);
    const auto [a, b, c] = row_of<std::int32_t>(array, row);
    return {a, b, c};
}

/// \throws InputError if the face names no row of an array of \p count
std::array<int, 3> corners(const neural_mesh_array& faces, std::size_t row, std::size_t count) {
    std::array<int, 3> result{};
    std::size_t k = 0;
    for (const std::int64_t index : indices(faces, row)) {
        if (index < 0 || static_cast<std::uint64_t>(index) >= count)
            throw InputError("Face " + std::to_string(row) + " has the corner " + std::to_string(index) +
                             ", but corners are numbers from 0 of " + std::to_string(count) +
                             " points: correct the faces.");
        result[k++] = static_cast<int>(index);
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

bool is_finite(const vcg::Point3d& p) {
    return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
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
        target.set_colors(for_each_position(
            cloud, by_faces, [&](std::size_t row) { return row_of<unsigned char>(cloud.colors, row); }));
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
            if (!is_finite(p))
                throw InputError("Vertex " + std::to_string(corner) +
                                 " of the given mesh has coordinates that are not finite (NaN or infinite): "
                                 "remove it, and its faces.");
        }
    }
    return mesh;
}

}  // namespace neuralmesh::c_api
