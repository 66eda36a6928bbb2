// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/thickening.h"

#include <cstddef>
#include <utility>

#include "vcg_core/fit/sound_meshes.h"

namespace neuralmesh {

Thickening::Thickening(const LearningTask& task, ThreadTeam& team) {
    const WallSides& walls = task.walls;
    if (walls.faces.empty()) return;
    const Network network(walls.positions, walls.faces);
    shell_.emplace(network);
    tree_.emplace(*shell_, team);
    moves_ = area_vectors_around(network, *shell_, 0);
    for (VertexId v = 0; v < moves_.size(); ++v)
        moves_[v] = walls.thickenings[static_cast<std::size_t>(v)] * moves_[v].normalized();
}

Vector3 Thickening::move_at(const Hit& hit) const {
    const Triangle& face = shell_->faces[hit.face];
    const auto& w = hit.foot.weights;
    return w[0] * moves_[face[0]] + w[1] * moves_[face[1]] + w[2] * moves_[face[2]];
}

std::vector<Vector3> Thickening::moves_at(const std::vector<Vector3>& points, ThreadTeam& team) const {
    std::vector<Vector3> moves;
    moves.reserve(points.size());
    for (const Hit& hit : tree_->nearest(points, team)) moves.push_back(move_at(hit));
    return moves;
}

std::optional<TargetSpace> Thickening::thicker(const LearningTask& task, ThreadTeam& team) const {
    if (!shell_) return std::nullopt;
    const TargetSpace& target = task.target();
    if (target.is_exact())
        return target.moved(
            [this](const vcg::Point3f& p) { return p + to_vcg(move_at(tree_->nearest(to_eigen(p)))); });
    return target.moved_in_batches([&](Span<vcg::Point3f> batch) {
        std::vector<Vector3> points;
        for (const vcg::Point3f& p : batch) points.push_back(to_eigen(p));
        const std::vector<Vector3> moves = moves_at(points, team);
        for (int i = 0; i < batch.size(); ++i) batch[i] += to_vcg(moves[static_cast<std::size_t>(i)]);
    });
}

void Thickening::take_back(Network& network, ThreadTeam& team) const {
    if (!shell_) return;
    std::vector<Vector3> positions;
    for (const VertexId v : network.vertices()) positions.push_back(to_eigen(network.position(v)));
    const std::vector<Vector3> at = moves_at(positions, team);
    PerVertex<Vector3> moves(network.slot_count(), Vector3::Zero());
    std::size_t next = 0;
    for (const VertexId v : network.vertices()) moves[v] = -at[next++];
    move_soundly(network, std::move(moves), team);
}

}  // namespace neuralmesh
