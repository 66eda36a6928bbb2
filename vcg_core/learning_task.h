// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Before learning: the points that are learned and the network that learning starts from.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vcg_core/base/progress.h"
#include "vcg_core/cloud/surface_survey.h"
#include "vcg_core/cloud/target_space.h"
#include "vcg_core/mesh/indexed_mesh.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/settings.h"
#include "vcg_core/start/shell.h"
#include "vcg_core/topology/learned_topology.h"

namespace neuralmesh {

/// The learner's input.
struct LearningTask {
    explicit LearningTask(const TargetSpace& all) : given(all) {}

    /// The points to learn, in the frame that the network has, too.
    const TargetSpace& target() const { return cleaned ? *cleaned : given; }

    const TargetSpace& given;  ///< as the caller passed it
    std::optional<TargetSpace>
        cleaned;       ///< without repeated points and outliers, or weighted; empty: as given
    int outliers = 0;  ///< number of points removed as such
    Network network;
    WallSides walls;          ///< as in StartMesh
    int vertices_needed = 0;  ///< for the components and handles of a shell
    int landing_signals = 0;  ///< per vertex, before growth, to bring a shell down to the points
    /// False for a sheet that is closed: its start mesh has two layers with nothing between them.
    bool encloses_space = true;
    /// The network is the result already: the surface between points too few to learn it (few_points.h).
    bool is_known = false;
    /// Noise of the points in mean edges of the mesh asked for (SurfaceSurvey::noise_in_edges()); 0 for
    /// layers with faces.
    double noise = 0;
    /// Of target(), to judge its noise place by place. Nothing if the start mesh is closed, or the points are
    /// exact or show no surface anywhere.
    std::optional<SurfaceSurvey> noise_by_place;
    TopologyRules topology_rules;    ///< with settings.learn_topology
    double topology_confidence = 0;  ///< as in Report
    int parts_faced_by_normals = 0;  ///< components of the network that face the side of the points' normals
    std::vector<std::string> warnings, notes;  ///< as in Report
};

/// The points of \p given without repeated ones and, if settings.remove_outliers is on, without outliers, and
/// no network yet. \p given must outlive the result. O(points log points)
LearningTask points_to_learn(const TargetSpace& given, const Settings& settings);

/// Removes repeated points and, if settings.remove_outliers is on, outliers from \p given and makes the start
/// mesh that \p settings asks for: the shell of the cloud, an open mesh of one layer, a tetrahedron, or \p
/// start. If settings.even_sampling is on and settings.utility_counter does not follow the density of the
/// points, those of an uneven cloud get weights.
///
/// A shell of more than settings.target_vertices vertices is replaced by a tetrahedron, with a warning,
/// unless the fit reduces it and its components and handles need no more; an open start mesh is not, because
/// a tetrahedron would close it. If settings.surface is automatic and the cloud has no open surface, it is
/// closed. A tetrahedron lies in the middle of the cloud, as in the paper; if settings.learn_topology is on,
/// it is as large as the cloud. Without that setting it stays closed, with a warning if settings.surface is
/// open.
/// \p given must outlive the result. Fractions of \p progress run from 0 to 1. \throws what Shell
/// throws; what open_start() throws if settings.surface is open, and NoSurfaceError if it is automatic and
/// the points enclose no space; SettingError if an open start mesh needs more than settings.target_vertices
/// vertices; what given_start() throws, and SettingError if \p start has more vertices than that
LearningTask prepare(const TargetSpace& given, const Settings& settings, const IndexedMesh<double>& start,
                     Progress& progress);

}  // namespace neuralmesh
