// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A start mesh of one layer, with boundary, for a cloud whose surface is open: a scan, a face, a facade.
// Parts of the cloud that are closed come out closed.
//
// How: the points are thinned to the scale on which they are a surface, put down on it
// (consolidated_points.h), their normals turned to one side (viewpoint.h), and triangulated
// (point_triangulation.h). Parts with too few points are dropped, small holes filled, and what remains is
// reduced by half-edge collapses, which keep its topology.
#pragma once

#include <vcg/space/point3.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "vcg_core/base/error.h"
#include "vcg_core/base/progress.h"
#include "vcg_core/base/random.h"
#include "vcg_core/cloud/surface_survey.h"
#include "vcg_core/cloud/target_space.h"
#include "vcg_core/mesh/indexed_mesh.h"

namespace neuralmesh {

/// The points lie on curves, are scattered in space, or are too noisy: they show no surface.
class NoSurfaceError : public InputError {
public:
    using InputError::InputError;
};

/// What the open start may cost and how it decides. The defaults were found by experiment (open_table.py).
struct OpenStartOptions {
    /// Wanted number of vertices: at most one for kPointsPerVertex points. More if the topology cannot be
    /// kept otherwise. Edges of a coarse mesh are wider than bays of the boundary, or parts beside it: what
    /// they span or fold there stays while the network grows.
    int wanted_vertices = 5000;
    int target_vertices = 10000;  ///< that stay when all is done
    /// Holes are filled up to this diameter of the smallest sphere around them, in the core's frame (shares
    /// of the bounding-box diagonal); negative: chosen from the spacing of the points.
    double close_holes_up_to = -1;
    /// If no hole is wider than this share of the mesh's diagonal, all are filled: the surface is closed.
    double closed_up_to = 0;
    /// Outliers get no component, but are to be learned.
    bool learn_outliers = false;
    /// Parts with a boundary face the side to which most normals of the target point, if it has any, instead
    /// of facing out where they are convex.
    bool use_normals = false;
    /// 0: one per core. The mesh does not depend on it.
    int threads = 0;

    /// Fewer points do not tell where a vertex of the start mesh belongs.
    static constexpr int kPointsPerVertex = 4;
    /// Fewer points show no boundary.
    static constexpr int kLeastCloud = 100;
};

/// An oriented 2-manifold with or without boundary (simplicial, valences up to 12) in the core's frame.
struct OpenStart : IndexedMesh<float> {
    /// It can be reduced to so many vertices, or to OpenStartOptions::target_vertices.
    int fewest_vertices = 0;
    int components = 0;
    int genus = 0;             ///< of all components together
    int loops = 0;             ///< boundary loops
    /// Far above, if nothing is turned away from there: terrain and what stands on it.
    std::optional<vcg::Point3f> viewer;
    int faced_by_normals = 0;  ///< components with a boundary that face the side of the target's normals
    /// of the smallest sphere around the widest hole, as share of the mesh's diagonal
    double widest_loop = 0;
    double radius = 0;  ///< on which the points are a surface: where they are sparse, or noisy
    /// More of the points whose surroundings show a surface were left out than chance and clutter account
    /// for: the mesh is not theirs. So are the narrow sides of a thin slab.
    bool misses_surface = false;
    double left_out = 0;       ///< the share of the points that belong to nothing of the mesh
    LayerFigures layers;       ///< whether most of the points lie on the two sides of a thin wall
    /// 1 for each point of the cloud that is not to be learned; empty if there are none, or if the target has
    /// faces.
    std::vector<std::uint8_t> outliers;
    std::vector<std::string> warnings;  ///< full sentences
};

/// The open start mesh of \p target, from \p points of it, of which \p surveys are. Equal arguments give
/// equal meshes everywhere. \p progress gets fractions from 0 to 1; a wish to stop is not answered (0.3 s for
/// 100,000 points). \throws NoSurfaceError; InputError if there are too few points
OpenStart open_start(const TargetSpace& target, const std::vector<vcg::Point3f>& points, Surveys& surveys,
                     const OpenStartOptions& options, Random& random, Progress& progress);

}  // namespace neuralmesh
