// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/engine/axis_partition.h"

#include <vcg/space/box3.h>

#include <algorithm>
#include <limits>

namespace neuralmesh {

AxisPartition::AxisPartition(const std::vector<vcg::Point3f>& sample) {
    vcg::Box3f box;
    for (const vcg::Point3f& p : sample) box.Add(p);
    axis_ = sample.empty() ? 0 : box.MaxDim();
    for (const vcg::Point3f& p : sample) coordinates_.push_back(p[axis_]);
    std::sort(coordinates_.begin(), coordinates_.end());
    cut(1);
}

void AxisPartition::cut(int count) {
    constexpr float kEnd = std::numeric_limits<float>::infinity();
    const auto slabs = static_cast<std::size_t>(count);
    borders_.assign(slabs + 1, kEnd);
    borders_.front() = -kEnd;
    for (std::size_t i = 1; i < slabs && !coordinates_.empty(); ++i)
        borders_[i] = coordinates_[coordinates_.size() * i / slabs];
}

int AxisPartition::of(const vcg::Point3f& p) const {
    int slab = 0;
    while (!range(slab).holds(p)) ++slab;
    return slab;
}

}  // namespace neuralmesh
