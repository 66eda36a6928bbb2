// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/cloud/cloud_survey.h"

#include <algorithm>

#include "vcg_core/base/parallel_for.h"

namespace neuralmesh {

CloudSurvey::CloudSurvey(const std::vector<vcg::Point3f>& points, int threads)
    : cloud(points), squared_spacings((points.size() + kRun - 1) / kRun) {
    constexpr std::size_t kChunk = 32;
    ThreadTeam team(thread_count(threads));
    for_chunks(squared_spacings.size(), kChunk, team, [&](std::size_t, std::size_t begin, std::size_t end) {
        std::vector<NearestPoints::Neighbour> near;
        for (std::size_t run = begin; run < end; ++run) {
            const std::size_t place = std::min<std::size_t>(run * kRun + kRun / 2, cloud.size() - 1);
            cloud.nearest(static_cast<NearestPoints::Place>(place), kNeighbour, near);
            squared_spacings[run] = near.back().squared_distance;
        }
    });
}

}  // namespace neuralmesh
