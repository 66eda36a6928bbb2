// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Lattices, votes and the mesh of the winner.
#include "vcg_core/shell/shell.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "vcg_core/base/parallel_for.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/mesh/simplify.h"
#include "vcg_core/shell/bridgeless_growth.h"
#include "vcg_core/shell/marching_tetrahedra.h"
#include "vcg_core/shell/node_groups.h"
#include "vcg_core/shell/outliers.h"
#include "vcg_core/shell/region.h"
#include "vcg_core/shell/topology_vote.h"

namespace neuralmesh {
namespace {

using vcg::Box3f;
using vcg::Point3f;

constexpr std::size_t kResolutions = 5;  // lattices that vote at most
constexpr float kCoarser = 1.4F;
constexpr double kLowConfidence = 0.5, kClearConfidence = 0.75, kHighConfidence = 0.9;  // of the votes
// A closer look takes more nodes, if the cloud is dense enough for them.
constexpr double kCloserLook = 8, kDensePoints = 2;  // times the nodes, times the points per node
constexpr double kCoarseShellSteps = 5;  // radius of the shell in steps of the finest usual lattice
constexpr double kWideOpeningSteps = 4;  // in lattice steps; gaps between points are narrower

/// The step of the finest lattice the options allow on which the cloud still looks like a surface.
float step_for(const std::vector<Point3f>& points, const Box3f& box, const ShellOptions& options,
               double max_nodes, double points_per_node) {
    const float side = longest_side(box);
    float step = side / static_cast<float>(options.max_nodes_per_side - 2 * Region::kMargin);
    while (static_cast<double>(Lattice(box, step, Region::kMargin).size()) > max_nodes) step *= 1.05F;
    while (step < side / 8) {
        const Lattice lattice(box, step, Region::kMargin);
        if (points_per_occupied_node(count_points(lattice, points)) >= points_per_node) break;
        step *= 1.12F;
    }
    return step;
}

/// The values marching tetrahedra want: negative in the solid at \p level.
std::vector<float> signed_values(const Region& region, int level, const std::vector<std::uint8_t>& solid) {
    const float radius = std::sqrt(static_cast<float>(level) + 0.5F);
    std::vector<float> values(solid.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const float d = std::sqrt(static_cast<float>(region.distances[i])) - radius;
        values[i] = solid[i] != 0 ? std::min(d, -0.2F) : std::max(d, 0.2F);
    }
    return values;
}

/// Every stride-th node of \p lattice, with an empty one more on each side.
IndexedMesh mesh_with_stride(const Lattice& lattice, const std::vector<float>& values, int stride) {
    const int pad = 1;
    Lattice coarse = lattice;
    coarse.nx = (lattice.nx + 2 * pad + stride - 1) / stride + 1;
    coarse.ny = (lattice.ny + 2 * pad + stride - 1) / stride + 1;
    coarse.nz = (lattice.nz + 2 * pad + stride - 1) / stride + 1;
    coarse.step = lattice.step * static_cast<float>(stride);
    coarse.origin = lattice.position(-pad, -pad, -pad);
    std::vector<float> picked(coarse.size(), 1.0F);
    for (int z = 0; z < coarse.nz; ++z)
        for (int y = 0; y < coarse.ny; ++y)
            for (int x = 0; x < coarse.nx; ++x) {
                const int fx = x * stride - pad, fy = y * stride - pad, fz = z * stride - pad;
                if (fx < 0 || fy < 0 || fz < 0 || fx >= lattice.nx || fy >= lattice.ny || fz >= lattice.nz)
                    continue;
                picked[coarse.index(x, y, z)] = values[lattice.index(fx, fy, fz)];
            }
    return marching_tetrahedra(coarse, picked);
}

/// A solid and where it comes from.
struct Solid {
    int level = 0;
    std::vector<std::uint8_t> nodes;  ///< 1: in it
    std::vector<float> values;        ///< for marching tetrahedra
};

/// A closed mesh of the cloud and the solid it bounds.
struct Closed {
    Network network;
    Solid solid;
};

/// \p grown: to twice the radius, see shell_grow.h.
Solid solid_at(const Region& region, int level, bool grown) {
    Solid solid;
    solid.level = grown ? grown_level(level) : level;
    solid.nodes = grown ? grown_solid(region, level)
                        : solid_of(region.lattice, region.clearance, region.counts, level, region.enough);
    solid.values = signed_values(region, solid.level, solid.nodes);
    return solid;
}

Network surface_of(const Region& region, const Solid& solid, int stride) {
    const IndexedMesh mesh = mesh_with_stride(region.lattice, solid.values, stride);
    return mesh.faces.empty() ? Network() : Network(mesh.positions, mesh.faces);
}

/// A mesh of the verdict's topology at one of the radii of its run, the smallest if possible, because the
/// mesh lies that far outside the cloud; without growth if that has the topology, too; on every third or
/// second node if those keep it, because it is faster, else on every node, where it is kept by count.
Closed close(const Region& region, const TopologyVote& verdict) {
    const std::vector<int>& levels = verdict.levels;
    const auto right = [&](int components, int genus) {
        return components == verdict.components && genus == verdict.genus;
    };
    Closed closed;
    const auto on_some_nodes = [&](int level, bool grown) {
        closed.solid = solid_at(region, level, grown);
        for (const int stride : {3, 2}) {
            closed.network = surface_of(region, closed.solid, stride);
            if (right(closed.network.component_count(), closed.network.genus())) return true;
        }
        return false;
    };
    // Smallest radius, about the geometric mean, largest radius.
    for (const int level : {levels.front(), levels[levels.size() / 3], levels.back()}) {
        const LevelTopology& plain = region.topologies[static_cast<std::size_t>(level)];
        if (right(plain.components, plain.genus) && on_some_nodes(level, false)) return closed;
    }
    if (!on_some_nodes(levels.front(), verdict.grown)) closed.network = surface_of(region, closed.solid, 1);
    return closed;
}

/// The lattices looked at, finest first, and what they say.
struct LatticeSurvey {
    std::vector<Region> regions;
    std::vector<std::vector<TopologyAt>> topologies;
    TopologyVote verdict;
    float step = 0;  ///< of the lattice it began with

    void vote(bool grown) {
        std::vector<const std::vector<TopologyAt>*> lists;
        std::vector<double> steps;
        for (std::size_t i = 0; i < regions.size(); ++i) {
            lists.push_back(&topologies[i]);
            steps.push_back(static_cast<double>(regions[i].lattice.step));
        }
        verdict = persistent_topology(lists, steps);
        verdict.grown = grown;
    }
};

/// Every level of the region, but for the points alone.
std::vector<TopologyAt> plain_topologies(const Region& region) {
    std::vector<TopologyAt> result;
    for (std::size_t l = 1; l < region.topologies.size(); ++l)
        if (!is_fragmented(region, static_cast<int>(l)))
            result.push_back(
                {static_cast<int>(l), region.topologies[l].components, region.topologies[l].genus});
    return result;
}

/// Asks ever closer, because most clouds are plain: the solids of two lattices; what persists of them as they
/// grow; the same on coarser lattices, for clouds with noise and gaps; on a finer one, for parts that are
/// close.
LatticeSurvey inquire(const std::vector<Point3f>& points, const Box3f& box, const ShellOptions& options) {
    LatticeSurvey inquiry;
    ThreadTeam team(thread_count(options.threads));
    const float step = inquiry.step =
        step_for(points, box, options, options.max_nodes, options.points_per_node);
    const auto look = [&](float at) {
        return examine(points, box, at, options.component_share, ShellOptions::kSpeckPoints);
    };
    inquiry.regions.assign(2, Region(Lattice(box, longest_side(box), 0)));
    for_chunks(2, 1, team, [&](std::size_t i, std::size_t, std::size_t) {
        inquiry.regions[i] = look(i == 0 ? step : kCoarser * step);
    });
    for (const Region& region : inquiry.regions) inquiry.topologies.push_back(plain_topologies(region));
    inquiry.vote(false);
    if (inquiry.verdict.confidence >= kHighConfidence) return inquiry;
    for (std::size_t i = 0; i < inquiry.regions.size(); ++i)
        inquiry.topologies[i] = grown_topologies(inquiry.regions[i], team);
    inquiry.vote(true);
    const float finer = step_for(points, box, options, kCloserLook * options.max_nodes,
                                 kDensePoints * options.points_per_node);
    if (inquiry.verdict.confidence < kClearConfidence && finer * kCoarser <= step) {
        inquiry.regions.insert(inquiry.regions.begin(), look(finer));
        inquiry.topologies.insert(inquiry.topologies.begin(),
                                  grown_topologies(inquiry.regions.front(), team));
        inquiry.vote(true);
    }
    for (float at = step * kCoarser * kCoarser;
         inquiry.verdict.confidence < kLowConfidence && inquiry.regions.size() < kResolutions;
         at *= kCoarser) {
        inquiry.regions.push_back(look(at));
        inquiry.topologies.push_back(grown_topologies(inquiry.regions.back(), team));
        inquiry.vote(true);
    }
    return inquiry;
}

std::string percent(double value) {
    const long long tenths = std::llround(value * 1000);
    return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " %";
}

void add_warnings(const TopologyVote& verdict, bool coarser, long long total, StartMesh& result) {
    if (coarser)
        result.warnings.push_back(
            "The cloud is too sparse or too noisy for its finest shell: a coarser one was taken, which may "
            "miss thin "
            "gaps and small handles.");
    if (!verdict.found || verdict.confidence < kLowConfidence)
        result.warnings.push_back(
            "The number of components and handles of the start mesh is uncertain, because it changes with "
            "the "
            "resolution: " +
            std::to_string(result.components) + " component(s) of genus " + std::to_string(result.genus) +
            " in total is the best guess. Parts of the surface may lie closer together than the points on "
            "them.");
    if (!result.encloses_space)
        result.warnings.push_back(
            "The points enclose no space wider than the gaps between them, as in a single scan, a sheet or a "
            "thin "
            "wall: the surface was closed around both of their sides.");
    if (result.widest_opening > kWideOpeningSteps * result.resolution)
        result.warnings.push_back("The cloud is open: holes up to " + percent(2 * result.widest_opening) +
                                  " of the bounding-box diagonal wide were closed.");
    if (result.ignored_points > 0)
        result.warnings.push_back(
            std::to_string(result.ignored_points) + " of " + std::to_string(total) +
            (result.outliers.empty() ? " points were ignored by the start mesh, but not by the learning"
                                     : " points were ignored") +
            " as outliers: they lie in isolated groups that hold less than 1 % of the points or fewer than " +
            std::to_string(ShellOptions::kSpeckPoints) + ".");
}

void check(const ShellOptions& o) {
    if (o.max_vertices < 4 || o.target_vertices < 4 || !(o.max_nodes >= 1000) || o.max_nodes_per_side < 16 ||
        !(o.points_per_node >= 1) || !(o.component_share >= 0 && o.component_share < 1) || o.samples < 4)
        throw SettingError(
            "The options of the start mesh are out of range: at least 4 vertices, 1000 lattice nodes, 16 "
            "nodes per "
            "side, 1 point per node and 4 samples are needed, and a component share in [0, 1).");
}

std::vector<Point3f> drawn_points(const TargetSpace& target, int count, Random& random) {
    std::vector<Point3f> points;
    points.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) points.push_back(target.sample(random));
    return points;
}

}  // namespace

StartMesh shell_of(const TargetSpace& target, const ShellOptions& options, Random& random,
                   Progress& progress) {
    check(options);
    progress(0.0, "Start mesh: measuring the density of the cloud");
    std::vector<Point3f> drawn;
    if (target.has_faces()) drawn = drawn_points(target, options.samples, random);
    const std::vector<Point3f>& points = target.has_faces() ? drawn : target.positions();
    const Box3f box = main_box(points);

    progress(0.2, "Start mesh: counting components and handles");
    LatticeSurvey inquiry = inquire(points, box, options);
    std::vector<Region>& regions = inquiry.regions;
    TopologyVote& verdict = inquiry.verdict;
    if (!verdict.found) {  // whatever the largest ball closes
        verdict.lattice = static_cast<int>(regions.size()) - 1;
        verdict.levels = {Region::kReach * Region::kReach};
        verdict.grown = false;
    }

    progress(0.7, "Start mesh: building the mesh");
    const Region& region = regions[static_cast<std::size_t>(verdict.lattice)];
    Closed closed = close(region, verdict);
    Network& network = closed.network;
    if (network.vertex_count() == 0)
        throw InputError(
            "No part of the cloud holds enough points for a start mesh around it: start from a tetrahedron, "
            "or remove "
            "the scattered points first.");
    StartMesh result;
    result.components = network.component_count();
    result.genus = network.genus();
    simplify(network, std::max(std::min(options.max_vertices, options.target_vertices / 4),
                               8 * (result.components + result.genus)));
    network.compact();
    for (VertexId v = 0; v < network.vertex_count(); ++v) result.positions.push_back(network.position(v));
    result.faces = network.faces();

    result.confidence = verdict.confidence;
    result.resolution = static_cast<double>(region.lattice.step);
    result.radius = result.resolution * std::sqrt(static_cast<double>(closed.solid.level));
    result.widest_opening = region.widest_opening;
    result.encloses_space = region.encloses_space;
    result.outliers = outliers_of(points, region, closed.solid.nodes, closed.solid.level);
    result.ignored_points = std::count(result.outliers.begin(), result.outliers.end(), 1);
    const double total = static_cast<double>(points.size());
    if (target.has_faces() ||
        static_cast<double>(result.ignored_points) > ShellOptions::kMostOutliers * total)
        result.outliers.clear();
    const bool coarser = region.lattice.step > inquiry.step ||
                         result.radius > kCoarseShellSteps * static_cast<double>(inquiry.step);
    add_warnings(verdict, coarser, static_cast<long long>(points.size()), result);
    progress(1.0, "Start mesh: done");
    return result;
}

}  // namespace neuralmesh
