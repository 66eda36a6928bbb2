// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/topology/learned_topology.h"

#include <cstddef>
#include <set>

namespace neuralmesh {
namespace {

constexpr std::size_t kSignalsPerVertex = 30;
/// With fewer points per vertex, faces without any are common.
constexpr std::size_t kFewestPerVertex = 8;

/// With more points per vertex, the mesh is too coarse to tell a handle from a bridge: it has a bridge
/// wherever parts are closer than its edges are long.
constexpr std::size_t kMostPerVertex = 40;

/// The points by which handles are judged: all of the cloud, or \p signals if they have weights. None if the
/// mesh is too coarse.
std::vector<vcg::Point3f> points_for_handles(const TargetSpace& target, const std::vector<Vector3>& signals,
                                             std::size_t vertices) {
    if (target.is_exact() || target.positions().size() > kMostPerVertex * vertices) return {};
    if (!target.is_weighted()) return target.positions();
    std::vector<vcg::Point3f> points;
    points.reserve(signals.size());
    for (const Vector3& p : signals) points.emplace_back(p[0], p[1], p[2]);
    return points;
}

}  // namespace

std::vector<Reconnection> topology_changes(const Network& network, const TargetSpace& target, Random& random,
                                           ThreadTeam& team) {
    const Surface surface(network);
    if (surface.has_boundary()) return {};
    const auto vertices = static_cast<std::size_t>(network.vertex_count());
    if (!target.is_exact() && target.positions().size() < kFewestPerVertex * vertices) return {};
    const std::vector<Vector3> signals = fair_sample(target, kSignalsPerVertex * vertices, random);
    const FaceSignals support = face_signals(network, surface, signals, team);
    const std::vector<Membrane> membranes = find_membranes(surface, support);
    std::vector<Reconnection> chosen;
    std::set<int> used;
    const std::vector<vcg::Point3f> points = points_for_handles(target, signals, vertices);
    for (Reconnection& change : find_reconnections(network, surface, support, membranes, points)) {
        const auto taken = [&](int membrane) { return used.count(membrane) != 0; };
        if (std::any_of(change.membranes.begin(), change.membranes.end(), taken)) continue;
        used.insert(change.membranes.begin(), change.membranes.end());
        chosen.push_back(std::move(change));
    }
    return chosen;
}

}  // namespace neuralmesh
