// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The shell of a cloud: a small closed mesh around it with the components and handles of its surface.
// Learning starts from it, because learning from a tetrahedron makes no handles and leaves webs across gaps.
//
// 1. A lattice is laid over the cloud, as fine as the density of the points allows (lattice.h).
// 2. The solid at radius r is the set of nodes that the centre of a ball of radius r cannot reach from
//    outside without the ball touching a point. Spaces much wider than their opening are sealed: they are
//    the inside of a surface with gaps between its points (clearance.h, region.h). Those that a wall
//    separates from the outside are hollows, and not of the solid (region.h).
// 3. From several radii on the solid is grown to twice the radius without bridging gaps, which tells
//    handles from gaps between points and from parts that nearly touch (lattice_survey.h). The topology
//    that persists over the largest range of radii is chosen (lattice_survey.h).
// 4. If the vote is uncertain, coarser lattices are asked.
// 5. Marching tetrahedra turn the chosen solid into a mesh (closed_mesh.h). Half-edge collapses, which keep
//    the topology, reduce it (simplify.h), less where walls and gaps are narrow (local_width.h). There a mesh
//    of more vertices tells the two sides of a wall apart (WallSides).
//
// Outliers make no component. An isolated group of points makes one if it holds at least 1 % of the points
// and at least 20 (region.cpp): of 200,000 points, a group of 1,999 is outliers. The
// start mesh leaves outliers out, and a warning says how many they are.
#pragma once

#include <vcg/space/point3.h>

#include <cstdint>
#include <string>
#include <vector>

#include "vcg_core/base/progress.h"
#include "vcg_core/mesh/indexed_mesh.h"
#include "vcg_core/start/lattice_survey.h"

namespace neuralmesh {

class Surveys;

/// Of closed models less than this share of the surface has no enclosed space beside it: up to .027, and from
/// .048 on where a part is open or a thin wall. Chosen by open_table.py.
inline constexpr double kMostSheet = 0.04;

/// Limits of cost.
struct ShellOptions {
    /// The start mesh has min(max_vertices, target_vertices / 4) vertices, but at least 8 per component and 8
    /// per handle, and more if the topology needs them.
    int max_vertices = 400;
    int target_vertices = 10000;
    /// Where walls or gaps are narrower than its edges, the start mesh gets shorter ones: in all up to this
    /// many vertices, and one for every eight points, if the surface encloses space. 0: none.
    int most_vertices = 0;
    /// Outliers get no component, but are to be learned.
    bool learn_outliers = false;
    /// 0: one per core. The mesh does not depend on it.
    int threads = 0;

    /// If outliers are a larger share of the cloud, they are learned: then they are not rare errors. Without
    /// this bound a casting with walls .6 edges thick has 1.15 times the error (ablation.py).
    static constexpr double kMaxOutlierShare = 0.1;
};

/// What the lattices say of the space that the cloud encloses.
struct Enclosure {
    bool encloses_space = true;  ///< false for a sheet or a single scan: the mesh has a layer on both sides
    bool walled = false;         ///< the points are the two sides of walls too thin for the lattice
    /// Share of the surface with no enclosed space beside it, thin walls apart.
    double sheet_share = 0;
    double widest_opening = 0;   ///< radius of the widest sealed opening; 0: none
};

/// A finer mesh of the shell, which tells the two sides of thin walls apart; without faces if there are none.
struct WallSides : IndexedMesh<float> {
    /// How far the points below each vertex may be moved outwards while they are learned, so that the two
    /// sides are further from each other (local_width.h).
    std::vector<float> thickenings;
};

/// A closed, oriented, simplicial 2-manifold with valences from 3 to 12, in the core's frame.
struct StartMesh : IndexedMesh<float>, Enclosure {
    int components = 0;
    int genus = 0;            ///< of all components together
    int fewest_vertices = 0;  ///< that its components and handles need
    WallSides walls;
    double confidence = 0;         ///< share of the votes for components and genus, in [0, 1]
    long long ignored_points = 0;  ///< outliers: the mesh leaves them out
    /// 1 for each outlier of the cloud. Empty if all points are to be learned: there are no outliers, or
    /// they exceed kMaxOutlierShare.
    std::vector<std::uint8_t> outliers;
    std::vector<std::string> warnings;  ///< full sentences for the log
};

/// The shell of points, in two steps. Whether the cloud encloses space is known after the first; if it is
/// open, the mesh, which may take as long, is not needed.
///
/// Equal points and options give equal meshes on every machine. The surfaces
/// of hollows are components, seen from within. Time: about 0.2 s, and 0.1 s more per million points. Memory:
/// about 30 bytes per lattice node.
class Shell {
public:
    /// Examines the lattices and keeps them, and a reference to \p points, of which \p surveys are. \p
    /// progress gets fractions up to 0.7 of both steps; its answer to stop is ignored.
    Shell(const std::vector<vcg::Point3f>& points, Surveys& surveys, const ShellOptions& options,
          Progress& progress);
    const Enclosure& enclosure() const { return enclosure_; }
    /// The mesh. \throws InputError if no part of the cloud holds enough points
    StartMesh mesh(Progress& progress) const;

private:
    const std::vector<vcg::Point3f>& points_;
    const ShellOptions options_;
    LatticeSurvey survey_;
    Enclosure enclosure_;
};

}  // namespace neuralmesh
