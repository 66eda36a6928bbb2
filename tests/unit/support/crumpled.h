// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Surfaces that cut themselves.
#pragma once

#include <set>
#include <vector>

#include "tests/unit/support/shapes.h"
#include "vcg_core/mesh/self_crossings.h"

namespace neuralmesh {

/// A sphere of radius 10, where vcglib's tolerances are small, crumpled by \p noise.
inline Network crumpled_sphere(double noise, std::uint64_t seed = 5) {
    const shapes::Shape sphere = shapes::icosphere(3);
    Random random(seed);
    std::vector<vcg::Point3f> positions;
    for (const vcg::Point3d& p : sphere.positions)
        positions.push_back(vcg::Point3f::Construct((p + shapes::in_ball(random) * noise) * 10.0));
    return Network(positions, std::vector<Triangle>(sphere.faces.begin(), sphere.faces.end()));
}

/// The faces that cross another, by their sorted corners.
inline std::set<Triangle> cut_faces(const Network& network) {
    ThreadTeam team(1);
    std::set<Triangle> faces;
    for (const SelfCrossing& c : self_crossings(Surface(network), team)) {
        faces.insert({c[0], c[1], c[2]});
        faces.insert({c[3], c[4], c[5]});
    }
    return faces;
}

}  // namespace neuralmesh
