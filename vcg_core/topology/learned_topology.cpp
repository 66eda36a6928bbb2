// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/topology/learned_topology.h"

#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "vcg_core/mesh/boundary_loops.h"

namespace neuralmesh {
namespace {

constexpr std::size_t kSignalsPerVertex = 20;
/// With fewer points per vertex, faces without any are common. With eight, feline from 20,000 points has two
/// handles with 10 of 30 seeds instead of 16.
constexpr std::size_t kFewestPerVertex = 6;

/// Of the signals that a membrane lacks, what another has to lack to be its counterpart. Along the rim of an
/// opening there may be small ones.
constexpr float kComparable = 0.2F;

float width_of(const Rim& rim, const Surface& surface) {
    std::vector<vcg::Point3f> points;
    points.reserve(rim.size());
    for (const VertexId v : rim) points.push_back(to_vcg(surface.positions[v]));
    return smallest_sphere_diameter(points);
}

}  // namespace

int most_examined(const TargetSpace& target) {
    // A stage may begin some vertices late.
    const std::size_t most = target.positions().size() / 100 * 96 / kFewestPerVertex;
    return target.is_exact() ? std::numeric_limits<int>::max() : static_cast<int>(most);
}

std::optional<TopologyEvidence> topology_evidence(const Network& network, const TargetSpace& target,
                                                  Random& random, ThreadTeam& team) {
    Surface surface(network);
    const auto vertices = static_cast<std::size_t>(network.vertex_count());
    if (surface.has_boundary() ||
        (!target.is_exact() && target.positions().size() < kFewestPerVertex * vertices))
        return std::nullopt;
    FaceSignals support =
        face_signals(network, surface, fair_sample(target, kSignalsPerVertex * vertices, random), team);
    std::vector<Membrane> membranes = find_membranes(surface, support);
    return TopologyEvidence{std::move(surface), std::move(support), std::move(membranes)};
}

std::vector<std::vector<Triangle>> membranes_to_open(const TopologyEvidence& now,
                                                     const TopologyRules& rules) {
    std::vector<std::vector<Triangle>> chosen;
    const float edge = mean_edge_length(now.surface);
    for (const Membrane& membrane : now.membranes) {
        if (!membrane.certain || membrane.rims.size() != 1 ||
            width_of(membrane.rims.front(), now.surface) < rules.opens_from)
            continue;
        // Two that face each other span a gap or plug a hole that was not understood.
        const auto faces_it = [&](const Membrane& other) {
            return &other != &membrane && other.missing > kComparable * membrane.missing &&
                   face_each_other(now.surface, membrane, other, edge);
        };
        if (std::any_of(now.membranes.begin(), now.membranes.end(), faces_it)) continue;
        chosen.emplace_back();
        for (const int f : membrane.faces) chosen.back().push_back(now.surface.faces[f]);
    }
    return chosen;
}

}  // namespace neuralmesh
