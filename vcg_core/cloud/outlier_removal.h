// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Outliers of a scan, found by local evidence at any density; and what becomes of them.
//
// Sparse points. The spacing s of a point is the distance to its tenth neighbour (the idea of the local
// outlier factor, Breunig et al. 2000). A point is suspect if s is twice the usual one, of the cloud or of
// its surroundings. Sparse points are not outliers as such: the far wall of a room, the rows of a grazing
// view and wires are sparse, too. So each suspect has an evidence that adds up:
//   - how much its 16 and 48 nearest neighbours fill space, instead of lying on a plane or a line (the
//     surface variation of Pauly et al. 2002, averaged over suspects next to it),
//   - how much denser its neighbours are than itself,
//   - for it: that it lies in the plane of its neighbours, as beyond the border of a denser part,
//   - the evidence of the suspects around, and how many they are.
// In most clouds the evidence has two modes with a gap between them, and the threshold is at the orderly end
// of that gap. Where orderly and wild points merge, the threshold is strict: in doubt a point stays.
//
// Lifted points. If more than a five-hundredth of the points are outliers so far, there are more of them
// close to the surface: points that are sparser than usual by a third only, and four times as far from the
// plane of their neighbours as these are.
//
// Isolated groups. A clump that is as dense as the surface is no suspect. It is an outlier if it holds at
// most a hundredth of the points, is farther from all others than its own points are apart, fills space, and
// is as thick as it is wide. Candidates are connected cells of octree levels.
//
// What becomes of outliers, from the cloud to the mesh
// ----------------------------------------------------
// 1. What is found here is not learned: remove_outliers() of learning_task.cpp, if settings.remove_outliers.
// 2. The start mesh gives groups of few points no component: outliers_of() of start/region.h for a shell,
//    drop_small_parts() of start/open_start.cpp for a mesh of one layer. These are not learned either, see
//    remove_groups_without_component() of learning_task.cpp; but if the shell leaves out more than a tenth of
//    the points, they are.
// 3. What is left draws vertices towards it while they learn. In the fit its influence falls with its squared
//    distance, weaken_outliers() of fit/fitter.cpp. If outliers were removed before, points that are far for
//    their surroundings have none, StrayPoints of fit/noise.h.
// Colours and Report::rms_error are of the points that are learned. Report::outliers counts those that are
// not, and a warning says how many.
//
// The thresholds are from experiments on eight models and three real scans, mixed with scattered points
// (uniform and normal), pairs, clumps and points moved along rays: tests/experiments/accuracy/scan_table.py.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "vcg_core/cloud/surface_survey.h"

namespace neuralmesh {

/// Clouds of fewer points are not examined: they tell too little of their spacing.
constexpr std::size_t kFewestForOutliers = 128;

/// 1 for each outlier among the points of \p survey, of which few may repeat others, in the order in which
/// they were given; empty if there is none. The result does not depend on \p threads (0: all cores). Cost: as
/// much as the survey for an even cloud, ten times that with one outlier in a hundred points. Memory: 15
/// bytes per point beside \p points, 400 more per suspect.
/// \p beat is called about every tenth of a second; what it throws ends the search.
std::vector<std::uint8_t> find_outliers(const CloudSurvey& survey, int threads,
                                        const std::function<void()>& beat = {});

}  // namespace neuralmesh
