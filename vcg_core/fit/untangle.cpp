// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Laplacian smoothing around the crossings.
#include "vcg_core/fit/untangle.h"

#include <algorithm>
#include <cstdint>

#include "vcg_core/fit/points_by_face.h"

namespace neuralmesh {

namespace {

constexpr int kRounds = 10;
constexpr int kSweeps = 2;
constexpr int kMostPairs = 100;  ///< of faces near each other, for each face; a smooth surface has six
constexpr int kMostRings = 3;    ///< around the crossings
constexpr float kStep = 0.5F;    ///< of the way to the ring's middle

/// The vertices of \p crossings and \p rings rings around them.
std::vector<char> surroundings(const Network& network, const std::vector<Crossing>& crossings, int rings) {
    std::vector<char> in(index(network.slot_count()), 0);
    for (const Crossing& crossing : crossings)
        for (const VertexId v : crossing) in[index(v)] = 1;
    for (int r = 0; r < rings; ++r) {
        const std::vector<char> before = in;
        for (VertexId v = 0; v < network.slot_count(); ++v) {
            const Ring& ring = network.ring(v);
            for (int i = 0; i < ring.valence; ++i)
                if (before[index(ring[i])] != 0) in[index(v)] = 1;
        }
    }
    return in;
}

void smooth(const Network& network, const std::vector<char>& where, std::vector<Vector3>& at) {
    const std::vector<Vector3> before = at;
    for (VertexId v = 0; v < network.slot_count(); ++v) {
        const Ring& ring = network.ring(v);
        if (where[index(v)] == 0 || ring.open != 0 || ring.valence == 0) continue;
        Vector3 middle = Vector3::Zero();
        for (int i = 0; i < ring.valence; ++i) middle += before[index(ring[i])];
        at[index(v)] += kStep * (middle / static_cast<float>(ring.valence) - before[index(v)]);
    }
}

/// Back to \p start around the \p crossings.
void take_back(const Network& network, const std::vector<Crossing>& crossings,
               const std::vector<Vector3>& start, std::vector<Vector3>& at) {
    const std::vector<char> where = surroundings(network, crossings, 2 * kMostRings);
    for (std::size_t v = 0; v < at.size(); ++v)
        if (where[v] != 0) at[v] = start[v];
}

}  // namespace

std::optional<std::vector<Crossing>> untangle(Network& network, ThreadTeam& team, Progress& progress) {
    const auto stopped = [&](int searches) {
        return !progress(static_cast<double>(searches) / (kRounds + 1),
                         "Fitting to the points: smoothing where the surface cuts itself");
    };
    if (stopped(0)) return std::nullopt;
    Surface surface(network);
    const std::vector<Vector3> start = surface.at;
    std::int64_t pairs = 0;
    std::vector<Crossing> at_start = crossings_of(surface, team, &pairs);
    if (at_start.empty() || pairs > kMostPairs * static_cast<std::int64_t>(surface.faces.size()))
        return at_start;
    const float furthest = mean_edge(surface);
    std::vector<Crossing> crossings = at_start;
    for (int round = 0; round < kRounds && !crossings.empty(); ++round) {
        if (stopped(round + 1)) return std::nullopt;
        const Surface before = surface;
        const int rings = std::min(1 + round / 2, kMostRings);
        const std::vector<char> where = surroundings(network, crossings, rings);
        for (int sweep = 0; sweep < kSweeps; ++sweep) smooth(network, where, surface.at);
        for (std::size_t v = 0; v < start.size(); ++v) {
            const Vector3 move = surface.at[v] - start[v];
            const float length = move.norm();
            if (length > furthest) surface.at[v] = start[v] + (furthest / length) * move;
        }
        crossings = crossings_after(surface, before, crossings, team);
    }
    if (!crossings.empty()) {
        const Surface before = surface;
        take_back(network, crossings, start, surface.at);
        crossings = crossings_after(surface, before, crossings, team);
    }
    if (!CrossingGuard(at_start).objections(crossings).empty()) return at_start;
    for (VertexId v = 0; v < network.slot_count(); ++v)
        if (network.alive(v)) network.set_position(v, to_vcg(surface.at[index(v)]));
    return crossings;
}

}  // namespace neuralmesh
