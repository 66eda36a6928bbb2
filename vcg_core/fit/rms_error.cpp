// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/rms_error.h"

#include <cmath>
#include <cstddef>
#include <vector>

#include "vcg_core/mesh/face_tree.h"

namespace neuralmesh {

double rms_distance(const TargetSpace& target, const Network& network, int samples, Random& random) {
    const Surface surface(network);
    const FaceTree tree(surface);
    double sum = 0, weights = 0;
    const auto add = [&](const vcg::Point3f& point, double weight) {
        sum += weight * static_cast<double>(tree.nearest(to_eigen(point)).foot.squared_distance);
        weights += weight;
    };
    const std::vector<vcg::Point3f>& points = target.positions();
    if (!target.is_exact() && points.size() <= static_cast<std::size_t>(samples)) {
        for (std::size_t i = 0; i < points.size(); ++i) add(points[i], static_cast<double>(target.weight(i)));
    } else {
        for (int i = 0; i < samples; ++i) add(target.sample(random), 1);
    }
    return std::sqrt(sum / weights);
}

}  // namespace neuralmesh
