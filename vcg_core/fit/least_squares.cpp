// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Normal equations in 3x3 blocks along the one-rings. least_squares_solution.cpp solves them.
#include "vcg_core/fit/least_squares.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "vcg_core/base/median.h"
#include "vcg_core/base/parallel_for.h"
#include "vcg_core/fit/support.h"

namespace neuralmesh {

namespace {

/// Pull of a vertex to its present position, and towards the middle of its ring within the tangent plane, in
/// points per vertex.
constexpr float kWeakPull = 2e-3F;
/// Pull of a vertex that lacks points towards the middle of its ring, per missing point.
constexpr float kRetreat = 8.0F;
/// A boundary vertex has few points around it, which may miss as many by chance.
constexpr float kByChance = 1.5F;
/// Pull of a boundary edge to where the points end, in points per vertex. Chosen by open_table.py, as the
/// next.
constexpr float kBoundaryPull = 0.3F;
/// Weight of the bending of the boundary, in points per vertex.
constexpr float kBoundaryBending = 0.05F;
/// An edge counts as a crease from this many times the median gap.
constexpr float kCrease = 4.0F;

constexpr int kSystemChunk = 256;

float mean_of(const PerVertex<float>& values, const std::array<VertexId, 4>& corners) {
    return (values[corners[0]] + values[corners[1]] + values[corners[2]] + values[corners[3]]) / 4;
}

}  // namespace

PointToPlaneSystem::FaceSums PointToPlaneSystem::sum_over(const Surface& surface, const PointsByFace& points,
                                                          float hold, int face) {
    FaceSums sums;
    sums.force.fill(Vector3::Zero());
    const Vector3& a = surface.corner(face, 0);
    const Vector3& b = surface.corner(face, 1);
    const Vector3& c = surface.corner(face, 2);
    const Vector3 normal = unit_normal(a, b, c);
    for (const PointsByFace::Assignment& assignment : points.of(face)) {
        const auto& w = assignment.foot.weights;
        const Vector3 e = assignment.point - w[0] * a - w[1] * b - w[2] * c;
        const int zeros = (w[0] > 0 ? 0 : 1) + (w[1] > 0 ? 0 : 1) + (w[2] > 0 ? 0 : 1);
        // Boundary edges move sideways to their targets only.
        const bool inside =
            zeros == 0 || (zeros == 1 && is_beyond_boundary(surface, {face, assignment.foot}));
        const float length = e.norm();
        const Vector3 n = inside || length < 1e-9F ? normal : Vector3(e / length);
        Symmetric3 direction;
        direction.add(Symmetric3::outer(n), 1 - hold);
        direction.add_identity(hold);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t next = k == 2 ? 0 : k + 1;
            sums.pair[k].add(direction, assignment.influence * w[k] * w[k]);
            sums.pair[3 + k].add(direction, assignment.influence * w[k] * w[next]);
            sums.force[k] += assignment.influence * w[k] * e;
        }
    }
    return sums;
}

PointToPlaneSystem::PointToPlaneSystem(const Network& network, const Surface& surface,
                                       const PointsByFace& points, ThreadTeam& team, const VertexNoise& noise,
                                       float hold)
    : network_(network),
      points_per_vertex_(points.per_vertex(network.vertex_count())),
      row_(network.slot_count() + 1, 0),
      diagonal_(network.slot_count()),
      force_(network.slot_count(), Vector3::Zero()) {
    for (VertexId v = 0; v < network.slot_count(); ++v) row_[v + 1] = row_[v] + network.ring(v).valence;
    block_.resize(row_.back());
    const PerVertex<float> missing = missing_points_at_vertices(network, surface, points);
    PerFace<FaceSums> sums(surface.face_count());
    parallel_for(sums.size(), kSystemChunk, team,
                 [&](int f) { sums[f] = sum_over(surface, points, hold, f); });
    parallel_for(network.slot_count(), kSystemChunk, team, [&](VertexId v) {
        if (!network.alive(v)) return;
        gather(sums, surface, v);
        regularise(surface, missing[v], v);
    });
    add_bending(surface, noise, team);
    index_terms();
    for (const BoundaryTarget& target : find_boundary_targets(network, surface, points)) add_target(target);
    add_boundary_bending(surface);
}

void PointToPlaneSystem::gather(const PerFace<FaceSums>& sums, const Surface& surface, VertexId v) {
    const Ring& ring = network_.ring(v);
    for (int f : surface.faces_around(v)) {
        const Triangle& face = surface.faces[f];
        const std::size_t k = face[0] == v ? 0 : face[1] == v ? 1 : 2;
        const std::size_t before = k == 0 ? 2 : k - 1;
        const VertexId next = face[k == 2 ? 0 : k + 1];
        const VertexId previous = face[before];
        const FaceSums& of_face = sums[f];
        diagonal_[v].add(of_face.pair[k], 1);
        row(v)[ring.find(next)].add(of_face.pair[3 + k], 1);
        row(v)[ring.find(previous)].add(of_face.pair[3 + before], 1);
        force_[v] += of_face.force[k];
    }
}

void PointToPlaneSystem::regularise(const Surface& surface, float missing_points, VertexId v) {
    const Ring& ring = network_.ring(v);
    diagonal_[v].add_identity(kWeakPull * points_per_vertex_);
    const Vector3& here = surface.positions[v];
    Vector3 middle = Vector3::Zero();
    Vector3 normal = Vector3::Zero();
    for (const VertexId u : ring) middle += surface.positions[u];
    for (int i = 0; i < ring.face_count(); ++i)
        normal += area_vector(here, surface.positions[ring[i]], surface.positions[ring.next(i)]);
    normal.normalize();
    const Vector3 away = middle / static_cast<float>(ring.valence) - here;
    const float by_chance = ring.open != 0 ? kByChance : 0;
    const float retreat = kRetreat * std::max(0.0F, missing_points - by_chance);
    diagonal_[v].add_identity(retreat);
    force_[v] += retreat * away;
    if (ring.open != 0) return;  // the middle of the ring lies inside: the boundary would shrink
    const float pull = kWeakPull * points_per_vertex_;
    diagonal_[v].add_identity(pull);
    diagonal_[v].add(Symmetric3::outer(normal), -pull);
    force_[v] += pull * (away - away.dot(normal) * normal);
}

/// \return false if the quad has no area
bool PointToPlaneSystem::make_bending_term(const Surface& surface, const std::array<VertexId, 4>& corner,
                                           BendingTerm& term) {
    const Vector3& a = surface.positions[corner[0]];
    const Vector3 edge = surface.positions[corner[1]] - a;
    const Vector3 to_c = surface.positions[corner[2]] - a;
    const Vector3 to_d = surface.positions[corner[3]] - a;
    const float squared = edge.squaredNorm();
    const float height_c = edge.cross(to_c).norm();
    const float height_d = edge.cross(to_d).norm();
    if (!(height_c + height_d > 0) || !(squared > 0)) return false;
    // Unfolded, the diagonal c-d crosses the line of the edge at the share s from c and t along the edge.
    const float s = height_c / (height_c + height_d);
    // Far beyond the edge's ends t, the lever of one end, would grow without bound.
    const float t = std::min(std::max(((1 - s) * to_c + s * to_d).dot(edge) / squared, -1.0F), 2.0F);
    term = {corner, {t - 1, -t, 1 - s, s}, (1 - s) * to_c + s * to_d - t * edge, 1};
    return true;
}

void PointToPlaneSystem::add_bending(const Surface& surface, const VertexNoise& noise, ThreadTeam& team) {
    bending_force_.assign(surface.positions.size(), Vector3::Zero());
    bending_diagonal_.assign(surface.positions.size(), 0);
    stiff_diagonal_.assign(surface.positions.size(), 0);
    const auto find = [&](VertexId a, std::vector<BendingTerm>& found) {
        if (!network_.alive(a)) return;
        const Ring& ring = network_.ring(a);
        for (int i = 0; i < ring.valence; ++i) {
            BendingTerm term;
            if (ring[i] > a && !ring.is_boundary_edge(i) &&
                make_bending_term(surface, {a, ring[i], ring.next(i), ring.previous(i)}, term))
                found.push_back(term);
        }
    };
    bending_terms_ = parallel_collect<BendingTerm>(network_.slot_count(), kSystemChunk, team, find);
    if (bending_terms_.empty()) return;
    std::vector<float> gaps(bending_terms_.size());
    for_chunks(gaps.size(), kSystemChunk, team, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) gaps[i] = bending_terms_[i].gap.norm();
    });
    const float crease = std::max(kCrease * median(gaps), 1e-9F);
    for (std::size_t i = 0; i < gaps.size(); ++i) {
        BendingTerm& term = bending_terms_[i];
        float scale = crease;
        if (!noise.variances.empty())
            scale = std::max(scale, std::sqrt(mean_of(noise.variances, term.corner)));
        term.weight = points_per_vertex_ / (1 + (gaps[i] / scale) * (gaps[i] / scale));
        term.add_to(bending_force_, bending_diagonal_, term.weight);
        if (noise.stiffness.empty()) continue;
        term.stiffness = mean_of(noise.stiffness, term.corner);
        term.add_to(force_, stiff_diagonal_, term.stiffness * term.weight);
    }
}

/// A counting sort by vertex.
void PointToPlaneSystem::index_terms() {
    first_of_terms_.assign(network_.slot_count() + 1, 0);
    for (const BendingTerm& term : bending_terms_)
        for (const VertexId v : term.corner) ++first_of_terms_[v + 1];
    std::partial_sum(first_of_terms_.begin(), first_of_terms_.end(), first_of_terms_.begin());
    terms_by_vertex_.resize(first_of_terms_.back());
    PerVertex<std::size_t> next = first_of_terms_;
    for (std::size_t t = 0; t < bending_terms_.size(); ++t)
        for (std::size_t k = 0; k < 4; ++k)
            terms_by_vertex_[next[bending_terms_[t].corner[k]]++] = {t, bending_terms_[t].coefficient[k]};
}

void PointToPlaneSystem::add_target(const BoundaryTarget& target) {
    const Symmetric3 direction = Symmetric3::outer(target.outward);
    const float weight =
        kBoundaryPull * points_per_vertex_ * target.weight / static_cast<float>(target.parts);
    for (int i = 0; i < target.parts; ++i) {
        const float b = target.share(i);
        const float a = 1 - b;
        diagonal_[target.a].add(direction, weight * a * a);
        diagonal_[target.b].add(direction, weight * b * b);
        row(target.a)[network_.ring(target.a).find(target.b)].add(direction, weight * a * b);
        row(target.b)[network_.ring(target.b).find(target.a)].add(direction, weight * a * b);
        force_[target.a] += weight * a * target.offset(i) * target.outward;
        force_[target.b] += weight * b * target.offset(i) * target.outward;
    }
}

/// The gap of a boundary vertex: from the place on the line between its neighbours along the boundary that
/// divides it as the vertex divides the boundary.
void PointToPlaneSystem::add_boundary_bending(const Surface& surface) {
    std::vector<float> turns;
    for (VertexId v : network_.vertices()) {
        const Ring& ring = network_.ring(v);
        if (ring.open == 0) continue;
        const VertexId a = ring[0];
        const VertexId b = ring[ring.valence - 1];
        const Vector3 to_a = surface.positions[a] - surface.positions[v];
        const Vector3 to_b = surface.positions[b] - surface.positions[v];
        const float length = to_a.norm() + to_b.norm();
        if (!(length > 0)) continue;
        const float t = to_a.norm() / length;
        const Vector3 gap = (t - 1) * to_a - t * to_b;
        boundary_terms_.push_back({{v, a, b, v}, {1, t - 1, -t, 0}, gap, 1});
        turns.push_back(gap.norm() / length);
        centre_along((to_b - to_a).normalized(), 0.5F * (to_a + to_b), v);
    }
    if (turns.empty()) return;
    const float crease = std::max(kCrease * median(turns), 1e-9F);
    for (std::size_t i = 0; i < turns.size(); ++i) {
        BendingTerm& term = boundary_terms_[i];
        term.weight = kBoundaryBending * points_per_vertex_ / (1 + (turns[i] / crease) * (turns[i] / crease));
        for (std::size_t k = 0; k < 3; ++k) {
            const float c = term.coefficient[k];
            diagonal_[term.corner[k]].add_identity(term.weight * c * c);
            force_[term.corner[k]] -= term.weight * c * term.gap;
        }
    }
}

/// Pulls boundary vertex \p v along the boundary, by the part of \p away in the unit vector \p direction.
void PointToPlaneSystem::centre_along(const Vector3& direction, const Vector3& away, VertexId v) {
    const float pull = kWeakPull * points_per_vertex_;
    diagonal_[v].add(Symmetric3::outer(direction), pull);
    force_[v] += pull * away.dot(direction) * direction;
}

PerVertex<Vector3> PointToPlaneSystem::right_side(float lambda) const {
    PerVertex<Vector3> result(force_.size(), Vector3::Zero());
    for (VertexId v = 0; v < result.size(); ++v) result[v] = force_[v] + lambda * bending_force_[v];
    return result;
}

}  // namespace neuralmesh
