// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The shell of the cloud: a small closed mesh around it that already has its components and handles, for the
// learning to start from. (From a tetrahedron the surface cannot grow handles and spans gaps.)
//
// How: on a lattice as fine as the cloud is dense, the solid at radius r is everything a ball of radius r
// cannot get to from outside without touching a point. Spaces much wider than the way into them are sealed:
// they are the inside of a surface with gaps between its points. Components and genus of the solid are
// counted for all radii at once, and those that persist over radii are believed. Where they do not agree,
// the solids are grown without bridging gaps (shell_grow.h), which tells handles from holes between points
// and from parts that nearly touch, on more lattices. The winner is meshed by marching tetrahedra and reduced
// by half-edge collapses, which keep its topology.
//
// Outliers make no component of their own: a group of points that is isolated at the radius chosen counts
// only if it holds at least 1 % of the points (component_share) and kSpeckPoints of them. The others are left
// out of the start mesh, and a warning says how many. So of 200,000 points a clump of 1,999 is an outlier.
// Single points deep inside are outliers, too.
#pragma once

#include <vcg/space/point3.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "vcg_core/base/progress.h"
#include "vcg_core/base/random.h"
#include "vcg_core/target/target_space.h"

namespace neuralmesh {

/// What the shell may cost and how it decides. The defaults were found by experiment (shell_topology).
struct ShellOptions {
    /// Wanted number of vertices: min(max_vertices, target_vertices / 4), but never below
    /// 8 per component and 8 per handle. More if the topology cannot be kept otherwise.
    int max_vertices = 400;
    int target_vertices = 10000;
    /// Nodes of the finest lattice: about 30 bytes and 0.3 microseconds each, and up to 9 bytes more for each
    /// of at most eight threads where parts nearly touch.
    double max_nodes = 5.0e5;
    int max_nodes_per_side = 256;
    /// The lattice is coarse enough if its occupied nodes hold this many points on average.
    double points_per_node = 1.1;
    /// A component counts with this share of the points and at least kSpeckPoints of them.
    double component_share = 0.01;
    /// Points drawn from a target that is a mesh.
    int samples = 200000;
    /// As in Settings; the mesh does not depend on it.
    int threads = 0;

    static constexpr int kSpeckPoints = 20;
    /// A cloud with a larger share of them is one of another kind than thought: they are to be learned.
    static constexpr double kMostOutliers = 0.1;
};

/// A closed, oriented 2-manifold (simplicial, valences 3 to 12) in the core's frame, and what it stands for.
struct StartMesh {
    std::vector<vcg::Point3f> positions;
    std::vector<std::array<int, 3>> faces;  ///< counter-clockwise seen from outside

    int components = 0;
    int genus = 0;  ///< of all components together
    /// How sure components and genus are: their share in the votes of all topologies met, in [0, 1].
    double confidence = 0;
    double radius = 0;             ///< at which the cloud was closed; the mesh lies about this far outside it
    double resolution = 0;         ///< distance of the lattice nodes
    double widest_opening = 0;     ///< radius of the widest hole that was sealed; 0: none
    bool encloses_space = true;    ///< false: a sheet, a single scan; the mesh goes around it on both sides
    long long ignored_points = 0;  ///< outliers: they belong to no component
    /// Those that are not to be learned: 1 for each such point of the cloud. Empty if there are none, too
    /// many, or if the target has faces.
    std::vector<std::uint8_t> outliers;
    std::vector<std::string> warnings;  ///< full sentences
};

/// The shell of \p target. The same target, options and state of \p random give the same mesh everywhere;
/// random is drawn from only if the target has faces. Nested surfaces come as the outermost one.
///
/// \p progress gets fractions of this step from 0 to 1; a wish to stop is not answered (the step takes about
/// 0.2 s, 0.1 s more for each million points, and up to 3 s where parts nearly touch). Memory: about 30 bytes
/// per lattice node, of which there are up to eight times max_nodes where parts nearly touch.
/// \throws SettingError for options out of range, InputError if no part of the cloud holds enough points
StartMesh shell_of(const TargetSpace& target, const ShellOptions& options, Random& random,
                   Progress& progress);

}  // namespace neuralmesh
