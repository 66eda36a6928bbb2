// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Where most points of a cloud are, a few of which may be very far away.
#pragma once

#include <vcg/space/box3.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace neuralmesh {

/// The box between the 5th and the 95th percentile of each coordinate of the \p count points point_at(i),
/// estimated from about 1000 of them.
template <class PointAt>
vcg::Box3d box_of_most(std::size_t count, const PointAt& point_at) {
    // The share of the points beyond the 5th percentile of the sample has a standard error of .7 %.
    constexpr std::size_t kSampled = 1000;
    const std::size_t stride = count / kSampled + 1;
    vcg::Box3d box;
    for (int k = 0; k < 3; ++k) {
        std::vector<double> along;
        for (std::size_t i = 0; i < count; i += stride) along.push_back(vcg::Point3d(point_at(i))[k]);
        std::sort(along.begin(), along.end());
        const std::size_t outside = along.size() / 20;
        box.min[k] = along[outside];
        box.max[k] = along[along.size() - 1 - outside];
    }
    return box;
}

}  // namespace neuralmesh
