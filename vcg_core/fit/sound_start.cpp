// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/sound_start.h"

#include <utility>

#include "vcg_core/base/ablation.h"
#include "vcg_core/fit/cut_faces.h"
#include "vcg_core/fit/refine.h"
#include "vcg_core/fit/untangle.h"
#include "vcg_core/mesh/surface.h"

namespace neuralmesh {

namespace {

/// With eight, half of an aerial survey is 1.02 times as far from its other half, and .6 % more of the mesh
/// faces the sky.
constexpr int kUnfoldingSweeps = 2;

/// 1 for the vertices of faces that are turned away.
PerVertex<char> folded(const Network& network, const Surface& surface) {
    PerVertex<char> inside(network.slot_count(), 0);
    for (int f = 0; f < surface.face_count(); ++f)
        if (surface.facing(area_vector(surface, f), surface.corner(f, 0)) < 0)
            for (const VertexId v : surface.faces[f]) inside[v] = 1;
    return inside;
}

/// In the image of the viewer.
Vector3 way_to_middle(const Ring& ring, VertexId v, const Surface& surface) {
    Vector3 middle = Vector3::Zero();
    for (const VertexId u : ring) middle += surface.positions[u] / static_cast<float>(ring.valence);
    const Vector3 way = middle - surface.positions[v],
                  sight = (*surface.viewer - surface.positions[v]).normalized();
    return way - sight * sight.dot(way);
}

}  // namespace

void unfold(Network& network) {
    if (!network.viewer() || network.face_count() == 0) return;
    Surface surface(network);
    const PerVertex<char> inside = folded(network, surface);
    for (int sweep = 0; sweep < kUnfoldingSweeps; ++sweep) {
        PerVertex<Vector3> moved = surface.positions;
        for (const VertexId v : network.vertices())
            if (inside[v] != 0 && network.ring(v).open == 0)
                moved[v] += way_to_middle(network.ring(v), v, surface) / 2;
        surface.positions = std::move(moved);
    }
    for (const VertexId v : network.vertices()) network.set_position(v, to_vcg(surface.positions[v]));
}

std::optional<std::vector<SelfCrossing>> make_sound(Network& network, ThreadTeam& team, Progress& progress) {
    unfold(network);
    std::optional<std::vector<SelfCrossing>> left = untangle(network, team, progress);
    if (!left || left->empty() || network.boundary_loop_count() == 0 || skips("cut_faces")) return left;
    NoProgress unasked;  // a stop from here on would leave fewer vertices
    const int vertices = network.vertex_count();
    std::vector<SelfCrossing> cuts = *left;
    remove_cut_faces(network, cuts, team);
    refine(network, vertices, NewVertices::on_edges, unasked);
    return self_crossings(Surface(network), team);
}

}  // namespace neuralmesh
