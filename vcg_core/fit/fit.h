// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The fit to the points: learning leaves every vertex somewhat behind its signals, least squares take it the
// rest of the way. Comes after the learning; vertices that it can do without are taken out.
#pragma once

#include <cstdint>
#include <vector>

#include "vcg_core/base/progress.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/target/target_space.h"

namespace neuralmesh {

/// What the fit may do. The defaults were found by experiment.
struct FitOptions {
    int rounds = 0;  ///< of least squares at most, each with new nearest faces; 0: 20 up to 2,000 vertices, 8
                     ///< from 5,000 on
    bool flip_edges = true;
    /// Move vertices from where they are of little use to where the error is large (Hoppe et al. 1993). Off:
    /// every vertex keeps its place in the mesh, for meshes whose density is to follow something else than
    /// the error.
    bool redistribute = true;
    /// If the network has more vertices, it is first reduced to so many: those whose removal costs least go.
    /// 0: it keeps what it has.
    int target_vertices = 0;
    /// Points used: all, or if there are more, a random choice of this many per vertex, but at least
    /// min_points.
    int points_per_vertex = 100;
    int min_points = 100000;
};

/// Figures of a fit. Errors are root mean squares over points held back from it, in the core's frame, along
/// smoothed normals of the mesh as it was before, every distance counted up to where outliers begin.
struct FitReport {
    double rms_before = 0;  ///< too low under noise: the points were not held back from the learning
    double rms_after = 0;
    int rounds = 0;
    int flips = 0;
    int moved_vertices = 0;  ///< taken out at one place and put in at another
    /// False: no round was kept. What comes before the rounds stays: the smoothing of a mesh that cut itself,
    /// and the reduction.
    bool improved = false;
    /// For every slot the vertex whose counters it takes over: itself, or, if it was put in anew, the one at
    /// whose place it came to lie.
    /// Ids are those before the fit. -1 for free slots.
    std::vector<VertexId> origin;
};

/// Moves the vertices of \p network so that its surface comes as close to the points of \p target as it can:
/// rounds of linear least squares over the distances of the points to their nearest faces, with a bending
/// term whose weight the points held back decide; between them edges are flipped (and vertices redistributed)
/// where that brings the points closer. Far outliers lose their pull. No face turns over or becomes a sliver;
/// the result is kept only if it is closer to the points held back than the mesh was before (but for what
/// learning has followed of their noise, see rms_before). Where the surface cuts itself it is smoothed first,
/// and it does not come to cut itself in more faces than before.
///
/// The number of components, handles and boundary loops stays, and that of vertices unless
/// options.target_vertices asks for less; \p network has more than that only if it was asked to stop, or if
/// nothing more can be taken out without harm to the surface,
/// or if there are hardly any points to fit to. "Before" is after the reduction. The same bytes
/// for any \p threads (0: as many as the machine has). Stops early, with the best mesh so far, when \p
/// progress asks for it; fractions run from 0 to 1. Exact nearest faces: O(points log faces) a round, in all
/// about 2.5 s of processor time for 10k vertices and 200k points. Sources: Hoppe, DeRose, Duchamp, McDonald,
/// Stuetzle, "Mesh Optimization" (1993); the linearisation is Gauss-Newton's for distances (point to plane).
FitReport fit_to_points(Network& network, const TargetSpace& target, const FitOptions& options, int threads,
                        std::uint64_t seed, Progress& progress);

}  // namespace neuralmesh
