// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/thickening.h"

#include <cstddef>
#include <utility>

#include "vcg_core/base/parallel_for.h"
#include "vcg_core/fit/sound_moves.h"

namespace neuralmesh {

Thickening::Thickening(const LearningTask& task) {
    const WallSides& walls = task.walls;
    if (walls.faces.empty()) return;
    shell_.emplace(Network(walls.positions, walls.faces));
    tree_.emplace(*shell_);
    moves_.assign(shell_->positions.size(), Vector3::Zero());
    for (VertexId v = 0; v < moves_.size(); ++v) {
        for (const int f : shell_->faces_around(v)) moves_[v] += area_vector(*shell_, f);
        moves_[v] = walls.thickenings[static_cast<std::size_t>(v)] * moves_[v].normalized();
    }
}

Vector3 Thickening::move_at(const Vector3& p) const {
    const Hit hit = tree_->nearest(p);
    const Triangle& face = shell_->faces[hit.face];
    const auto& w = hit.foot.weights;
    return w[0] * moves_[face[0]] + w[1] * moves_[face[1]] + w[2] * moves_[face[2]];
}

std::optional<TargetSpace> Thickening::thicker(const LearningTask& task, ThreadTeam& team) const {
    if (!shell_) return std::nullopt;
    return task.target().moved([this](const vcg::Point3f& p) { return p + to_vcg(move_at(to_eigen(p))); },
                               team);
}

void Thickening::take_back(Network& network, ThreadTeam& team) const {
    if (!shell_) return;
    PerVertex<Vector3> moves(network.slot_count(), Vector3::Zero());
    constexpr int kChunk = 256;
    parallel_for(network.slot_count(), kChunk, team, [&](VertexId v) {
        if (network.alive(v)) moves[v] = -move_at(to_eigen(network.position(v)));
    });
    move_soundly(network, std::move(moves), team);
}

}  // namespace neuralmesh
