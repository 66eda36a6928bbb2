// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/start/open_start.h"

#include <algorithm>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "vcg_core/base/disjoint_sets.h"
#include "vcg_core/base/indexed.h"
#include "vcg_core/base/parallel_for.h"
#include "vcg_core/base/text.h"
#include "vcg_core/mesh/boundary_loops.h"
#include "vcg_core/mesh/flips.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/mesh/non_manifold_vertices.h"
#include "vcg_core/mesh/simplify.h"
#include "vcg_core/mesh/triangle.h"
#include "vcg_core/start/consolidated_points.h"
#include "vcg_core/start/orientation.h"
#include "vcg_core/start/point_triangulation.h"
#include "vcg_core/start/short_handles.h"
#include "vcg_core/start/viewpoint.h"

namespace neuralmesh {
namespace {

using vcg::Box3f;
using vcg::Point3f;

/// The automatic bound for holes that are filled, in radii of the points around; and what is filled in any
/// case, because it is a gap between points.
constexpr float kGapRadii = 6, kLeastGapRadii = 4;
/// A cloud with a larger share of curves is no surface; nor is one with a larger share of clutter, if the
/// mesh leaves out such a share of its points, too. A depth frame of an office has .51 of clutter, and the
/// mesh leaves out .04; two cars scanned from the road have .52 and .28, shrubs .69 and .56.
constexpr double kMostWithoutSurface = 0.5;
/// So many links between points contradict each other along a cut; fewer do at rough places.
constexpr std::size_t kManyContradictions = 20;
/// Fewer consolidated points do not show what the surface is like: bays of its boundary, parts beside it.
constexpr int kFewestConsolidated = 15000;
/// Handles around or through which a loop of so many edges leads are chance: a tube of six edges is hardly
/// one.
constexpr int kEdgesOfHandle = 8;
/// Of start meshes of aerial surveys up to .011 of the area is turned away from above, of a tree .22. Models
/// seen from a sensor have .03 to .04, which are right: its place is known within a tenth of the diagonal.
constexpr double kMostAway = 0.02;
/// Scans miss up to .03 of their points, slabs as thick as their points are apart .09 and .16; a tree misses
/// .14, and has .35 of clutter, which is not sharply told from its surface.
constexpr double kMostMissed = 0.05;

/// The points that a part has at least. In a single view of 20,000 points a strip beside an occluded place
/// has some hundred, and islands seen by two views have 50; clumps of outliers have no faces.
constexpr int kPointsOfPart = 40;
/// Their least share of all points, times the vertices asked for. A part takes three of them, so more small
/// parts than that would leave none for the others.
constexpr double kLeastPartVertices = 0.3;

/// \throws NoSurfaceError if most places lie on curves
void check_for_curves(const SurfaceSurvey& survey) {
    if (survey.curves() > kMostWithoutSurface)
        throw NoSurfaceError(
            "The points lie on curves, not on a surface: there is nothing to span an open surface over. "
            "Choose surface 1 (closed) for a skin around them.");
}

/// \param left_out share of the points that belong to nothing of the mesh
/// \throws NoSurfaceError if most places show no surface, and most points are on none
void check_for_surface(const SurfaceSurvey& survey, double left_out) {
    if (std::min(survey.clutter(), left_out) > kMostWithoutSurface)
        throw NoSurfaceError(
            "The points are scattered in space, or too noisy beside their spacing: an open surface cannot be found. "
            "Choose surface 1 (closed), or remove the scattered points first.");
}

/// The surface while it is put together.
struct Sheet {
    IndexedMesh<float> mesh;
    std::vector<int> source;  ///< of each vertex its point
    ConsolidatedPoints points;
    std::vector<Point3f> contradictions;  ///< where its two sides could not be told apart
    std::optional<Point3f> viewer;        ///< see turn_to_viewer()

    float radius(VertexId v) const { return points.radii[at(source[at(v)])]; }
};

std::vector<std::pair<int, int>> neighbours_of(const ConsolidatedPoints& points) {
    const NearestPoints index(points.positions);
    std::vector<std::pair<int, int>> pairs;
    std::vector<NearestPoints::Neighbour> near;
    for (NearestPoints::Place place = 0; place < index.size(); ++place) {
        const std::size_t own = index.index(place);
        index.nearest(place, kTwoRings, near);
        for (const NearestPoints::Neighbour& n : near)
            if (n.squared_distance < kStarReach * kStarReach * points.radii[own] * points.radii[own])
                pairs.emplace_back(static_cast<int>(own), static_cast<int>(index.index(n.place)));
    }
    return pairs;
}

/// \param origin of the input
/// \param sensor see sensor_place()
Sheet sheet_of(ConsolidatedPoints points, const Point3f& origin, const std::optional<Point3f>& sensor,
               ThreadTeam& team) {
    Sheet sheet;
    const std::vector<std::pair<int, int>> neighbours = neighbours_of(points);
    Orientation orientation = orient_normals(points.positions, neighbours, {}, points.normals);
    sheet.contradictions = std::move(orientation.contradictions);
    sheet.viewer = turn_to_viewer(neighbours, orientation.parts, origin, sensor, points);
    sheet.mesh = triangulation(points.positions, points.normals, points.radii, team, sheet.source);
    cut_short_handles(sheet.mesh, kEdgesOfHandle, sheet.source);
    sheet.points = std::move(points);
    return sheet;
}

/// The vertex of \p sheet that each point of the cloud belongs to, by place; -1: none. Clutter belongs to one
/// only where it is as close as the noise there.
std::vector<VertexId> vertices_of_points(Surveys& surveys, const Sheet& sheet, ThreadTeam& team) {
    const NearestPoints& cloud = surveys.points().cloud;
    const SurfaceSurvey& survey = surveys.surface();
    constexpr int kAtATime = 1024;
    std::vector<VertexId> vertices(cloud.size(), -1);
    if (sheet.mesh.positions.empty()) return vertices;
    const NearestPoints index(sheet.mesh.positions);
    parallel_for(static_cast<int>(cloud.size()), kAtATime, team, [&](int i) {
        const Point3f& p = cloud.point(static_cast<NearestPoints::Place>(i));
        const std::size_t nearest = index.index(index.nearest_to(p));
        const std::size_t source = at(sheet.source[nearest]);
        const Point3f way = p - sheet.mesh.positions[nearest];
        if (way.Norm() > kStarReach * sheet.points.radii[source]) return;
        if (survey.at(p).clutter &&
            std::abs(way * sheet.points.normals[source]) > sheet.points.tolerances[source])
            return;
        vertices[at(i)] = static_cast<VertexId>(nearest);
    });
    return vertices;
}

/// The vertices of the parts that hang together.
DisjointSets parts_of(const IndexedMesh<float>& mesh) {
    DisjointSets parts(static_cast<int>(mesh.positions.size()));
    for (const Triangle& f : mesh.faces) {
        parts.join(f[0], f[1]);
        parts.join(f[0], f[2]);
    }
    return parts;
}

/// Drops the parts of \p sheet that have too few points, and those not wider than the usual radius: however
/// many points they have, such as repeated readings, they are one place beside the rest. Sets
/// result.misses_surface, and result.outliers to the points that belong to nothing that is kept, and
/// result.left_out to their share.
void drop_small_parts(Surveys& surveys, int target_vertices, ThreadTeam& team, Sheet& sheet,
                      OpenStart& result) {
    IndexedMesh<float>& mesh = sheet.mesh;
    const NearestPoints& cloud = surveys.points().cloud;
    const SurfaceSurvey& survey = surveys.surface();
    const double carrying = kLeastPartVertices * static_cast<double>(cloud.size()) / target_vertices;
    const long long least = std::max<long long>(kPointsOfPart, static_cast<long long>(carrying));
    DisjointSets parts = parts_of(mesh);
    const std::vector<VertexId> vertices = vertices_of_points(surveys, sheet, team);
    std::vector<long long> points(mesh.positions.size(), 0);  // of each part, by its find()
    std::vector<Box3f> boxes(points.size());
    const double narrow = survey.usual_radius();
    for (const VertexId v : vertices)
        if (v >= 0) ++points[at(parts.find(v))];
    for (std::size_t v = 0; v < boxes.size(); ++v)
        boxes[at(parts.find(static_cast<VertexId>(v)))].Add(mesh.positions[v]);
    const auto has_few = [&](VertexId v) { return points[at(parts.find(v))] < least; };
    const auto is_dropped = [&](VertexId v) {
        return has_few(v) || static_cast<double>(boxes[at(parts.find(v))].Diag()) <= narrow;
    };
    std::size_t missed = 0, left_out = 0;
    result.outliers.assign(cloud.size(), 0);
    for (NearestPoints::Place place = 0; place < cloud.size(); ++place) {
        const VertexId v = vertices[place];
        if (v < 0 || is_dropped(v)) {
            result.outliers[cloud.index(place)] = 1;
            ++left_out;
        }
        if ((v < 0 || has_few(v)) && !survey.at(cloud.point(place)).clutter) ++missed;
    }
    const auto all = static_cast<double>(cloud.size());
    result.left_out = static_cast<double>(left_out) / all;
    result.misses_surface = static_cast<double>(missed) / all > std::max(kMostMissed, survey.clutter());
    mesh.faces.erase(std::remove_if(mesh.faces.begin(), mesh.faces.end(),
                                    [&](const Triangle& f) { return is_dropped(f[0]); }),
                     mesh.faces.end());
    drop_unused_vertices(mesh, sheet.source);
}

double diameter_of(const std::vector<VertexId>& loop, const std::vector<Point3f>& positions) {
    std::vector<Point3f> points;
    for (const VertexId v : loop) points.push_back(positions[at(v)]);
    return static_cast<double>(smallest_sphere_diameter(points));
}

double diagonal_of(const std::vector<Point3f>& positions) {
    Box3f box;
    for (const Point3f& p : positions) box.Add(p);
    return static_cast<double>(box.Diag());
}

/// Whether \p loop ends its part of \p mesh, rather than leaves a hole in it: less of the part faces where
/// what fills it would face than is missing there. A sheet, or half a sphere, has nothing that does; a sphere
/// with a small hole has its half.
bool ends_its_part(const IndexedMesh<float>& mesh, const std::vector<VertexId>& loop, DisjointSets& parts) {
    const auto position = [&](VertexId v) { return mesh.positions[at(v)]; };
    const Point3f from = position(loop.front());
    Point3f missing(0, 0, 0);  // twice the area vector of what fills it
    for (std::size_t i = 1; i + 1 < loop.size(); ++i)
        missing += area_vector(from, position(loop[i + 1]), position(loop[i]));
    const auto enough = static_cast<double>(missing.SquaredNorm());
    const auto part = parts.find(loop.front());
    double facing = 0;
    for (const Triangle& f : mesh.faces) {
        if (parts.find(f[0]) != part) continue;
        const Point3f area = area_vector(position(f[0]), position(f[1]), position(f[2]));
        facing += std::max(0.0, static_cast<double>(missing * area));
        if (facing >= enough) return false;
    }
    return true;
}

/// Fills holes up to options.close_holes_up_to, or where that is negative, up to kGapRadii radii if it does
/// not end a part; and all, if none that is left is wider than options.closed_up_to.
void fill_small_holes(Sheet& sheet, const OpenStartOptions& options, OpenStart& result) {
    IndexedMesh<float>& mesh = sheet.mesh;
    const auto loops = boundary_loops(static_cast<int>(mesh.positions.size()), mesh.faces);
    HoleFiller filler(mesh, loops, kHighestValence);
    DisjointSets parts = parts_of(mesh);
    std::vector<const std::vector<VertexId>*> left;
    double widest = 0;
    for (const std::vector<VertexId>& loop : loops) {
        float radius = 0;
        for (const VertexId v : loop) radius += sheet.radius(v) / static_cast<float>(loop.size());
        const double gap = static_cast<double>(kLeastGapRadii * radius);
        const double most = options.close_holes_up_to >= 0 ? std::max(options.close_holes_up_to, gap)
                                                           : static_cast<double>(kGapRadii * radius);
        const double diameter = diameter_of(loop, mesh.positions);
        const bool is_hole =
            diameter <= most && (options.close_holes_up_to >= 0 || !ends_its_part(mesh, loop, parts));
        if (is_hole && filler.fill(loop)) continue;
        left.push_back(&loop);
        // Half a radius of surface, on both sides, is beyond the last vertices.
        widest = std::max(widest, diameter - static_cast<double>(radius));
    }
    result.widest_loop = widest / diagonal_of(mesh.positions);
    if (result.widest_loop > options.closed_up_to) return;
    for (const auto* loop : left) filler.fill(*loop);
}

/// Says how many outliers there are. \param learn they are not to be left out
void warn_of_outliers(bool learn, OpenStart& result) {
    const std::size_t all = result.outliers.size();
    const auto ignored =
        static_cast<std::size_t>(std::count(result.outliers.begin(), result.outliers.end(), 1));
    if (learn || ignored == 0) result.outliers.clear();
    if (ignored == 0) return;
    result.warnings.push_back(
        share_of_points(ignored, all) +
        " show no surface, as leaves, points between two depths, or small groups do: " +
        (learn ? "the start mesh leaves them out, but they are learned." : "they were left out."));
}

void warn_of_cuts(const TargetSpace& target, const std::vector<Point3f>& contradictions, OpenStart& result) {
    if (contradictions.size() < kManyContradictions) return;
    Point3f middle(0, 0, 0);
    for (const Point3f& p : contradictions) middle += p / static_cast<float>(contradictions.size());
    const auto nearest = std::min_element(contradictions.begin(), contradictions.end(),
                                          [&](const Point3f& a, const Point3f& b) {
                                              return (a - middle).SquaredNorm() < (b - middle).SquaredNorm();
                                          });
    const vcg::Point3d where = target.frame().outside(*nearest);
    std::ostringstream text = stream_with(6);
    text << "The surface has places where its two sides cannot be told apart, as on a Moebius strip: it was "
            "cut there, near ("
         << where[0] << ", " << where[1] << ", " << where[2] << ").";
    result.warnings.push_back(text.str());
}

void check_enough_points(std::size_t points) {
    if (points < static_cast<std::size_t>(OpenStartOptions::kLeastCloud))
        throw InputError("The cloud has " + std::to_string(points) +
                         " points, too few to show where a surface ends: choose surface 1 (closed), or give "
                         "at least " +
                         std::to_string(OpenStartOptions::kLeastCloud) + ".");
}

void check_for_part(bool found) {
    if (found) return;
    throw InputError(
        "No part of the cloud holds enough points for an open surface: choose surface 1 (closed), or add "
        "points.");
}

/// Number of vertices that \p network can be reduced to, or \p wanted if that is more.
int fewest_vertices(Network network, int wanted) {
    if (network.vertex_count() > wanted) simplify(network, wanted);
    return network.vertex_count();
}

/// Turns the parts of \p network, which faces \p viewer if there is one.
void turn_parts(const std::optional<Point3f>& viewer, const TargetSpace& target, bool use_normals,
                Network& network, OpenStart& result) {
    if (!viewer) orient_convex_side_outward(network);
    if (use_normals) result.faced_by_normals = orient_by_normals(network, target);
    if (is_above(viewer) && share_turned_away(network, *viewer) < kMostAway) result.viewer = viewer;
}

/// Copies the mesh and its topology to \p result.
void write_mesh(const Network& network, OpenStart& result) {
    for (const VertexId v : network.vertices()) result.positions.push_back(network.position(v));
    result.faces = network.faces();
    result.components = network.component_count();
    result.genus = network.genus();
    result.loops = network.boundary_loop_count();
}

}  // namespace

OpenStart open_start(const TargetSpace& target, const std::vector<Point3f>& points, Surveys& surveys,
                     const OpenStartOptions& options, Random& random, Progress& progress) {
    progress(0.0, "Start mesh: surveying the cloud");
    check_enough_points(points.size());
    ThreadTeam team(thread_count(options.threads));
    const SurfaceSurvey& surface = surveys.surface();
    check_for_curves(surface);

    progress(0.3, "Start mesh: thinning the cloud");
    const int wanted = std::min(options.wanted_vertices,
                                static_cast<int>(points.size() / OpenStartOptions::kPointsPerVertex));
    ConsolidatedPoints consolidated = consolidated_points(
        surveys.points().cloud, surface, std::max(wanted, kFewestConsolidated), random, team);
    if (consolidated.positions.empty()) check_for_surface(surface, 1);
    check_for_part(!consolidated.positions.empty());
    progress(0.6, "Start mesh: building an open mesh");
    Sheet sheet = sheet_of(std::move(consolidated), target.frame().inside({0, 0, 0}),
                           sensor_place(surveys.points().cloud, surface.places()), team);
    OpenStart result;
    drop_small_parts(surveys, options.target_vertices, team, sheet, result);
    check_for_surface(surface, result.left_out);
    check_for_part(!sheet.mesh.faces.empty());
    fill_small_holes(sheet, options, result);

    progress(0.8, "Start mesh: reducing it");
    Network network(sheet.mesh.positions, sheet.mesh.faces);
    simplify(network, wanted);
    network.compact();
    turn_parts(sheet.viewer, target, options.use_normals, network, result);
    write_mesh(network, result);
    result.fewest_vertices = fewest_vertices(std::move(network), options.target_vertices);
    result.radius = std::max(surface.sparse_radius(), surface.usual_radius());
    result.layers = surface.layers();
    warn_of_outliers(options.learn_outliers, result);
    warn_of_cuts(target, sheet.contradictions, result);
    progress(1.0, "Start mesh: done");
    return result;
}

}  // namespace neuralmesh
