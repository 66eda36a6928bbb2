// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Clouds with normals, right and wrong ones.
#pragma once

#include "tests/unit/support/open_shapes.h"
#include "tests/unit/support/referee.h"

namespace neuralmesh {

inline PackedNormal packed_point(const vcg::Point3d& n) { return packed({n[0], n[1], n[2]}); }

/// The directions from the origin: the normals of a sphere around it, to the outside.
inline std::vector<PackedNormal> outward(const Cloud& cloud) {
    std::vector<PackedNormal> normals;
    for (const vcg::Point3d& p : cloud) normals.push_back(packed_point(p));
    return normals;
}

inline PackedNormal opposite(PackedNormal n) {
    for (auto& c : n) c = static_cast<std::int8_t>(-c);
    return n;
}

inline std::vector<PackedNormal> inward(const Cloud& cloud) {
    std::vector<PackedNormal> normals = outward(cloud);
    for (PackedNormal& n : normals) n = opposite(n);
    return normals;
}

/// Every one turned over with the probability 1 / \p one_in.
inline std::vector<PackedNormal> flipped(std::vector<PackedNormal> normals, std::uint32_t one_in) {
    Random random(1);
    for (PackedNormal& n : normals)
        if (random.below(one_in) == 0) n = opposite(n);
    return normals;
}

inline std::vector<PackedNormal> nonsense(std::size_t count) {
    Random random(1);
    std::vector<PackedNormal> normals;
    for (std::size_t i = 0; i < count; ++i) normals.push_back(packed_point(shapes::in_ball(random)));
    return normals;
}

/// Of a sphere, what lies below its upper third.
inline Cloud bowl(int count) { return open_shapes::sphere_below(0.3, count); }

inline TargetSpace target_of(const Cloud& cloud, const std::vector<PackedNormal>& normals) {
    TargetSpace target = target_of(cloud);
    target.set_normals(normals);
    return target;
}

}  // namespace neuralmesh
