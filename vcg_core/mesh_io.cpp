// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/mesh_io.h"

#include <algorithm>
#include <cmath>

#include "vcg_core/rounded_coordinates.h"

namespace neuralmesh::detail {

namespace {

/// How far rounding may move a vertex, as a fraction of the diagonal: much less than the error of any mesh.
/// Single precision keeps it up to 160 diagonals from the origin.
constexpr double kRounding = 1e-5;

vcg::Point3d point(const Coordinates& c) { return {c[0], c[1], c[2]}; }

/// The largest absolute coordinate relative to \p origin.
double largest_coordinate(const NeuralMesh& result, const Coordinates& origin) {
    double largest = 0;
    for (const vcg::Point3d& p : result.positions)
        for (int k = 0; k < 3; ++k)
            largest = std::max(largest, std::abs(p[k] - origin[static_cast<std::size_t>(k)]));
    return largest;
}

}  // namespace

TargetSpace target_of_points(std::size_t count, const std::function<Coordinates(std::size_t)>& point_at) {
    return TargetSpace::points(count, [&](std::size_t i) { return point(point_at(i)); });
}

TargetSpace target_of_triangles(std::size_t count,
                                const std::function<Coordinates(std::size_t, int)>& corner_at) {
    return TargetSpace::triangles(count, [&](std::size_t i, int k) { return point(corner_at(i, k)); });
}

double rounding_of(std::size_t count, const std::function<Coordinates(std::size_t)>& at,
                   const std::array<Coordinates, 3>& rows_of_matrix) {
    Coordinates lengths{};
    for (std::size_t k = 0; k < 3; ++k)
        lengths[k] = vcg::Point3d(rows_of_matrix[0][k], rows_of_matrix[1][k], rows_of_matrix[2][k]).Norm();
    return float_step(count, at, lengths);
}

Coordinates better_origin(const NeuralMesh& result, const Coordinates& of_layer, double rounding) {
    const Coordinates of_world{};
    vcg::Box3d box;
    for (const vcg::Point3d& p : result.positions) box.Add(p);
    const double in_world = largest_coordinate(result, of_world);
    if (rounding * in_world <= kRounding * box.Diag()) return of_world;
    // A matrix is worth its trouble only if it at least halves the rounding.
    return largest_coordinate(result, of_layer) < in_world / 2 ? of_layer : of_world;
}

NormalTransform::NormalTransform(const std::array<Coordinates, 3>& rows_of_matrix) {
    const auto row = [&](std::size_t i) { return point(rows_of_matrix[i % 3]); };
    const bool mirrors = row(0) * (row(1) ^ row(2)) < 0;
    for (std::size_t i = 0; i < 3; ++i) {  // the rows of the matrix of cofactors
        const vcg::Point3d cofactors = (row(i + 1) ^ row(i + 2)) * (mirrors ? -1.0 : 1.0);
        rows[i] = {cofactors[0], cofactors[1], cofactors[2]};
    }
}

PackedNormal NormalTransform::operator()(const Coordinates& normal) const {
    Coordinates result{};
    for (std::size_t i = 0; i < 3; ++i) result[i] = point(rows[i]) * point(normal);
    return packed(result);
}

bool is_finite(const Coordinates& c) {
    return std::isfinite(c[0]) && std::isfinite(c[1]) && std::isfinite(c[2]);
}

void refuse_not_finite(std::size_t not_finite, std::size_t count) {
    throw InputError(std::to_string(not_finite) + " of the " + std::to_string(count) +
                     " vertices of the layer have coordinates that are not finite (NaN or infinite): select "
                     "them with the filter 'Conditional Vertex Selection' and the condition x-x != 0 || y-y "
                     "!= 0 || z-z != 0, then remove them with 'Delete Selected Vertices'.");
}

void refuse_matrix() {
    throw InputError(
        "The matrix of the layer moves vertices to coordinates that are not finite (NaN or infinite): replace "
        "it, for example with the filter 'Matrix: Reset Current Matrix'.");
}

}  // namespace neuralmesh::detail
