// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/sound_meshes.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "vcg_core/base/ablation.h"
#include "vcg_core/fit/move_limits.h"
#include "vcg_core/fit/redistribute.h"

namespace neuralmesh {

namespace {

constexpr int kRounds = 10;        ///< during the first four the neighbourhoods widen
constexpr int kRestoredRings = 6;  ///< around what remains; they get their old positions back
constexpr int kMaxPairs = 100;     ///< of overlapping face boxes per face; a smooth surface has six
constexpr int kMaxRings = 3;       ///< around the self-intersections
constexpr float kStep = 0.5F;      ///< of the way to the middle of the ring
/// Of smoothing, per round. With eight, half of an aerial survey is 1.02 times as far from its other half
/// once it is unfolded, and .6 % more of the mesh faces the sky.
constexpr int kSweeps = 2;

/// 1 for the vertices of \p intersections and of \p rings rings around them.
PerVertex<char> surroundings(const Network& network, const std::vector<SelfIntersection>& intersections,
                             int rings) {
    PerVertex<char> inside(network.slot_count(), 0);
    for (const SelfIntersection& intersection : intersections)
        for (VertexId v : intersection) inside[v] = 1;
    for (int r = 0; r < rings; ++r) {
        const PerVertex<char> before = inside;
        for (VertexId v : network.vertices())
            for (VertexId u : network.ring(v))
                if (before[u] != 0) inside[v] = 1;
    }
    return inside;
}

/// On a boundary, the middle of the two neighbours there.
Vector3 middle_of_ring(const Ring& ring, const PerVertex<Vector3>& positions) {
    if (ring.open != 0) return (positions[ring[0]] + positions[ring[ring.valence - 1]]) / 2;
    Vector3 middle = Vector3::Zero();
    for (VertexId u : ring) middle += positions[u];
    return middle / static_cast<float>(ring.valence);
}

/// Smooths the \p rings rings around the \p intersections. Boundary vertices move only if they are corners of
/// intersections: the others are where the points end.
void smooth(const Network& network, const std::vector<SelfIntersection>& intersections, int rings,
            PerVertex<Vector3>& positions) {
    const PerVertex<char> corners = surroundings(network, intersections, 0);
    const PerVertex<char> near = surroundings(network, intersections, rings);
    const PerVertex<Vector3> before = positions;
    for (VertexId v : network.vertices()) {
        const bool moves = network.ring(v).open != 0 ? corners[v] != 0 : near[v] != 0;
        if (moves) positions[v] += kStep * (middle_of_ring(network.ring(v), before) - before[v]);
    }
}

/// Shortens the moves from \p start to \p positions to the mean length of the edges of their vertex.
void limit_moves(const Network& network, const PerVertex<Vector3>& start, PerVertex<Vector3>& positions) {
    for (const VertexId v : network.vertices()) {
        const Vector3 move = positions[v] - start[v];
        if (move.isZero()) continue;
        const float longest = mean_edge_length_at(start, network.ring(v), v);
        if (move.norm() > longest) positions[v] = start[v] + (longest / move.norm()) * move;
    }
}

/// Takes back the moves in \p rings rings around the \p intersections.
void restore_around(const Network& network, const std::vector<SelfIntersection>& intersections, int rings,
                    const PerVertex<Vector3>& start, PerVertex<Vector3>& positions) {
    const PerVertex<char> where = surroundings(network, intersections, rings);
    for (VertexId v = 0; v < positions.size(); ++v)
        if (where[v] != 0) positions[v] = start[v];
}

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

std::optional<std::vector<SelfIntersection>> untangle(Network& network, ThreadTeam& team,
                                                      Progress& progress) {
    const auto stopped = [&](int searches) {
        return !progress(static_cast<double>(searches) / (kRounds + 1),
                         "Fitting to the points: smoothing where the surface cuts itself");
    };
    if (stopped(0)) return std::nullopt;
    Surface surface(network);
    const PerVertex<Vector3> start = surface.positions;
    std::int64_t pairs = 0;
    std::vector<SelfIntersection> at_start = self_intersections(surface, team, &pairs);
    if (at_start.empty() || pairs > std::int64_t{kMaxPairs} * surface.face_count()) return at_start;
    std::vector<SelfIntersection> intersections = at_start;
    for (int round = 0; round < kRounds && !intersections.empty(); ++round) {
        if (stopped(round + 1)) return std::nullopt;
        const Surface before = surface;
        const int rings = std::min(1 + round / 2, kMaxRings);
        for (int sweep = 0; sweep < kSweeps; ++sweep)
            smooth(network, intersections, rings, surface.positions);
        limit_moves(network, start, surface.positions);
        intersections = update_self_intersections(surface, before, intersections, team);
    }
    if (!intersections.empty()) {
        const Surface before = surface;
        restore_around(network, intersections, kRestoredRings, start, surface.positions);
        intersections = update_self_intersections(surface, before, intersections, team);
    }
    if (!IntersectionGuard(at_start).objections(intersections).empty()) return at_start;
    place_vertices(network, surface.positions);
    return intersections;
}

void unfold(Network& network) {
    if (!network.viewer() || network.face_count() == 0) return;
    Surface surface(network);
    const PerVertex<char> inside = folded(network, surface);
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        PerVertex<Vector3> moved = surface.positions;
        for (const VertexId v : network.vertices())
            if (inside[v] != 0 && network.ring(v).open == 0)
                moved[v] += kStep * way_to_middle(network.ring(v), v, surface);
        surface.positions = std::move(moved);
    }
    place_vertices(network, surface.positions);
}

std::optional<std::vector<SelfIntersection>> make_sound(Network& network, ThreadTeam& team,
                                                        Progress& progress) {
    unfold(network);
    std::optional<std::vector<SelfIntersection>> left = untangle(network, team, progress);
    if (!left || left->empty() || network.boundary_loop_count() == 0 || skips("cut_faces")) return left;
    NoProgress unasked;  // a stop from here on would leave fewer vertices
    const int vertices = network.vertex_count();
    std::vector<SelfIntersection> cuts = *left;
    remove_cut_faces(network, cuts, team);
    refine(network, vertices, NewVertices::on_edges, unasked);
    return self_intersections(Surface(network), team);
}

void move_soundly(Network& network, PerVertex<Vector3> moves, ThreadTeam& team) {
    NoProgress progress;
    IntersectionGuard guard(*untangle(network, team, progress));
    Surface surface(network);
    float left = total_length(moves);
    for (int step = 0; step < kMostSteps && left > 0; ++step) {
        const Surface start = surface;
        surface.positions = MoveLimits(network, start, team).without_intersections(moves, guard, team);
        for (const VertexId v : network.vertices()) moves[v] -= surface.positions[v] - start.positions[v];
        const float before = std::exchange(left, total_length(moves));
        if (before - left < kLeastGain * before) break;
    }
    place_vertices(network, surface.positions);
}

}  // namespace neuralmesh
