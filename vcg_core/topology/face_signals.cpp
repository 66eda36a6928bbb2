// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/topology/face_signals.h"

#include <algorithm>
#include <numeric>

#include "vcg_core/base/logarithm.h"
#include "vcg_core/mesh/face_tree.h"

namespace neuralmesh {
namespace {

void assign(const Surface& surface, const std::vector<Vector3>& signals, ThreadTeam& team,
            FaceSignals& support) {
    const std::vector<Hit> hits = FaceTree(surface, team).nearest(signals, team);
    support.wins.assign(surface.face_count(), 0);
    for (const Hit& hit : hits) ++support.wins[hit.face];
    support.first.assign(surface.face_count() + 1, 0);
    std::partial_sum(support.wins.begin(), support.wins.end(), support.first.begin() + 1);
    PerFace<int> next = support.first;
    support.signals.resize(signals.size());
    support.farthest.assign(surface.face_count(), 0);
    for (std::size_t i = 0; i < signals.size(); ++i) {
        const auto& [face, foot] = hits[i];
        support.signals[static_cast<std::size_t>(next[face]++)] = {signals[i], foot.squared_distance};
        support.farthest[face] = std::max(support.farthest[face], foot.squared_distance);
    }
}

/// Gives the vertices without a density that of their neighbours, ring by ring.
void extend(const Network& network, PerVertex<float>& density) {
    for (bool changed = true; changed;) {
        changed = false;
        const PerVertex<float> before = density;
        for (const VertexId v : network.vertices()) {
            if (before[v] > 0) continue;
            float sum = 0;
            int known = 0;
            for (const VertexId u : network.ring(v)) {
                if (before[u] <= 0) continue;
                sum += before[u];
                ++known;
            }
            if (known == 0) continue;
            density[v] = sum / static_cast<float>(known);
            changed = true;
        }
    }
}

/// Signals per area around every vertex.
PerVertex<float> densities(const Network& network, const Surface& surface, const PerFace<int>& wins) {
    // Of about 100 faces, with ten signals each: their number varies by 3 % by chance.
    constexpr int kRings = 4;
    PerFace<float> signals;
    for (const int won : wins) signals.push_back(won == 0 ? -1.0F : static_cast<float>(won));
    PerVertex<float> density = point_density(network, surface, signals, kRings);
    extend(network, density);
    return density;
}

}  // namespace

double FaceSignals::lack_of(const std::vector<int>& faces) const {
    double won = 0, expects = 0;
    for (const int f : faces) {
        won += wins[f];
        expects += static_cast<double>(expected[f]);
    }
    if (won >= expects) return 0;
    // Of Poisson distributions with one mean and the other.
    return expects - won + (won > 0 ? won * portable_log(won / expects) : 0);
}

std::vector<Vector3> fair_sample(const TargetSpace& target, std::size_t count, Random& random) {
    std::vector<Vector3> signals;
    const std::vector<vcg::Point3f>& points = target.positions();
    if (target.is_exact() || target.is_weighted()) {
        signals.reserve(count);
        while (signals.size() < count) signals.push_back(to_eigen(target.sample(random)));
        return signals;
    }
    count = std::min(count, points.size());
    signals.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t first = i * points.size() / count, end = (i + 1) * points.size() / count;
        signals.push_back(to_eigen(points[first + random.below(static_cast<std::uint32_t>(end - first))]));
    }
    return signals;
}

FaceSignals face_signals(const Network& network, const Surface& surface, const std::vector<Vector3>& signals,
                         ThreadTeam& team) {
    FaceSignals support;
    assign(surface, signals, team, support);
    support.area.resize(surface.face_count());
    for (int f = 0; f < surface.face_count(); ++f) support.area[f] = area_vector(surface, f).norm() / 2;
    support.density = densities(network, surface, support.wins);
    support.expected.resize(surface.face_count());
    for (int f = 0; f < surface.face_count(); ++f)
        support.expected[f] = support.expected_on(surface.faces[f], support.area[f]);
    return support;
}

}  // namespace neuralmesh
