// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The topology of a cloud, from lattices of several resolutions.
#pragma once

#include <vcg/space/box3.h>
#include <vcg/space/point3.h>

#include <vector>

#include "vcg_core/base/progress.h"
#include "vcg_core/shell/region.h"
#include "vcg_core/shell/topology_vote.h"

namespace neuralmesh {

/// With a smaller share of the votes the topology is uncertain.
inline constexpr double kLowConfidence = 0.5;

/// The lattices examined, finest first, and their vote.
struct LatticeSurvey {
    std::vector<Region> regions;
    std::vector<std::vector<TopologyAt>> topologies;  ///< of each region
    TopologyVote vote;
    float step = 0;  ///< of the first lattice examined

    const Region& chosen_region() const { return regions[static_cast<std::size_t>(vote.lattice)]; }
};

/// Stops as soon as the vote is clear, because most clouds are plain:
/// 1. the solids of two lattices;
/// 2. the same two, with the solids grown without bridges;
/// 3. a finer lattice, for surfaces close to each other;
/// 4. coarser lattices, for clouds with noise and gaps.
/// If no lattice has a topology, the choice is the largest ball on the coarsest one. Uses
/// \p threads threads, 0: one per core. \p places tell hollows (hollows.h). The result does not depend on the
/// threads.
LatticeSurvey survey_lattices(const std::vector<vcg::Point3f>& points, const std::vector<LayerPlace>& places,
                              const vcg::Box3f& box, int threads, Progress& progress);

}  // namespace neuralmesh
