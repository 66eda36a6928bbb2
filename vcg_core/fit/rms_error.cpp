// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/rms_error.h"

#include <cmath>
#include <cstddef>
#include <vector>

#include "vcg_core/mesh/face_tree.h"

namespace neuralmesh {

double rms_distance(const TargetSpace& target, const Network& network, int samples, Random& random,
                    ThreadTeam& team) {
    const std::vector<vcg::Point3f>& positions = target.positions();
    const auto count = static_cast<std::size_t>(samples);
    const bool all = !target.is_exact() && positions.size() <= count;
    std::vector<Vector3> points;
    std::vector<float> weights;
    points.reserve(all ? positions.size() : count);
    if (all) {
        for (const vcg::Point3f& p : positions) points.push_back(to_eigen(p));
        for (std::size_t i = 0; i < positions.size(); ++i) weights.push_back(target.weight(i));
    } else {
        while (points.size() < count) points.push_back(to_eigen(target.sample(random)));
    }
    return rms_distance(points, weights, network, team);
}

double rms_distance(const std::vector<Vector3>& points, const std::vector<float>& weights,
                    const Network& network, ThreadTeam& team) {
    const std::vector<Hit> hits = FaceTree(Surface(network), team).nearest(points, team);
    double sum = 0, all = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const double weight = weights.empty() ? 1 : static_cast<double>(weights[i]);
        sum += weight * static_cast<double>(hits[i].foot.squared_distance);
        all += weight;
    }
    return std::sqrt(sum / all);
}

}  // namespace neuralmesh
