// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The result of a run: the learned mesh in the user's coordinates, its counters and its figures.
#pragma once

#include <vcg/space/point3.h>

#include <array>
#include <string>
#include <vector>

#include "vcg_core/base/colors_and_normals.h"
#include "vcg_core/paper/constants.h"

namespace neuralmesh {

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
    /// Confidence in genus and components: the share of the shell radii examined that agree, in [0, 1]. 0 if
    /// learning started from a tetrahedron or a given mesh, whose topology does not depend on the cloud.
    double topology_confidence = 0;
    int outliers = 0;          ///< points that were not learned because of settings.remove_outliers
    int feature_vertices = 0;  ///< number of ones in NeuralMesh::features
    int crease_lines = 0;  ///< polylines in NeuralMesh::creases, each between two corners or ends, or closed
    /// Learned points to mesh, % of the diagonal of their bounding box; weighted by area if the cloud was
    /// sampled evenly (settings.even_sampling).
    double rms_error = 0;
    /// Distance of points that were held out to the mesh, root mean square less their noise, in the units of
    /// the input; 0 without settings.target_error.
    double held_out_error = 0;
    double mean_counter = 0;  ///< mean of NeuralMesh::counters; of the normal counter, Mean(n_c) of eq 7
    double seconds = 0;       ///< wall-clock time of reconstruct()
    StopReason stop_reason = StopReason::target_reached;
    std::vector<std::string> warnings;  ///< full sentences for the log
    std::vector<std::string> notes;     ///< the same, of what is no reason for doubt
};

/// The creases of a mesh as an edge mesh, see crease_lines.h.
struct CreaseLines {
    std::vector<vcg::Point3d> positions;    ///< in the coordinates of the input
    std::vector<std::array<int, 2>> edges;  ///< indices into positions
    std::vector<float> measures;            ///< per vertex: the crease measure
};

/// An indexed triangle mesh, counter-clockwise seen from outside, with one number per vertex.
struct NeuralMesh {
    std::vector<vcg::Point3d> positions;  ///< in the coordinates of the input
    std::vector<std::array<int, 3>> faces;
    std::vector<float> counters;  ///< per vertex, >= 0: the measure that settings.feature_measure names
    /// Per vertex: 1 if the measure that settings.select_by names is above settings.feature_threshold.
    std::vector<char> features;
    std::vector<Color> colors;  ///< per vertex; empty if settings.vertex_color is kNoColors
    CreaseLines creases;        ///< empty unless settings.crease_lines is on and there are creases
    Report report;
};

}  // namespace neuralmesh
