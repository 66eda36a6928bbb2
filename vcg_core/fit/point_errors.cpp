// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/point_errors.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "vcg_core/base/parallel_for.h"
#include "vcg_core/mesh/face_tree.h"

namespace neuralmesh {

namespace {

constexpr std::size_t kHeldOutChunk = 512;

PerVertex<Vector3> smoothed_normals(const Network& network, const Surface& surface) {
    PerVertex<Vector3> normals = area_vectors_around(network, surface, kRingsOfNormals);
    for (Vector3& n : normals) n.normalize();
    return normals;
}

/// Root of the mean of \p squared by \p weights; empty: all weigh as much.
double root_mean(const std::vector<float>& squared, const std::vector<float>& weights) {
    double sum = 0;
    double all = 0;
    for (std::size_t i = 0; i < squared.size(); ++i) {
        const double weight = weights.empty() ? 1.0 : static_cast<double>(weights[i]);
        sum += weight * static_cast<double>(squared[i]);
        all += weight;
    }
    return std::sqrt(sum / all);
}

/// Squared distance from \p p to \p surface along the unit vector \p direction: that of the nearest foot.
/// Beyond the boundary, what lacks to meet it counts, too.
float squared_distance_along(const Vector3& direction, const Surface& surface, const Vector3& p,
                             WalkStart near) {
    const Hit hit = walk_to_nearest(surface, p, near);
    if (is_beyond_boundary(surface, hit)) return hit.foot.squared_distance;
    Vector3 foot = Vector3::Zero();
    for (int k = 0; k < 3; ++k)
        foot += hit.foot.weights[static_cast<std::size_t>(k)] * surface.corner(hit.face, k);
    const float along = (foot - p).dot(direction);
    return along * along;
}

}  // namespace

void HeldOut::locate(const Surface& surface, ThreadTeam& team) {
    group_by_face(surface, tracked_, nearest_by_tree(surface, tracked_, team), team);
}

void HeldOut::relocate(const Surface& surface, ThreadTeam& team) {
    const std::vector<Hit> hits = nearest_by_tree(surface, tracked_, team);
    for (std::size_t i = 0; i < hits.size(); ++i) tracked_.last_hit[i] = walk_start_of(surface, hits[i]);
}

void HeldOut::set_directions(const Network& network, const Surface& surface, ThreadTeam& team) {
    const PerVertex<Vector3> normals = smoothed_normals(network, surface);
    directions_.resize(tracked_.points.size());
    for_chunks(directions_.size(), kHeldOutChunk, team, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Hit hit = walk_to_nearest(surface, tracked_.points[i], tracked_.last_hit[i]);
            const Triangle& f = surface.faces[hit.face];
            const auto& w = hit.foot.weights;
            tracked_.last_hit[i] = walk_start_of(surface, hit);
            directions_[i] =
                (w[0] * normals[f[0]] + w[1] * normals[f[1]] + w[2] * normals[f[2]]).normalized();
        }
    });
}

double HeldOut::rms_error(const Surface& surface, float outlier_distance, ThreadTeam& team) const {
    std::vector<float> squared(tracked_.points.size());
    for_chunks(squared.size(), kHeldOutChunk, team, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const float along =
                squared_distance_along(directions_[i], surface, tracked_.points[i], tracked_.last_hit[i]);
            squared[i] = std::min(along, outlier_distance * outlier_distance);
        }
    });
    return root_mean(squared, tracked_.weights);
}

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
    std::vector<float> squared;
    for (const Hit& hit : hits) squared.push_back(hit.foot.squared_distance);
    return root_mean(squared, weights);
}

}  // namespace neuralmesh
