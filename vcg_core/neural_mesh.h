// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// What a run hands back: the learned mesh in the user's coordinates, its counters and its figures.
#pragma once

#include <vcg/space/point3.h>

#include <array>
#include <string>
#include <vector>

namespace neuralmesh {

/// Why a run ended. The values are part of the filter's results: keep them.
enum class StopReason : int {
    target_reached = 0,  ///< exactly target_vertices vertices
    converged = 1,       ///< signals turned the normals by less than stop_below_mean_counter (eq 8)
    cancelled = 2,       ///< the caller's progress object asked to stop
    cut_short = 3,       ///< the bound on signals was reached before the target
};

/// Figures of a run.
struct Report {
    int vertices = 0;
    int faces = 0;
    long long signals = 0;
    long long splits = 0;
    long long collapses = 0;
    int genus = 0;  ///< of all components together
    int boundary_loops = 0;
    int components = 0;
    /// How sure genus and components are: the share of what was looked at (radii of the shell, StartMesh)
    /// that agrees, in [0, 1]; 0 if the learning started from a tetrahedron, which asks nothing of the cloud.
    double topology_confidence = 0;
    /// With counter > feature_threshold, which is times the mean for the normal counter (eq 7).
    int feature_vertices = 0;
    double rms_error = 0;     ///< cloud to mesh, % of the bounding-box diagonal of what was learned
    double mean_counter = 0;  ///< Mean(n_c)
    double seconds = 0;
    StopReason stop_reason = StopReason::target_reached;
    std::vector<std::string> warnings;  ///< full sentences for the log
};

/// An indexed triangle mesh, counter-clockwise seen from outside, with one number per vertex.
struct NeuralMesh {
    std::vector<vcg::Point3d> positions;  ///< in the coordinates of the input
    std::vector<std::array<int, 3>> faces;
    std::vector<float> counters;  ///< per vertex what settings.feature_measure names, >= 0
    std::vector<char> features;   ///< 1 where it passes the threshold (eq 7)
    Report report;
};

}  // namespace neuralmesh
