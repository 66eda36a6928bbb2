// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/few_points.h"

#include "vcg_core/base/platform.h"

NEURALMESH_BEGIN_UNINITIALIZED();  // of a mesh without vertices
#include <vcg/complex/algorithms/convex_hull.h>
NEURALMESH_END_UNINITIALIZED();

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "vcg_core/cloud/nearest_points.h"
#include "vcg_core/fit/redistribute.h"
#include "vcg_core/mesh/flips.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {
namespace {

/// A hull of more takes long, and their shell encloses the space if they do.
constexpr std::size_t kMostPoints = 1000;
/// How far inside of the hull a point may lie, in mean spacings.
constexpr double kDeepest = 0.1;
/// A hull thinner than this, beside the distances of its points, is that of a line or a sheet; a tetrahedron
/// of four points has .41.
constexpr double kThinnest = 0.3;
/// More than the rounding of positions in the core's frame, whose diagonal is 1.
constexpr float kHullRounding = 1e-6F;

/// How far points of a plane may be from it.
constexpr float kFlat = 10 * kHullRounding;

class HullVertex;
class HullFace;
struct HullTypes : vcg::UsedTypes<vcg::Use<HullVertex>::AsVertexType, vcg::Use<HullFace>::AsFaceType> {};
class HullVertex : public vcg::Vertex<HullTypes, vcg::vertex::Coord3d, vcg::vertex::BitFlags> {};
class HullFace : public vcg::Face<HullTypes, vcg::face::VertexRef, vcg::face::FFAdj, vcg::face::Normal3d,
                                  vcg::face::BitFlags> {};
class HullMesh : public vcg::tri::TriMesh<std::vector<HullVertex>, std::vector<HullFace>> {};

/// The mean distance of each of \p points from the nearest other one.
double mean_distance(const std::vector<vcg::Point3f>& points) {
    const NearestPoints cloud(points);
    std::vector<NearestPoints::Neighbour> nearest;
    double sum = 0;
    for (NearestPoints::Place place = 0; place < cloud.size(); ++place) {
        cloud.nearest(place, 1, nearest);
        sum += std::sqrt(static_cast<double>(nearest.front().squared_distance));
    }
    return sum / static_cast<double>(points.size());
}

double area_of(const HullMesh& hull) {
    double area = 0;
    for (const HullFace& f : hull.face) area += vcg::DoubleArea(f) / 2;
    return area;
}

/// Whether \p hull is thick beside the distances of \p points, which a line or a sheet is not
bool is_thick(const HullMesh& hull, const std::vector<vcg::Point3f>& points) {
    double volume = 0;
    for (const HullFace& f : hull.face) volume += f.cP(0) * (f.cP(1) ^ f.cP(2)) / 6;
    return 6 * volume > kThinnest * mean_distance(points) * area_of(hull);  // as a cube has it
}

/// Whether no point lies deep inside of \p hull. O(points x faces).
bool holds_all(const HullMesh& hull, const std::vector<vcg::Point3f>& points) {
    const double deepest = kDeepest * std::sqrt(area_of(hull) / static_cast<double>(points.size()));
    return std::all_of(points.begin(), points.end(), [&](const vcg::Point3f& point) {
        const vcg::Point3d p = vcg::Point3d::Construct(point);
        double depth = std::numeric_limits<double>::infinity();
        for (const HullFace& f : hull.face) depth = std::min(depth, (f.cP(0) - p).dot(f.cN()));
        return depth <= deepest;
    });
}

/// A closed mesh, and for each of its vertices the point where it is.
struct Hull {
    IndexedMesh<float> mesh;
    std::vector<std::size_t> points;
};

/// Nothing if points lie inside of the hull.
std::optional<Hull> hull_of(const std::vector<vcg::Point3f>& points, bool thin_too) {
    constexpr const char* kIndex = "indexInput";  // by ComputeConvexHull()
    HullMesh cloud, hull;
    auto vertex = vcg::tri::Allocator<HullMesh>::AddVertices(cloud, points.size());
    for (const vcg::Point3f& p : points) (vertex++)->P().Import(p);
    const bool found =
        vcg::tri::ConvexHull<HullMesh, HullMesh>::ComputeConvexHull(cloud, hull, kHullRounding);
    vcg::tri::Allocator<HullMesh>::CompactEveryVector(hull);
    Hull result;
    auto index = vcg::tri::Allocator<HullMesh>::FindPerVertexAttribute<std::size_t>(hull, kIndex);
    for (const HullVertex& v : hull.vert) {
        result.points.push_back(index[vcg::tri::Index(hull, v)]);
        result.mesh.positions.push_back(points[result.points.back()]);
    }
    vcg::tri::Allocator<HullMesh>::DeletePerVertexAttribute(hull, kIndex);  // else it leaks
    const bool is_closed = hull.fn == 2 * hull.vn - 4;  // not where rounding misled quickhull
    if (!found || !is_closed || !(thin_too || is_thick(hull, points)) || !holds_all(hull, points)) return {};
    for (const HullFace& f : hull.face)
        result.mesh.faces.push_back({static_cast<int>(vcg::tri::Index(hull, f.cV(0))),
                                     static_cast<int>(vcg::tri::Index(hull, f.cV(1))),
                                     static_cast<int>(vcg::tri::Index(hull, f.cV(2)))});
    return result;
}

bool fits_a_network(const IndexedMesh<float>& mesh) {
    std::vector<int> valences(mesh.positions.size(), 0);
    for (const std::array<int, 3>& face : mesh.faces)
        for (const int v : face) ++valences[static_cast<std::size_t>(v)];
    return *std::max_element(valences.begin(), valences.end()) <= Ring::kMaxValence;
}

/// The hull with \p vertices vertices, the new ones \p where that says. \pre fits_a_network()
Hull finer(const Hull& hull, int vertices, NewVertices where) {
    Network network(hull.mesh.positions, hull.mesh.faces);
    const VertexPlaces before(network);
    NoProgress progress;
    flip_edges_for_shape(network, kFlat);
    refine(network, vertices, where, progress);
    flip_edges_for_shape(network, kFlat);
    const PerVertex<VertexId> sources = nearest_vertices(before, network);
    Hull result{{{}, network.faces()}, {}};
    for (const VertexId v : network.vertices()) {
        result.mesh.positions.push_back(network.position(v));
        result.points.push_back(hull.points[static_cast<std::size_t>(sources[v])]);
    }
    return result;
}

TargetSpace target_of(const Hull& hull, const TargetSpace& cloud) {
    const auto vertex = [&](std::size_t face, int k) {
        return static_cast<std::size_t>(hull.mesh.faces[face][static_cast<std::size_t>(k)]);
    };
    TargetSpace result = TargetSpace::triangles(hull.mesh.faces.size(), [&](std::size_t face, int k) {
        return cloud.frame().outside(hull.mesh.positions[vertex(face, k)]);
    });
    if (!cloud.has_colors()) return result;
    std::vector<Color> colors;
    for (std::size_t face = 0; face < hull.mesh.faces.size(); ++face)
        for (int k = 0; k < 3; ++k) colors.push_back(cloud.colors()[hull.points[vertex(face, k)]]);
    result.set_colors(std::move(colors));
    return result;
}

}  // namespace

std::optional<ConvexSurface> convex_surface(const TargetSpace& cloud, int vertices, bool thin_too) {
    const std::size_t points = cloud.positions().size();
    if (points > kMostPoints) return {};
    std::optional<Hull> hull = hull_of(cloud.positions(), thin_too);
    if (!hull) return {};
    const bool fits = fits_a_network(hull->mesh) && points <= static_cast<std::size_t>(vertices);
    // Points within the faces of the hull say that these are flat.
    const bool bends = hull->points.size() == points;
    if (fits) hull = finer(*hull, vertices, bends ? NewVertices::between : NewVertices::on_edges);
    ConvexSurface result{target_of(*hull, cloud), {}};
    if (!fits) return result;
    for (vcg::Point3f& p : hull->mesh.positions) p = result.target.frame().inside(cloud.frame().outside(p));
    result.mesh = std::move(hull->mesh);
    return result;
}

}  // namespace neuralmesh
