// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/shell/open_start.h"

#include <algorithm>
#include <locale>
#include <numeric>
#include <sstream>
#include <string>
#include <utility>

#include "vcg_core/mesh/boundary_loops.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/mesh/simplify.h"
#include "vcg_core/shell/facing.h"
#include "vcg_core/shell/one_layer_contour.h"
#include "vcg_core/shell/outliers.h"
#include "vcg_core/shell/start_points.h"
#include "vcg_core/shell/tangent_planes.h"

namespace neuralmesh {
namespace {

using vcg::Box3f;
using vcg::Point3f;

constexpr int kHighestValence = 12;  // leaves room for what the reduction and the learning add
/// The automatic bound for holes that are filled, in spacings of the planes; and what is filled in any case,
/// because it is a gap between points.
constexpr float kGapSpacings = 6, kLeastGapSpacings = 3;
/// Twice the width of a crack that is filled however long it is: the planes on its sides contradict each
/// other, but there are points on both.
constexpr float kCrackSpacings = 1.5F;
/// Planes as thick as this lie on no surface.
constexpr float kVolume = 0.6F;
constexpr double kMostWithoutSurface = 0.5;
/// So many links between planes contradict each other along a cut; fewer do at rough places.
constexpr std::size_t kManyContradictions = 20;

/// A part with fewer points than options.component_share counts if it is a sheet: of at least so many points
/// and planes, most of them thin. In a single view of 20,000 points a strip beside an occluded place has some
/// hundred, and islands seen by two views have 50; clumps of outliers have fewer planes.
constexpr int kPointsOfSheet = 40;
constexpr int kPlanesOfSheet = 20;
constexpr float kThinPart = 0.35F, kThinShare = 0.85F;
/// Noise makes all planes thick. Then thin is what is no thicker than so many times the median.
constexpr float kThinOfMedian = 2, kThickestThin = 0.55F;
/// The least share of the points that such a part may have, times the vertices asked for. It takes three of
/// them, so more small parts than that would leave none for the others.
constexpr double kLeastPartVertices = 0.3;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

void check(const OpenStartOptions& o) {
    if (o.wanted_vertices < 4 || o.target_vertices < 4 || o.samples < 4 ||
        !(o.component_share >= 0 && o.component_share < 1))
        throw SettingError(
            "The options of the open start mesh are out of range: at least 4 vertices and 4 samples are "
            "needed, and a component share in [0, 1).");
}

/// The points that a part needs, and a part that is a sheet of surface.
struct Enough {
    long long points, on_sheet;
};

Enough enough_points(std::size_t points, const OpenStartOptions& options) {
    const auto all = static_cast<double>(points);
    const auto share = static_cast<long long>(options.component_share * all);
    const auto carrying = static_cast<long long>(kLeastPartVertices * all / options.target_vertices);
    return {std::max<long long>(OpenStartOptions::kLeastPoints, share),
            std::max<long long>(kPointsOfSheet, carrying)};
}

int wanted_vertices(std::size_t points, const OpenStartOptions& options) {
    return std::min(options.wanted_vertices, static_cast<int>(points / OpenStartOptions::kPointsPerVertex));
}

/// \throws InputError if most planes are none
void check_for_surface(const TangentPlanes& planes) {
    long long all = 0, curve = 0, volume = 0;
    for (const TangentPlane& plane : planes.planes) {
        all += plane.points;
        if (plane.on_curve) {
            curve += plane.points;
        } else if (plane.thickness > kVolume) {
            volume += plane.points;
        }
    }
    const double share = kMostWithoutSurface * static_cast<double>(all);
    if (all == 0)
        throw InputError(
            "The cloud holds too few points for an open surface: choose surface 1 (closed), or add points.");
    if (static_cast<double>(curve) > share)
        throw InputError(
            "The points lie on curves, not on a surface: there is nothing to span an open surface over.");
    if (static_cast<double>(volume) > share)
        throw InputError(
            "The points are scattered in space, or too noisy beside their spacing: an open surface cannot be found. "
            "Choose surface 1 (closed), or remove the scattered points first.");
}

/// The parts of a mesh that hang together, by vertex, from 0.
struct Parts {
    PerVertex<int> of;
    int count = 0;
};

Parts parts_of(const IndexedMesh<float>& mesh) {
    const int n = static_cast<int>(mesh.positions.size());
    Parts parts{PerVertex<int>(n, -1), 0};
    PerVertex<VertexId> root(n);
    std::iota(root.begin(), root.end(), 0);
    const auto find = [&](VertexId v) {
        while (root[v] != v) v = root[v] = root[root[v]];
        return v;
    };
    for (const Triangle& f : mesh.faces)
        for (const VertexId v : {f[1], f[2]}) {
            const VertexId a = find(f[0]), b = find(v);
            root[std::max(a, b)] = std::min(a, b);
        }
    for (VertexId v = 0; v < n; ++v) parts.of[v] = find(v) == v ? parts.count++ : parts.of[find(v)];
    return parts;
}

/// A plane that no vertex of the contour lies on belongs to the part of one beside it.
void spread_parts(const TangentPlanes& planes, std::vector<int>& part_of_plane) {
    constexpr float kBeside = 3;  // spacings
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t i = 0; i < part_of_plane.size(); ++i)
            for (const int j : planes.around[i]) {
                if (j < 0 || (part_of_plane[i] < 0) == (part_of_plane[at(j)] < 0)) continue;
                const TangentPlane &a = planes.planes[i], &b = planes.planes[at(j)];
                if ((a.centre - b.centre).Norm() > kBeside * std::min(a.spacing, b.spacing)) continue;
                part_of_plane[i] = part_of_plane[at(j)] = std::max(part_of_plane[i], part_of_plane[at(j)]);
                changed = true;
            }
    }
}

/// Outliers lie in clumps; a piece of surface is thin, wide and spans many cells.
class PartsThatCount {
public:
    PartsThatCount(const TangentPlanes& planes, const std::vector<int>& part_of_plane, int parts,
                   const Enough& enough)
        : enough_(enough), sums_(at(parts)) {
        const float thin = std::clamp(kThinOfMedian * planes.thickness, kThinPart, kThickestThin);
        for (std::size_t i = 0; i < part_of_plane.size(); ++i) {
            if (part_of_plane[i] < 0) continue;
            Sum& sum = sums_[at(part_of_plane[i])];
            const TangentPlane& plane = planes.planes[i];
            sum.points += plane.points;
            ++sum.planes;
            sum.thin += plane.thickness < thin && !plane.on_curve ? 1 : 0;
        }
    }
    bool operator()(int part) const {
        const Sum& sum = sums_[at(part)];
        return sum.points >= enough_.points ||
               (sum.points >= enough_.on_sheet && sum.planes >= kPlanesOfSheet &&
                static_cast<float>(sum.thin) >= kThinShare * static_cast<float>(sum.planes));
    }

private:
    struct Sum {
        long long points = 0;
        int planes = 0;
        int thin = 0;
    };
    const Enough enough_;
    std::vector<Sum> sums_;
};

/// Drops the parts of \p contour that do not count. \return for every plane whether its points are in what is
/// kept
std::vector<char> drop_small_parts(Contour& contour, const TangentPlanes& planes, const Enough& enough) {
    IndexedMesh<float>& mesh = contour.mesh;
    const Parts parts = parts_of(mesh);
    std::vector<int> part_of_plane(planes.planes.size(), -1);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        part_of_plane[at(contour.plane[v])] = parts.of[static_cast<VertexId>(v)];
    spread_parts(planes, part_of_plane);
    const PartsThatCount counts(planes, part_of_plane, parts.count, enough);
    // Crumbs beside a part that is kept are its fringe.
    for (int& part : part_of_plane)
        if (part >= 0 && !counts(part)) part = -1;
    spread_parts(planes, part_of_plane);
    std::vector<char> kept(part_of_plane.size(), 0);
    for (std::size_t i = 0; i < kept.size(); ++i) kept[i] = part_of_plane[i] >= 0 ? 1 : 0;
    std::vector<Triangle> faces;
    for (const Triangle& f : mesh.faces)
        if (counts(parts.of[f[0]])) faces.push_back(f);
    mesh.faces = std::move(faces);
    return kept;
}

void drop_unused_vertices(Contour& contour) {
    IndexedMesh<float>& mesh = contour.mesh;
    std::vector<VertexId> moved(mesh.positions.size(), -1);
    for (const Triangle& f : mesh.faces)
        for (const VertexId v : f) moved[at(v)] = 0;
    VertexId count = 0;
    for (std::size_t v = 0; v < moved.size(); ++v) {
        if (moved[v] < 0) continue;
        mesh.positions[at(count)] = mesh.positions[v];
        contour.plane[at(count)] = contour.plane[v];
        moved[v] = count++;
    }
    mesh.positions.resize(at(count));
    contour.plane.resize(at(count));
    for (Triangle& f : mesh.faces)
        for (VertexId& v : f) v = moved[at(v)];
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

/// Fills holes up to options.close_holes_up_to, or where that is negative, up to kGapSpacings spacings of the
/// planes around; cracks, which are long but narrow; and all, if none that is left is wider than
/// options.closed_up_to.
void fill_small_holes(Contour& contour, const TangentPlanes& planes, const OpenStartOptions& options,
                      OpenStart& result) {
    IndexedMesh<float>& mesh = contour.mesh;
    const auto loops = boundary_loops(static_cast<int>(mesh.positions.size()), mesh.faces);
    HoleFiller filler(mesh, loops, kHighestValence);
    std::vector<const std::vector<VertexId>*> left;
    double widest = 0;
    for (const std::vector<VertexId>& loop : loops) {
        float spacing = 0;
        for (const VertexId v : loop)
            spacing += planes.planes[at(contour.plane[at(v)])].spacing / static_cast<float>(loop.size());
        const double gap = static_cast<double>(kLeastGapSpacings * spacing);
        const double most = options.close_holes_up_to >= 0 ? std::max(options.close_holes_up_to, gap)
                                                           : static_cast<double>(kGapSpacings * spacing);
        const double diameter = diameter_of(loop, mesh.positions);
        if (diameter <= most && filler.fill(loop)) {
            result.widest_filled = std::max(result.widest_filled, diameter);
        } else if (!filler.fill(loop, kCrackSpacings * spacing)) {
            left.push_back(&loop);
            widest = std::max(widest, diameter);
        }
    }
    result.widest_loop = widest / diagonal_of(mesh.positions);
    if (result.widest_loop > options.closed_up_to) return;
    for (const auto* loop : left)
        if (filler.fill(*loop)) result.widest_filled = std::max(result.widest_filled, widest);
}

IndexedMesh<float> indexed(const Network& network) {
    IndexedMesh<float> mesh;
    for (VertexId v = 0; v < network.slot_count(); ++v) mesh.positions.push_back(network.position(v));
    mesh.faces = network.faces();
    return mesh;
}

/// The points outside of the lattice, or of planes that were dropped.
std::vector<std::uint8_t> outliers_of(const TangentPlanes& planes, const std::vector<char>& kept) {
    std::vector<std::uint8_t> result;
    for (std::size_t i = 0; i < planes.cell_of.size(); ++i) {
        const int cell = planes.cell_of[i];
        if (cell >= 0 && kept[at(cell)] != 0) continue;
        result.resize(planes.cell_of.size(), 0);
        result[i] = 1;
    }
    return result;
}

/// Decides about the outliers, too: too many of them are none.
void set_outliers(std::vector<std::uint8_t> outliers, long long points, long long least, bool learn,
                  OpenStart& result) {
    const long long ignored = std::count(outliers.begin(), outliers.end(), 1);
    const bool too_many =
        static_cast<double>(ignored) > OpenStartOptions::kMostOutliers * static_cast<double>(points);
    if (!learn && !too_many) result.outliers = std::move(outliers);
    const std::string sentence = warning_of_outliers(ignored, points, least, result.outliers.empty());
    if (!sentence.empty()) result.warnings.push_back(sentence);
}

void warn_of_cuts(const TargetSpace& target, const TangentPlanes& planes, OpenStart& result) {
    if (planes.contradictions.size() < kManyContradictions) return;
    Point3f middle(0, 0, 0);
    for (const Point3f& p : planes.contradictions)
        middle += p / static_cast<float>(planes.contradictions.size());
    const auto nearest = std::min_element(planes.contradictions.begin(), planes.contradictions.end(),
                                          [&](const Point3f& a, const Point3f& b) {
                                              return (a - middle).SquaredNorm() < (b - middle).SquaredNorm();
                                          });
    const vcg::Point3d where = target.frame().outside(*nearest);
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text.precision(6);
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

/// Number of vertices that \p network can be reduced to, or \p wanted if that is more.
int fewest_vertices(Network network, int wanted) {
    if (network.vertex_count() > wanted) simplify(network, wanted);
    return network.vertex_count();
}

/// Copies the mesh and its topology to \p result.
void write_mesh(const Network& network, OpenStart& result) {
    IndexedMesh<float> mesh = indexed(network);
    result.components = network.component_count();
    result.genus = network.genus();
    result.loops = network.boundary_loop_count();
    result.positions = std::move(mesh.positions);
    result.faces = std::move(mesh.faces);
}

}  // namespace

OpenStart open_start(const TargetSpace& target, const OpenStartOptions& options, Random& random,
                     Progress& progress) {
    check(options);
    progress(0.0, "Start mesh: fitting planes to the cloud");
    const StartPoints start_points(target, options.samples, random);
    const std::vector<Point3f>& points = start_points.all();
    check_enough_points(points.size());
    const Box3f box = main_box(points);
    const TangentPlanes planes = tangent_planes(points, box, TangentPlaneOptions());
    check_for_surface(planes);

    progress(0.5, "Start mesh: building an open mesh");
    Contour contour = one_layer_contour(box, planes);
    const Enough enough = enough_points(points.size(), options);
    const std::vector<char> kept = drop_small_parts(contour, planes, enough);
    drop_unused_vertices(contour);
    if (contour.mesh.faces.empty())
        throw InputError(
            "No part of the cloud holds enough points for an open surface: choose surface 1 (closed), or add "
            "points.");
    OpenStart result;
    fill_small_holes(contour, planes, options, result);

    progress(0.8, "Start mesh: reducing it");
    Network network(contour.mesh.positions, contour.mesh.faces);
    simplify(network, wanted_vertices(points.size(), options));
    network.compact();
    orient_convex_side_outward(network);
    if (options.use_normals) result.faced_by_normals = orient_by_normals(network, target);
    write_mesh(network, result);
    result.fewest_vertices = fewest_vertices(std::move(network), options.target_vertices);
    result.thickness = static_cast<double>(planes.thickness);
    result.spacing = static_cast<double>(planes.step);
    result.layers = layer_figures(points, planes);
    set_outliers(outliers_of(planes, kept), static_cast<long long>(points.size()), enough.points,
                 options.learn_outliers || target.is_exact(), result);
    warn_of_cuts(target, planes, result);
    progress(1.0, "Start mesh: done");
    return result;
}

}  // namespace neuralmesh
