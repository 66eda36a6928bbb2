// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/learning/crease_measure.h"

#include <algorithm>
#include <cmath>

#include "vcg_core/base/parallel_for.h"
#include "vcg_core/learning/two_planes.h"

namespace neuralmesh {

namespace {

using vcg::Point3f;

// Chosen by tests/experiments/paper/features.py, whose results hardly change around these values.
constexpr float kUnit = 3;            ///< scales strengths so that 1 is the best threshold
constexpr float kLeastFall = 0.125F;  ///< how fast a strength up to 1 falls with the distance

/// 1 - |mean unit normal| of the faces around v: 0 where the surface is flat.
float normal_spread(const Network& network, VertexId v) {
    const Ring& ring = network.ring(v);
    const Point3f p = network.position(v);
    Point3f sum(0, 0, 0);
    Point3f a = network.position(ring[0]) - p;
    for (int i = 0; i < ring.face_count(); ++i) {
        const Point3f b = network.position(ring.next(i)) - p;
        sum += unit_or_zero(a ^ b);
        a = b;
    }
    return std::max(0.0F, 1 - sum.Norm() / static_cast<float>(ring.face_count()));
}

VertexId source_of(const PerVertex<VertexId>& source, VertexId v) { return source.empty() ? v : source[v]; }

/// f of every vertex of \p shown, by the planes of \p faces, those of \p base. Vertex v of \p shown lies near
/// source[v] of \p base and has the normal spread spreads[v].
PerVertex<float> crease_strengths(const Network& base, const FilteredFaces& faces, const Network& shown,
                                  const PerVertex<VertexId>& source, const PerVertex<float>& spreads,
                                  ThreadTeam& team) {
    constexpr std::size_t kLeastChunk = 512, kMostChunks = 16;  // each has TwoPlanes, O(faces)
    const auto slots = static_cast<std::size_t>(shown.slot_count());
    const std::size_t chunk = std::max(kLeastChunk, (slots + kMostChunks - 1) / kMostChunks);
    PerVertex<float> result(shown.slot_count(), 0);
    for_chunks(slots, chunk, team, [&](std::size_t, std::size_t begin, std::size_t end) {
        TwoPlanes planes(base, faces);
        for (auto v = static_cast<VertexId>(begin); v < static_cast<VertexId>(end); ++v) {
            if (!shown.alive(v)) continue;
            const Crease crease =
                planes.crease_near(shown.position(v), mean_edge_at(shown, v), source_of(source, v));
            const float strength = kUnit * crease.turn * std::sqrt(std::sqrt(spreads[v]));
            const float fall = std::max(kLeastFall, strength - 1);
            result[v] = strength / (1 + fall * 4 * crease.squared_distance);
        }
    });
    return result;
}

}  // namespace

void CreaseMeasure::observe(const Network& network, ThreadTeam& team) {
    constexpr int kChunk = 512;
    position_sums_.resize(network.slot_count(), Point3f(0, 0, 0));
    spread_sums_.resize(network.slot_count(), 0);
    parallel_for(network.slot_count(), kChunk, team, [&](VertexId v) {
        if (!network.alive(v)) return;
        position_sums_[v] += network.position(v);
        spread_sums_[v] += normal_spread(network, v);
    });
    ++moments_;
}

void CreaseMeasure::add(const CreaseMeasure& other) {
    if (other.moments_ == 0) return;  // it has no sums either
    position_sums_.resize(other.position_sums_.size(), Point3f(0, 0, 0));
    spread_sums_.resize(other.spread_sums_.size(), 0);
    for (VertexId v = 0; v < other.position_sums_.size(); ++v) {
        position_sums_[v] += other.position_sums_[v];
        spread_sums_[v] += other.spread_sums_[v];
    }
    moments_ += other.moments_;
}

PerVertex<float> CreaseMeasure::values(const Network& learned, const Network& shown,
                                       const PerVertex<VertexId>& source, ThreadTeam& team) const {
    if (moments_ == 0) {
        CreaseMeasure now;
        now.observe(learned, team);
        return now.values(learned, shown, source, team);
    }
    const auto moments = static_cast<float>(moments_);
    PerVertex<Point3f> means = position_sums_;
    for (Point3f& p : means) p /= moments;
    PerVertex<float> spreads(shown.slot_count(), 0);
    for (const VertexId v : shown.vertices()) spreads[v] = spread_sums_[source_of(source, v)] / moments;

    PerVertex<float> result =
        crease_strengths(learned, {learned, means, team}, shown, source, spreads, team);  // f
    if (!source.empty()) {
        const PerVertex<float> g =
            crease_strengths(shown, {shown, shown.positions(), team}, shown, {}, spreads, team);
        for (VertexId v = 0; v < result.size(); ++v)
            result[v] = std::sqrt(result[v] * std::sqrt(result[v] * g[v]));
    }
    for (float& value : result) value = std::sqrt(value);
    return result;
}

}  // namespace neuralmesh
