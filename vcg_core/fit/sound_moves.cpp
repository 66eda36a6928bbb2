// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/sound_moves.h"

#include <optional>
#include <utility>
#include <vector>

#include "vcg_core/base/progress.h"
#include "vcg_core/fit/move_limits.h"
#include "vcg_core/fit/untangle.h"

namespace neuralmesh {

namespace {

/// Moves through a wall as thick as its edges are long take four to eight.
constexpr int kMostSteps = 12;
/// The steps end when one covers less than this share of the way that is left: what is left is held up.
constexpr float kLeastGain = 0.02F;

float total_length(const PerVertex<Vector3>& moves) {
    float sum = 0;
    for (const Vector3& move : moves) sum += move.norm();
    return sum;
}

}  // namespace

void move_soundly(Network& network, PerVertex<Vector3> moves, ThreadTeam& team) {
    NoProgress progress;
    CrossingGuard guard(*untangle(network, team, progress));
    Surface surface(network);
    float left = total_length(moves);
    for (int step = 0; step < kMostSteps && left > 0; ++step) {
        const Surface start = surface;
        surface.positions = MoveLimits(network, start, team).without_crossings(moves, guard, team);
        for (const VertexId v : network.vertices()) moves[v] -= surface.positions[v] - start.positions[v];
        const float before = std::exchange(left, total_length(moves));
        if (before - left < kLeastGain * before) break;
    }
    for (const VertexId v : network.vertices()) network.set_position(v, to_vcg(surface.positions[v]));
}

}  // namespace neuralmesh
