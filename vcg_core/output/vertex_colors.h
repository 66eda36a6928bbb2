// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Colours of the vertices: those that show the feature measure, and those of the cloud that the mesh was
// learned from.
#pragma once

#include <vector>

#include "vcg_core/base/colors_and_normals.h"
#include "vcg_core/base/progress.h"
#include "vcg_core/base/random.h"
#include "vcg_core/cloud/target_space.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// One colour per counter from the light two thirds of the map "magma" (van der Walt and Smith, 2015), which
/// is perceptually uniform and readable without colour vision: light yellow at the 2nd percentile and below,
/// purple at the 98th and above, so that a few extreme counters do not hide the rest. Smooth parts, usually
/// the most of a surface, get the light end, so that they are readable under a renderer's shading.
/// O(counters).
std::vector<Color> counter_colors(const std::vector<float>& counters);

/// A colour for every slot of \p network; white for free slots and for components near which there are no
/// points.
///
/// The points near a vertex are those of its faces. It first gets their mean, weighted by their barycentric
/// coordinates and the areas that they stand for, then the mean of what is left of their colours when those
/// interpolated between the vertices are subtracted ("twicing": Tukey, "Exploratory Data Analysis", 1977).
/// Twicing takes out most of the blur of the mean, and of the shift where the points lie on one side; more
/// repetitions would follow the noise of the colours. A vertex without points has the mean colour of its
/// neighbours.
///
/// Means are those of the codes from 0 to 255, not of linear light: renderers interpolate the codes across a
/// face, too, and noise of the codes does not brighten dark parts.
///
/// At least 100,000 points and 30 per vertex are used, if the cloud has as many; of faces, as many samples.
/// If \p progress asks to stop, the points used so far decide. The result does not depend on \p threads.
/// O(points used x log faces). \pre target.has_colors(), and the network has a face
PerVertex<Color> cloud_colors(const TargetSpace& target, const Network& network, int threads, Random& random,
                              Progress& progress);

}  // namespace neuralmesh
