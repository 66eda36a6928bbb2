// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/sound_start.h"

#include "vcg_core/base/ablation.h"
#include "vcg_core/fit/cut_faces.h"
#include "vcg_core/fit/refine.h"
#include "vcg_core/fit/unfold.h"
#include "vcg_core/fit/untangle.h"

namespace neuralmesh {

std::optional<std::vector<SelfCrossing>> make_sound(Network& network, ThreadTeam& team, Progress& progress) {
    unfold(network);
    std::optional<std::vector<SelfCrossing>> left = untangle(network, team, progress);
    if (!left || left->empty() || network.boundary_loop_count() == 0 || skips("cut_faces")) return left;
    NoProgress unasked;  // a stop from here on would leave fewer vertices
    const int vertices = network.vertex_count();
    std::vector<SelfCrossing> cuts = *left;
    const int removed = remove_cut_faces(network, Removal::inner_faces, cuts, team);
    if (removed == 0 && cuts.empty()) return left;  // all of them are apparent
    refine(network, vertices, NewVertices::on_edges, unasked);
    return self_crossings(Surface(network), team);
}

}  // namespace neuralmesh
