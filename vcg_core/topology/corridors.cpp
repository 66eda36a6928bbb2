// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/topology/corridors.h"

#include <algorithm>
#include <cmath>

#include "vcg_core/topology/membranes.h"

namespace neuralmesh {
namespace {

/// A place is clear if the next signal is further than this many spacings of the signals around. At 1.2
/// spacings that is chance at one place in a hundred; a row of such places is none.
constexpr float kSpacings = 1.2F;
/// Signals this many mean edges above or below the place count as well: a coarse surface misses them so far.
constexpr float kEdges = 0.6F;
/// Wider places need not be told apart, in spacings.
constexpr float kWidest = 10;
/// Places looked at on every edge, its ends left out.
constexpr int kPlaces = 3;

}  // namespace

Corridors::Corridors(const Surface& surface, const FaceSignals& support,
                     const std::vector<vcg::Point3f>& points, float edge, const PerFace<int>& membrane_of)
    : surface_(surface),
      support_(support),
      edge_(edge),
      points_per_signal_(static_cast<float>(points.size()) / static_cast<float>(support.signals.size())),
      near_(points),
      region_(surface.face_count(), -1) {
    for (int first = 0; first < surface.face_count(); ++first) {
        if (region_[first] >= 0 || membrane_of[first] >= 0) continue;
        std::vector<int> way{first};
        region_[first] = first;
        for (std::size_t i = 0; i < way.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                const Triangle& face = surface.faces[way[i]];
                const int next = face_beyond(surface, way[i], k);
                if (next < 0 || region_[next] >= 0 || membrane_of[next] >= 0 ||
                    !is_clear(face[k], face[(k + 1) % 3]))
                    continue;
                region_[next] = first;
                way.push_back(next);
            }
    }
}

float Corridors::spacing(float signals_per_area) const {
    return 1 / std::sqrt(signals_per_area * points_per_signal_);
}

bool Corridors::is_clear(VertexId a, VertexId b) const {
    const float density = (support_.density[a] + support_.density[b]) / 2;
    const float reach = kSpacings * spacing(density);
    const float off = std::max(reach, kEdges * edge_);
    const Vector3 normal = (normal_beyond(surface_, a, b) + normal_beyond(surface_, b, a)).normalized();
    for (int i = 1; i <= kPlaces; ++i) {
        const float along = static_cast<float>(i) / (kPlaces + 1);
        const Vector3 place = surface_.positions[a] + along * (surface_.positions[b] - surface_.positions[a]);
        const auto beside = [&](NearestPoints::Place p) {
            const Vector3 to = to_eigen(near_.point(p)) - place;
            return (to - normal * normal.dot(to)).squaredNorm() <= reach * reach;
        };
        if (!near_.any_within({place[0], place[1], place[2]}, off, beside)) return true;
    }
    return false;
}

std::set<int> Corridors::regions_at(const Rim& rim) const {
    std::set<int> found;
    for (std::size_t i = 0; i < rim.size(); ++i) {
        const VertexId a = rim[i], b = rim[(i + 1) % rim.size()];
        const int face = corner_of_edge(surface_, a, b).face;
        if (face >= 0 && region_[face] >= 0 && is_clear(a, b)) found.insert(region_[face]);
    }
    return found;
}

bool Corridors::lead(const Rim& from, const Rim& to) const {
    const std::set<int> here = regions_at(from), there = regions_at(to);
    return std::any_of(here.begin(), here.end(), [&](int region) { return there.count(region) != 0; });
}

float Corridors::widest(const std::vector<int>& faces) const {
    constexpr float kStep = 0.1F;
    const auto any = [](NearestPoints::Place /*place*/) { return true; };
    float widest = 0;
    for (const int f : faces) {
        float density = 0;
        for (const VertexId v : surface_.faces[f]) density += support_.density[v] / 3;
        const float unit = spacing(density);
        const Vector3 place = (surface_.corner(f, 0) + surface_.corner(f, 1) + surface_.corner(f, 2)) / 3;
        while (widest < kWidest &&
               !near_.any_within({place[0], place[1], place[2]}, (widest + kStep) * unit, any))
            widest += kStep;
    }
    return widest;
}

}  // namespace neuralmesh
