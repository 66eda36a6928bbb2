// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/points_by_face.h"

#include <numeric>

#include "vcg_core/base/parallel_for.h"
#include "vcg_core/mesh/face_tree.h"

namespace neuralmesh {

namespace {

constexpr std::size_t kPointChunk = 512;

}  // namespace

std::vector<Hit> nearest_by_tree(const Surface& surface, const TrackedPoints& tracked, ThreadTeam& team) {
    return FaceTree(surface, team).nearest(tracked.points, team);
}

std::vector<Hit> nearest_by_walk(const Surface& surface, const TrackedPoints& tracked, ThreadTeam& team) {
    std::vector<Hit> hits(tracked.points.size());
    for_chunks(hits.size(), kPointChunk, team, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            hits[i] = walk_to_nearest(surface, tracked.points[i], tracked.last_hit[i]);
    });
    return hits;
}

// A counting sort by face.
PointsByFace::PointsByFace(const Surface& surface, const TrackedPoints& tracked, const std::vector<Hit>& hits)
    : assignments_(hits.size()), weighted_(!tracked.weights.empty()), first_(surface.face_count() + 1, 0) {
    for (const Hit& hit : hits) ++first_[hit.face + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    PerFace<int> next = first_;
    for (std::size_t i = 0; i < hits.size(); ++i)
        assignments_[static_cast<std::size_t>(next[hits[i].face]++)] = {
            tracked.points[i], weighted_ ? tracked.weights[i] : 1.0F, hits[i].foot};
}

PerFace<float> PointsByFace::counts() const {
    PerFace<float> counts;
    for (int f = 0; f + 1 < first_.size(); ++f)
        counts.push_back(static_cast<float>(first_[f + 1] - first_[f]));
    return counts;
}

float PointsByFace::weight(int face) const {
    if (!weighted_) return static_cast<float>(of(face).size());
    float sum = 0;
    for (const Assignment& a : of(face)) sum += a.influence;
    return sum;
}

float PointsByFace::mean_weight(int f, int g) const {
    const int points = of(f).size() + of(g).size();
    return weighted_ && points > 0 ? (weight(f) + weight(g)) / static_cast<float>(points) : 1;
}

void PointsByFace::update_feet(const Surface& surface, ThreadTeam& team) {
    parallel_for(surface.face_count(), kPointChunk, team, [&](int face) {
        for (Assignment& a : of(face))
            a.foot = foot_on_triangle(a.point, surface.corner(face, 0), surface.corner(face, 1),
                                      surface.corner(face, 2));
    });
}

PointsByFace group_by_face(const Surface& surface, TrackedPoints& tracked, const std::vector<Hit>& hits,
                           ThreadTeam& team) {
    PointsByFace result(surface, tracked, hits);
    tracked.last_hit.resize(hits.size());
    parallel_for(surface.face_count(), kPointChunk, team, [&](int face) {
        auto i = static_cast<std::size_t>(result.of(face).begin() - result.all().data());
        for (const PointsByFace::Assignment& a : result.of(face)) {
            tracked.points[i] = a.point;
            if (!tracked.weights.empty()) tracked.weights[i] = a.influence;
            tracked.last_hit[i] = walk_start_of(surface, {face, a.foot});
            ++i;
        }
    });
    return result;
}

}  // namespace neuralmesh
