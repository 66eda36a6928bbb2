// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Vertex colours that show the feature measure.
#pragma once

#include <vector>

#include "vcg_core/base/color.h"

namespace neuralmesh {

/// One colour per counter from the light two thirds of the map "magma" (van der Walt and Smith, 2015), which
/// is perceptually uniform and readable without colour vision: light yellow at the 2nd percentile and below,
/// purple at the 98th and above, so that a few extreme counters do not hide the rest. Smooth parts, usually
/// the most of a surface, get the light end, so that they are readable under a renderer's shading.
/// O(counters).
std::vector<Color> counter_colors(const std::vector<float>& counters);

}  // namespace neuralmesh
