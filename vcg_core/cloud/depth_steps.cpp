// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/cloud/depth_steps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "vcg_core/cloud/local_quadric.h"

namespace neuralmesh {
namespace {

using Place = NearestPoints::Place;

/// Planes that are so few may be surfaces, as the treads of stairs are. Frames of depth cameras have 120 to
/// 510 values.
constexpr std::size_t kFewestValues = 32;
/// Shorter steps, in spacings, hide in the distances between the points. Coordinates that a file rounds come
/// to .5 along one axis, frames to 1.1 to 5.
constexpr float kLongSteps = 0.75F;

/// Variance in squared steps: a point at the share t between two steps is measured on either, on the mean
/// where it is, with the variance t (1 - t).
constexpr float kDithered = 1.0F / 6;

/// The values of coordinate \p axis that several of every \p stride-th point have, ascending: one alone lies
/// between two depths.
std::vector<float> shared_values(const NearestPoints& cloud, int axis, Place stride) {
    std::vector<float> values, shared;
    for (Place place = 0; place < cloud.size(); place += stride) values.push_back(cloud.point(place)[axis]);
    std::sort(values.begin(), values.end());
    for (std::size_t i = 1; i < values.size(); ++i)
        if (values[i] == values[i - 1] && (shared.empty() || shared.back() != values[i]))
            shared.push_back(values[i]);
    return shared;
}

/// Whether a sample of the points has values in common.
bool has_steps(const NearestPoints& cloud, int axis) {
    // Some eight points for each of 510 values.
    constexpr Place kSample = 4000;
    return shared_values(cloud, axis, std::max<Place>(1, cloud.size() / kSample)).size() >= kFewestValues;
}

/// Whether those of the points \p near \p p that share its coordinate \p axis cover an area.
bool share_an_area(const std::vector<vcg::Point3f>& near, const vcg::Point3f& p, int axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    float uu = 0, uv = 0, vv = 0;
    for (const vcg::Point3f& q : near) {
        if (q[axis] != p[axis]) continue;
        const float du = q[u] - p[u], dv = q[v] - p[v];
        uu += du * du;
        uv += du * dv;
        vv += dv * dv;
    }
    const float mean = (uu + vv) / 2, apart = std::sqrt((uu - vv) * (uu - vv) / 4 + uv * uv);
    return mean > 0 && mean - apart >= kNarrow * kNarrow * (mean + apart);
}

}  // namespace

DepthSteps::DepthSteps(const NearestPoints& cloud) {
    for (int axis = 0; axis < 3; ++axis) {
        if (has_steps(cloud, axis)) values_[static_cast<std::size_t>(axis)] = shared_values(cloud, axis, 1);
    }
}

float DepthSteps::deviation(const vcg::Point3f& p, const vcg::Point3f& normal, float spacing,
                            const std::vector<vcg::Point3f>& near) const {
    int with_steps = 0, rounded = 0;
    float deviation = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const std::vector<float>& values = values_[static_cast<std::size_t>(axis)];
        const auto next = std::upper_bound(values.begin(), values.end(), p[axis]);
        if (next - values.begin() < 2 || next == values.end()) continue;
        // Between surfaces that lie apart, the shorter one is a step.
        const float step = std::min(*next - p[axis], p[axis] - *(next - 2));
        if (step <= kLongSteps * spacing) continue;
        ++with_steps;
        rounded = axis;
        deviation = std::sqrt(kDithered) * step * std::abs(normal[axis]);
    }
    // With several, a grid, whose points are where it says.
    return with_steps == 1 && share_an_area(near, p, rounded) ? deviation : 0;
}

}  // namespace neuralmesh
