// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/start/shell.h"

#include <vcg/space/box3.h>
#include <vcg/space/point3.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "vcg_core/base/ablation.h"
#include "vcg_core/base/error.h"
#include "vcg_core/base/even_mesh.h"
#include "vcg_core/base/text.h"
#include "vcg_core/base/thread_team.h"
#include "vcg_core/cloud/opposite_layers.h"
#include "vcg_core/cloud/surface_survey.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/mesh/simplify.h"
#include "vcg_core/mesh/triangle.h"
#include "vcg_core/start/closed_mesh.h"
#include "vcg_core/start/lattice_survey.h"
#include "vcg_core/start/local_width.h"
#include "vcg_core/start/region.h"

namespace neuralmesh {
namespace {

using vcg::Box3f;
using vcg::Point3f;

// Enough for a component or handle to keep its shape.
constexpr int kVerticesPerFeature = 8;
/// The points do not tell where more vertices of a start mesh are.
constexpr double kPointsPerVertex = 8;
/// Fewer additional vertices than a quarter come from the noise of the lattice.
constexpr double kWorthwhile = 1.25;
/// Edges are this much shorter than walls and gaps are wide. With 1 some vertices land on the wrong side,
/// with 0.6 no fewer than with this (ablation.py).
constexpr double kEdgeOverWidth = 0.75;
/// Walls thinner than this, in edges of an even mesh of as many vertices as asked for, are learned thicker.
constexpr double kThickEdges = 1.5;
/// Points are the two sides of walls where so many of them are on thin ones: with walls of 4 to 7 spacings
/// .67 at least (ablation.py), on depth frames and aerial scans .14 at most.
constexpr double kWalled = 0.35;
/// The share of the places on thin walls that show it, at the least.
constexpr double kWallsFound = 0.67;
// A warning is due from here on, in steps of the first lattice and of the chosen one. Gaps between points are
// narrower.
constexpr double kWide = 4;

double area_around(const Network& network, VertexId v) {
    const Ring& ring = network.ring(v);
    double sum = 0;
    for (int i = 0; i < ring.face_count(); ++i)
        sum += static_cast<double>(
            area_vector(network.position(v), network.position(ring[i]), network.position(ring.next(i)))
                .Norm());
    return sum / 6;  // a third of each face, whose area vector is twice as long as its area
}

void copy_mesh(Network& network, IndexedMesh<float>& mesh) {
    network.compact();
    for (const VertexId v : network.vertices()) mesh.positions.push_back(network.position(v));
    mesh.faces = network.faces();
}

WallSides wall_sides(const Network& shell, const LocalWidths& widths, float thick) {
    WallSides result;
    bool any = false;
    for (const VertexId v : shell.vertices()) {
        result.thickenings.push_back(widths.thickening(v, thick));
        any = any || result.thickenings.back() > 0;
    }
    if (!any || skips("thickening")) return {};
    Network compacted = shell;
    copy_mesh(compacted, result);
    return result;
}

constexpr const char* kReducing = "Start mesh: reducing it";

/// Reduces \p closed to \p vertices vertices, or to more, up to \p most, where the surface is close to
/// itself. \return StartMesh::walls for a mesh of \p final_vertices vertices
WallSides reduce(ClosedMesh& closed, const Region& region, int vertices, double most, int final_vertices,
                 Progress& progress) {
    Network& network = closed.network;
    PerVertex<double> areas(network.slot_count(), 0);
    double area = 0;
    for (const VertexId v : network.vertices()) area += areas[v] = area_around(network, v);
    const auto even_edge = [area](int count) { return std::sqrt(area / (kAreaPerVertex * count)); };
    const auto widest = static_cast<float>(even_edge(vertices) / kEdgeOverWidth);
    const auto thick = static_cast<float>(kThickEdges * even_edge(final_vertices));
    const float radius = region.lattice.step * closed.radius();
    const LocalWidths widths(network, region.lattice, closed.solid, radius,
                             std::max(widest, LocalWidths::farthest_for(thick, radius)));
    PerVertex<float> lengths(network.slot_count(), 0);
    double needed = 0;  // vertices of a mesh of edges of these lengths
    for (const VertexId v : network.vertices()) {
        lengths[v] = widths.width(v, widest) * static_cast<float>(kEdgeOverWidth);
        const auto length = static_cast<double>(lengths[v]);
        needed += areas[v] / (kAreaPerVertex * length * length);
    }
    const int wanted = static_cast<int>(std::min(needed, most));
    if (!(wanted > kWorthwhile * vertices)) {
        simplify(network, vertices);
        return {};
    }
    progress(0.86, kReducing);
    WallSides walls = wall_sides(network, widths, thick);
    simplify(network, wanted, lengths);
    return walls;
}

/// Reduces the mesh of \p closed and puts it into \p result, with its topology. \p points: their number.
void set_mesh(ClosedMesh& closed, const Region& region, std::size_t points, const ShellOptions& options,
              Progress& progress, StartMesh& result) {
    progress(0.8, kReducing);
    Network& network = closed.network;
    result.components = network.component_count();
    result.genus = network.genus();
    result.fewest_vertices = kVerticesPerFeature * (result.components + result.genus);
    // Few points do not tell where more vertices are, and would not bring them down to the surface.
    const auto carried = static_cast<int>(
        std::min(points / kPointsPerCarried, static_cast<std::size_t>(options.max_vertices)));
    const int budget = std::min(carried, options.target_vertices / 4);
    const int vertices = std::max(budget, result.fewest_vertices);
    const double told = static_cast<double>(points) / kPointsPerVertex;
    const double most = std::min(told, static_cast<double>(options.most_vertices));
    // A sheet is nowhere far from itself.
    if (result.encloses_space && most > kWorthwhile * vertices && !skips("finer_start")) {
        result.walls = reduce(closed, region, vertices, most, options.target_vertices, progress);
    } else {
        simplify(network, vertices);
    }
    copy_mesh(network, result);
}

/// Of \p places those where the points show a surface. In closed models limbs as thin as the points are apart
/// have no enclosed space beside them, and are no sheet: nothing is seen there.
std::vector<LayerPlace> orderly(const std::vector<LayerPlace>& places, Surveys& surveys) {
    const SurfaceSurvey& survey = surveys.surface();
    std::vector<LayerPlace> result;
    for (const LayerPlace& place : places)
        if (!survey.at(place.position).clutter) result.push_back(place);
    return result;
}

Enclosure enclosure_of(const LatticeSurvey& survey, const std::vector<LayerPlace>& places, Surveys& surveys) {
    Enclosure result;
    result.encloses_space = survey.region.encloses_space;
    const ThinParts thin = thin_parts(survey.region, places);
    result.sheet_share = thin.share;
    result.widest_opening = survey.region.widest_opening;
    // Where the lattice shows no space, the points may lie on the two sides of walls too thin for it.
    if ((result.encloses_space && result.sheet_share <= kMostSheet) || skips("walled")) return result;
    result.walled = share_on_thin_walls(places, surveys) > kWalled;
    result.encloses_space |= result.walled;
    if (thin.places.empty()) return result;
    // A body may have thin parts beside openings: what is left is a sheet.
    const std::vector<LayerPlace> orderly_places = orderly(thin.places, surveys);
    const double walls = share_on_thin_walls(orderly_places, surveys) / kWallsFound;
    result.sheet_share *= std::max(0.0, 1 - walls) * static_cast<double>(orderly_places.size()) /
                          static_cast<double>(thin.places.size());
    return result;
}

void set_outliers(const std::vector<Point3f>& points, const Region& region, const ClosedMesh& closed,
                  bool learn_outliers, StartMesh& result) {
    if (skips("lattice_outliers")) return;
    result.outliers = outliers_of(points, region, closed.solid);
    result.ignored_points = std::count(result.outliers.begin(), result.outliers.end(), 1);
    const double most = ShellOptions::kMaxOutlierShare * static_cast<double>(points.size());
    if (learn_outliers || static_cast<double>(result.ignored_points) > most) result.outliers.clear();
}

void warn_of_outliers(std::size_t all, const Region& region, StartMesh& result) {
    if (result.ignored_points == 0) return;
    result.warnings.push_back(std::to_string(result.ignored_points) + " of " + std::to_string(all) +
                              " points were ignored as outliers" +
                              (result.outliers.empty() ? " by the start mesh, but are learned" : "") +
                              ": they lie in isolated groups of fewer than " +
                              std::to_string(region.min_points) + " points.");
}

void warn_of_uncertain_topology(const LatticeSurvey& survey, int level, StartMesh& result) {
    const double step = static_cast<double>(survey.region.lattice.step),
                 first = static_cast<double>(survey.step);
    const bool coarser = step > first || step * std::sqrt(static_cast<double>(level)) > kWide * first;
    if (coarser)
        result.warnings.push_back(
            "The cloud is too sparse or too noisy for a start mesh at full resolution. A coarser one was made, which may miss thin gaps and small handles.");
    if (!survey.vote.found || result.confidence < kLowConfidence)
        result.warnings.push_back(
            "The number of components and handles is uncertain, because it changes with the resolution. The start mesh has " +
            std::to_string(result.components) + " component(s) and genus " + std::to_string(result.genus) +
            " in total. Parts of the surface may be closer to each other than neighbouring points.");
}

void warn_of_open_surface(const Lattice& lattice, StartMesh& result) {
    if (!result.encloses_space)
        result.warnings.push_back(
            "The points enclose no space wider than the gaps between them, as in a single scan, a sheet or a thin wall. The surface was closed around both of their sides. Choose surface 2 (open) for one layer that ends where the points end.");
    if (result.widest_opening > kWide * static_cast<double>(lattice.step))
        result.warnings.push_back(
            "The cloud is open: holes up to " + percent(2 * result.widest_opening) +
            " of the bounding-box diagonal wide were closed. Choose surface 2 (open) to keep those that are much wider than the gaps between the points.");
}

}  // namespace

Shell::Shell(const std::vector<Point3f>& points, Surveys& surveys, const ShellOptions& options,
             Progress& progress)
    : points_(points), options_(options) {
    progress(0.0, "Start mesh: measuring the density of the cloud");
    Box3f box;
    for (const Point3f& p : points) box.Add(p);
    progress(0.2, "Start mesh: counting components and handles");
    ThreadTeam team(thread_count(options.threads));
    const std::vector<LayerPlace> places = layer_places(surveys.points().cloud, team);
    PartOf counting(progress, 0.2, 0.7);
    survey_ = survey_lattices(points, places, box, team, counting);
    enclosure_ = enclosure_of(survey_, places, surveys);
}

StartMesh Shell::mesh(Progress& progress) const {
    progress(0.7, "Start mesh: building the mesh");
    const Region& region = survey_.region;
    ClosedMesh closed = closed_mesh(region, survey_.vote);
    if (closed.network.vertex_count() == 0)
        throw InputError(
            "No part of the cloud holds enough points for a start mesh around it. Choose the tetrahedron as start mesh, or remove scattered points first.");
    StartMesh result;
    static_cast<Enclosure&>(result) = enclosure_;
    set_mesh(closed, region, points_.size(), options_, progress, result);
    progress(0.9, "Start mesh: measuring it");
    result.confidence = survey_.vote.confidence;
    set_outliers(points_, region, closed, options_.learn_outliers, result);
    warn_of_uncertain_topology(survey_, closed.level, result);
    warn_of_open_surface(region.lattice, result);
    warn_of_outliers(points_.size(), region, result);
    progress(1.0, "Start mesh: done");
    return result;
}

}  // namespace neuralmesh
