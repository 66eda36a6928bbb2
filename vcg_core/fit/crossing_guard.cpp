// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/crossing_guard.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace neuralmesh {

namespace {

std::size_t count_faces(const std::vector<SelfCrossing>& crossings) {
    std::vector<Triangle> faces;
    for (const SelfCrossing& c : crossings) {
        faces.push_back({c[0], c[1], c[2]});
        faces.push_back({c[3], c[4], c[5]});
    }
    std::sort(faces.begin(), faces.end());
    return static_cast<std::size_t>(std::unique(faces.begin(), faces.end()) - faces.begin());
}

}  // namespace

CrossingGuard::CrossingGuard(std::vector<SelfCrossing> crossings)
    : accepted_(std::move(crossings)), max_faces_(count_faces(accepted_)) {}

std::vector<VertexId> CrossingGuard::objections(std::vector<SelfCrossing> crossings) {
    std::vector<SelfCrossing> added;
    std::set_difference(crossings.begin(), crossings.end(), accepted_.begin(), accepted_.end(),
                        std::back_inserter(added));
    std::vector<VertexId> corners;
    if (added.empty() || count_faces(crossings) <= max_faces_) {
        accepted_ = std::move(crossings);
    } else {
        for (const SelfCrossing& crossing : added)
            corners.insert(corners.end(), crossing.begin(), crossing.end());
    }
    return corners;
}

}  // namespace neuralmesh
