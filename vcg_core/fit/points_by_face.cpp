// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Points and their faces.
#include "vcg_core/fit/points_by_face.h"

#include <algorithm>
#include <numeric>

#include "vcg_core/base/parallel_for.h"

namespace neuralmesh {

namespace {

constexpr std::size_t kChunk = 512;

}  // namespace

Split choose_points(const TargetSpace& target, std::size_t wanted, Random& random) {
    constexpr std::size_t kMostDrawn = 2000000;
    constexpr std::size_t kHeldShare = 8;
    constexpr std::size_t kMostHeld = 10000;
    const auto& positions = target.positions();
    wanted = target.has_faces() ? std::min(wanted, std::max(kMostDrawn, wanted / 10))
                                : std::min(wanted, positions.size());
    const std::size_t held = std::min(wanted / kHeldShare, kMostHeld);
    Split split;
    split.held.points.reserve(held);
    split.fitted.points.reserve(wanted - held);
    const auto take = [&](const vcg::Point3f& p) {
        TrackedPoints& part = split.held.points.size() < held ? split.held : split.fitted;
        part.points.push_back(to_eigen(p));
    };
    if (target.has_faces()) {
        for (std::size_t i = 0; i < wanted; ++i) take(target.sample(random));
        return split;
    }
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0U);
    for (std::size_t i = 0; i < wanted; ++i) {
        std::swap(order[i], order[i + random.below(static_cast<std::uint32_t>(order.size() - i))]);
        take(positions[order[i]]);
    }
    return split;
}

float median(std::vector<float> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

float mean_edge(const Surface& surface) {
    double sum = 0;
    for (std::size_t f = 0; f < surface.faces.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k)
            sum += static_cast<double>(
                (surface.corner(static_cast<int>(f), k) - surface.corner(static_cast<int>(f), (k + 1) % 3))
                    .norm());
    return static_cast<float>(sum / (3 * static_cast<double>(surface.faces.size())));
}

std::vector<Hit> exact_hits(const Surface& surface, const TrackedPoints& followed, ThreadTeam& team) {
    const FaceTree tree(surface);
    std::vector<Hit> hits(followed.points.size());
    for_chunks(hits.size(), kChunk, team, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) hits[i] = tree.nearest(followed.points[i]);
    });
    return hits;
}

std::vector<Hit> walked_hits(const Surface& surface, const TrackedPoints& followed, ThreadTeam& team) {
    std::vector<Hit> hits(followed.points.size());
    for_chunks(hits.size(), kChunk, team, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            hits[i] = walk_to_nearest(surface, followed.points[i], followed.near[i]);
    });
    return hits;
}

PointsByFace by_face(const Surface& surface, TrackedPoints& followed, const std::vector<Hit>& hits) {
    PointsByFace result;
    result.first.assign(surface.faces.size() + 1, 0);
    for (const Hit& hit : hits) ++result.first[index(hit.face) + 1];
    std::partial_sum(result.first.begin(), result.first.end(), result.first.begin());
    result.ties.resize(hits.size());
    std::vector<int> next(result.first.begin(), result.first.end() - 1);
    for (std::size_t i = 0; i < hits.size(); ++i)
        result.ties[index(next[index(hits[i].face)]++)] = {followed.points[i], 1, hits[i].foot};
    followed.near.resize(hits.size());
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
        for (auto i = index(result.first[f]); i < index(result.first[f + 1]); ++i) {
            followed.points[i] = result.ties[i].point;
            followed.near[i] = walk_start_of(surface, {static_cast<int>(f), result.ties[i].foot});
        }
    }
    return result;
}

float noise_variance(const Surface& surface, const PointsByFace& points) {
    constexpr int kLeast = 4;
    std::vector<float> variances;
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
        const int count = points.first[f + 1] - points.first[f];
        if (count < kLeast) continue;
        const Vector3& a = surface.corner(static_cast<int>(f), 0);
        const Vector3 normal = area_vector(surface, static_cast<int>(f)).normalized();
        float sum = 0;
        float squares = 0;
        for (auto i = index(points.first[f]); i < index(points.first[f + 1]); ++i) {
            const float height = normal.dot(points.ties[i].point - a);
            sum += height;
            squares += height * height;
        }
        const auto n = static_cast<float>(count);
        variances.push_back(std::max(0.0F, squares - sum * sum / n) / (n - 1));
    }
    return variances.empty() ? 0.0F : median(std::move(variances));
}

Support::Support(const Network& network, const Surface& surface, const PointsByFace& points) {
    constexpr int kSpreads = 4;
    constexpr float kLikelyDistance = 0.25F;  // of such faces from the points, in mean edge lengths
    value_ = kLikelyDistance * mean_edge(surface);
    value_ *= value_;
    struct Around {
        float points = 0;
        float area = 0;
        void operator+=(const Around& other) {
            points += other.points;
            area += other.area;
        }
    };
    std::vector<Around> sums(surface.at.size());
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
        const float twice = area_vector(surface, static_cast<int>(f)).norm();
        for (const VertexId v : surface.faces[f]) {
            sums[index(v)].points += static_cast<float>(points.first[f + 1] - points.first[f]);
            sums[index(v)].area += twice;
        }
    }
    spread_over_rings(network, sums, kSpreads);
    density_.resize(sums.size());
    for (std::size_t v = 0; v < sums.size(); ++v)
        density_[v] = sums[v].area > 0 ? sums[v].points / sums[v].area : 0.0F;
}

std::vector<Vector3> smoothed_normals(const Network& network, const Surface& surface) {
    constexpr int kSpreads = 2;
    std::vector<Vector3> normals(surface.at.size(), Vector3::Zero());
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
        const Vector3 area = area_vector(surface, static_cast<int>(f));
        for (const VertexId v : surface.faces[f]) normals[index(v)] += area;
    }
    spread_over_rings(network, normals, kSpreads);
    for (Vector3& n : normals) n.normalize();
    return normals;
}

}  // namespace neuralmesh
