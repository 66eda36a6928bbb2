// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Surfaces that cut themselves, and their self-intersections.
#pragma once

#include "tests/unit/support/prelude.h"
#include "tests/unit/support/referee.h"
#include "vcg_core/mesh/self_intersections.h"

namespace neuralmesh {

/// A sphere of radius 10, where vcglib's tolerances are small, crumpled by \p noise times
/// its radius.
inline Network crumpled_sphere(double noise, std::uint64_t seed = 5) {
    return network_of(shapes::scaled(shapes::icosphere(3), 10), 10 * noise, seed);
}

inline std::vector<SelfIntersection> intersections(const Surface& surface, int threads) {
    ThreadTeam team(threads);
    return self_intersections(surface, team);
}

/// The faces that cross another, by their sorted corners.
inline std::set<Triangle> cut_faces(const Network& network) {
    std::set<Triangle> faces;
    for (const SelfIntersection& c : intersections(Surface(network), 1)) {
        faces.insert({c[0], c[1], c[2]});
        faces.insert({c[3], c[4], c[5]});
    }
    return faces;
}

}  // namespace neuralmesh
