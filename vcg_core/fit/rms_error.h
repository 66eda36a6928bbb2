// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The distance of the target from the learned surface.
#pragma once

#include <vector>

#include "vcg_core/base/random.h"
#include "vcg_core/base/thread_team.h"
#include "vcg_core/cloud/target_space.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/mesh/triangle.h"

namespace neuralmesh {

/// Root mean square distance of \p target from the nearest faces of \p network, in the core's frame (1 is the
/// diagonal of the bounding box): of all points, each by its weight, if \p target is a cloud of at most
/// \p samples points; else of \p samples random ones. Does not depend on the number of threads. O((faces +
/// samples) log faces) expected. \pre \p network has a face; samples > 0
double rms_distance(const TargetSpace& target, const Network& network, int samples, Random& random,
                    ThreadTeam& team);

/// The same of \p points, in the frame of \p network, by \p weights; empty: all weigh as much. O((faces +
/// points) log faces) expected. \pre \p network has a face; there are points
double rms_distance(const std::vector<Vector3>& points, const std::vector<float>& weights,
                    const Network& network, ThreadTeam& team);

}  // namespace neuralmesh
