// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Least-squares fit to the points after learning: removes the lag that learning leaves, and surplus vertices.
#pragma once

#include <cstdint>

#include "vcg_core/base/progress.h"
#include "vcg_core/cloud/surface_survey.h"
#include "vcg_core/cloud/target_space.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// What the fit may change. The defaults were chosen by tests/experiments/accuracy.
struct FitOptions {
    /// Most rounds of least squares, each with new nearest faces. 0: 20 up to 2,000 vertices, falling to 8
    /// from 5,000 on.
    int rounds = 0;
    /// Move vertices from where they matter little to where the error is large (Hoppe et al. 1993). Turn it
    /// off for meshes whose density must follow something else than the error.
    bool redistribute = true;
    /// Reduce the network to this number of vertices first, removing those whose removal costs least. 0, or
    /// at least the present number: keep it.
    int reduce_to = 0;
    /// The network is the result of another fit.
    bool fitted_before = false;
    /// Reduce by the shape of the fitted mesh (collapse_by_volume()).
    bool by_volume = false;
    /// Leave out stray points (noise.h). For clouds that had outliers: those close to the surface are
    /// still there.
    bool expect_strays = false;
    /// Insert vertices until there are this many, after the rounds, and fit once more. For meshes of more
    /// vertices than the points carry. 0, or at most the number then: none.
    int refine_to = 0;
    /// The noise of the points; null: as the first mesh shows it, the same everywhere.
    const SurfaceSurvey* noise = nullptr;
};

/// Figures of a fit. Errors are root mean squares over points held out of the fit, in the core's frame,
/// measured along smoothed normals of the mesh before the fit; each distance counts up to a bound above which
/// points are outliers.
struct FitReport {
    /// After the reduction, before the first round. Too low under noise: the points were held out of the fit,
    /// not out of the learning.
    double rms_unfitted = 0;
    double rms_fitted = 0;  ///< of the mesh that was kept
    int rounds = 0;
    /// False: the result of the rounds was discarded. What comes before them stays: the smoothing of a mesh
    /// that cuts itself, and the reduction.
    bool improved = false;
};

/// Moves the vertices of \p network to lower the sum of squared distances of the points of \p target. Some
/// points are held out of the fit to judge it. Each round assigns the other points to their nearest faces and
/// solves linear least squares with a bending term, whose weight minimises the error at the held-out points.
/// Between rounds, edges are flipped and vertices redistributed where that lowers the distances. A boundary
/// moves to where the points end, from both sides, and notches that hold points are filled.
///
/// - With many precise points, later rounds let the surface slide less (the hold of PointToPlaneSystem).
/// - Between rounds, vertices move to creases of the points (crease_moves.h), where flips then put edges.
/// - What stays: components, handles, boundary loops, and the number of vertices unless options.reduce_to is
///   less. No face turns over, folds onto a neighbour or becomes a sliver.
/// - Self-intersections are smoothed out first where possible; the fit adds none. If there is a boundary,
///   faces that still cut others are removed, the topology with them where it must be; see sound_meshes.h.
/// - Outliers: the influence of a far point falls with its squared distance. With options.expect_strays
///   points that are far for their surroundings have none.
/// - The result of the rounds is kept only if its error at the held-out points is smaller, allowing for the
///   noise that learning has followed (see rms_unfitted). Else the mesh stays as it was before them. With
///   options.noise it is always kept.
/// - The reduction falls short of options.reduce_to if it was stopped, if no more vertices can go without
///   harm, or if there are fewer than 64 points.
/// - If \p progress asks to stop, the best mesh so far is kept. Fractions run from 0 to 1.
/// - \p seed decides which points are used and held out. The result has the same bytes for any number of
///   \p threads (0: one per core).
///
/// Cost: O(points x log faces) once and O(points) per round; about 2.5 s of processor time for 10,000
/// vertices and 200,000 points. Sources: Hoppe, DeRose, Duchamp, McDonald, Stuetzle, "Mesh Optimization"
/// (1993); the linearised distances are those of Chen and Medioni, "Object modelling by registration of
/// multiple range images" (1992) (point to plane).
FitReport fit_to_points(Network& network, const TargetSpace& target, const FitOptions& options, int threads,
                        std::uint64_t seed, Progress& progress);

}  // namespace neuralmesh
