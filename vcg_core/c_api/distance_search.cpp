// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/c_api/distance_search.h"

#include <vcg/space/box3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "vcg_core/base/error.h"
#include "vcg_core/base/parallel_for.h"
#include "vcg_core/c_api/arrays.h"
#include "vcg_core/mesh/surface.h"

namespace neuralmesh::c_api {

namespace {

/// A quarter as many take half as long again.
constexpr std::size_t kPointsAtATime = 524288;
constexpr std::size_t kChunk = 4096;  ///< points per task of a thread
/// Points that are further away, in diagonals of the mesh, are looked for at this distance in their
/// direction, because single precision would not tell faces apart. The face that is nearest to that place is
/// at most some 1e-4 diagonals further from the point than the nearest one, a ten-millionth of the distance.
constexpr double kFar = 1000;

/// Vertices that no face uses do not count. They may have any coordinates.
Frame frame_of(const IndexedMesh<double>& mesh) {
    if (mesh.faces.empty()) throw InputError("The mesh has no faces to measure distances from.");
    vcg::Box3d box;
    for (const std::array<int, 3>& face : mesh.faces)
        for (const int corner : face) box.Add(mesh.positions[at(corner)]);
    const Frame frame{box.min / 2 + box.max / 2, (box.max - box.min).Norm()};  // the sum could overflow
    if (!std::isfinite(frame.diagonal) || frame.diagonal < 1e-150)
        throw InputError("The mesh is too large or too small for double precision: scale it first.");
    return frame;
}

vcg::Point3d inside(const Frame& frame, const vcg::Point3d& p) { return (p - frame.centre) / frame.diagonal; }

IndexedMesh<double> in_frame(IndexedMesh<double> mesh, const Frame& frame) {
    for (vcg::Point3d& p : mesh.positions) p = inside(frame, p);
    return mesh;
}

Surface surface_of(const IndexedMesh<double>& mesh) {
    Surface surface{Network()};  // whose connectivity the tree does not ask for
    surface.positions.vector().reserve(mesh.positions.size());
    for (const vcg::Point3d& p : mesh.positions)
        surface.positions.push_back(to_eigen(vcg::Point3f::Construct(p)));
    surface.faces.vector() = mesh.faces;
    return surface;
}

/// Where the tree looks for the nearest face of \p p: there, if it is not too far away.
Vector3 search_place(const vcg::Point3d& p) {
    if (!is_finite(p)) return Vector3::Zero();
    const double furthest = std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
    return to_eigen(vcg::Point3f::Construct(furthest > kFar ? p * (kFar / furthest) : p));
}

double squared_distance_to_segment(const vcg::Point3d& p, const vcg::Point3d& a, const vcg::Point3d& b) {
    const vcg::Point3d along = b - a;
    const double length = along.SquaredNorm();
    const double part = length > 0 ? std::clamp((p - a) * along / length, 0.0, 1.0) : 0;
    return (p - a - along * part).SquaredNorm();
}

double squared_distance_to_triangle(const vcg::Point3d& p, const vcg::Point3d& a, const vcg::Point3d& b,
                                    const vcg::Point3d& c) {
    const vcg::Point3d normal = (b - a) ^ (c - a);
    const auto is_within = [&](const vcg::Point3d& from, const vcg::Point3d& to) {
        return ((to - from) ^ (p - from)) * normal >= 0;
    };
    const double area = normal.SquaredNorm();
    if (area > 0 && is_within(a, b) && is_within(b, c) && is_within(c, a)) {
        const double height = (p - a) * normal;
        return height * height / area;
    }
    return std::min({squared_distance_to_segment(p, a, b), squared_distance_to_segment(p, b, c),
                     squared_distance_to_segment(p, c, a)});
}

}  // namespace

DistanceSearch::DistanceSearch(IndexedMesh<double> mesh, ThreadTeam& team)
    : frame_(frame_of(mesh)), mesh_(in_frame(std::move(mesh), frame_)), tree_(surface_of(mesh_), team) {}

void DistanceSearch::measure(const neural_mesh_array& points, ThreadTeam& team, double* distances) const {
    for (std::size_t begin = 0; begin < points.rows; begin += kPointsAtATime)
        measure_block(points, begin, std::min(points.rows, begin + kPointsAtATime), team, distances);
}

void DistanceSearch::measure_block(const neural_mesh_array& points, std::size_t begin, std::size_t end,
                                   ThreadTeam& team, double* distances) const {
    std::vector<Vector3> places(end - begin);
    for_chunks(places.size(), kChunk, team, [&](std::size_t, std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            places[i] = search_place(inside(frame_, point(points, begin + i)));
    });
    const std::vector<Hit> hits = tree_.nearest(places, team);
    for_chunks(places.size(), kChunk, team, [&](std::size_t, std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            distances[begin + i] = distance_from(hits[i].face, inside(frame_, point(points, begin + i)));
    });
}

double DistanceSearch::distance_from(int face, const vcg::Point3d& p) const {
    if (!is_finite(p)) return std::numeric_limits<double>::quiet_NaN();
    const auto [a, b, c] = mesh_.faces[at(face)];
    return std::sqrt(squared_distance_to_triangle(p, mesh_.positions[at(a)], mesh_.positions[at(b)],
                                                  mesh_.positions[at(c)])) *
           frame_.diagonal;
}

}  // namespace neuralmesh::c_api
