// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The quadric error (Garland and Heckbert 1997) chooses what is worth measuring, the points measure it.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "vcg_core/base/parallel_for.h"
#include "vcg_core/fit/face_rules.h"
#include "vcg_core/fit/redistribute.h"

namespace neuralmesh {

namespace {

constexpr int kCostChunk = 128;
constexpr int kStarPoints = 64;         ///< about as many points of a star are measured
constexpr float kExaminedShare = 0.4F;  ///< of the vertices
constexpr int kTries = 3;               ///< neighbours to collapse into

/// Points of the faces around a vertex, one of every few.
struct StarPoints {
    Support::Patch patch;                                 ///< of all points
    int step = 1;                                         ///< points that each one here stands for
    std::vector<const PointsByFace::Assignment*> points;  ///< face by face
    std::vector<std::size_t> face_ends;                   ///< where those of the faces end
};

/// Measures the collapses of vertices.
class CollapseCosts {
public:
    CollapseCosts(const Network& network, const Surface& surface, const PointsByFace& points,
                  const Support& support)
        : network_(network), surface_(surface), points_(points), support_(support) {}

    Collapse cheapest(VertexId v) const {
        Collapse best{Support::kForbidden, v, -1};
        std::array<std::pair<float, VertexId>, Ring::kMaxValence> order;
        std::size_t count = 0;
        for (VertexId u : network_.ring(v))
            if (network_.can_collapse(v, u)) order[count++] = {quadric(v, u), u};
        if (count == 0) return best;
        std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count));
        const StarPoints star = points_around(v);
        int tries = 0;
        for (std::size_t i = 0; i < count && tries < kTries; ++i) {
            const VertexId into = order[i].second;
            if (!keeps_shape(v, into)) continue;
            ++tries;
            const float cost = cost_of(star, v, into, best.cost);
            if (cost < best.cost) best = {cost, v, into};
        }
        return best;
    }

    /// About the least cost of removing \p v: the smallest quadric of its neighbours times the density of the
    /// points. 0 where the star lacks points or has no area.
    float estimate(VertexId v) const {
        const Support::Patch around = patch_of(v);
        if (around.missing_points > 0 || network_.ring(v).valence == 0 || !(around.twice_area > 0)) return 0;
        float least = Support::kForbidden;
        for (VertexId u : network_.ring(v)) least = std::min(least, quadric(v, u));
        float weight = 0;
        for (int f : surface_.faces_around(v)) weight += points_.weight(f);
        return least * weight / around.twice_area;
    }

private:
    const Vector3& at(VertexId v) const { return surface_.positions[v]; }

    /// Squared distances of \p u from the planes of the faces around \p v, weighted with twice their areas.
    float quadric(VertexId v, VertexId u) const {
        float sum = 0;
        for (int f : surface_.faces_around(v)) {
            const Vector3 n = area_vector(surface_, f);
            const float norm = n.norm();
            const float height = n.dot(at(u) - at(v));
            if (norm > 0) sum += height * height / norm;
        }
        return sum;
    }

    /// Calls \p visit(position, a, b) for the faces (v, a, b) of the star of \p v that become (u, a, b).
    template <class Visit>
    void for_new_faces(VertexId v, VertexId u, const Visit& visit) const {
        const Ring& ring = network_.ring(v);
        for (int i = 0; i < ring.face_count(); ++i) {
            const VertexId a = ring[i];
            const VertexId b = ring.next(i);
            if (a != u && b != u) visit(i, a, b);
        }
    }

    bool keeps_shape(VertexId v, VertexId u) const {
        bool keeps = true;
        for_new_faces(v, u, [&](int, VertexId a, VertexId b) {
            if (!keeps) return;
            const Vector3 before = unit_normal(at(v), at(a), at(b));
            const Vector3 after = unit_normal(at(u), at(a), at(b));
            const Vector3 outside = normal_beyond(surface_, a, b);
            const float fold = before.dot(outside);
            keeps = (!kCollapseRules.turns_over(before, after) || kCollapseRules.is_folded(fold)) &&
                    !surface_.turns_away(before, after, at(u)) &&
                    !kCollapseRules.folds(fold, after.dot(outside)) &&
                    !kCollapseRules.is_sliver(triangle_quality(at(v), at(a), at(b)),
                                              triangle_quality(at(u), at(a), at(b)));
        });
        return keeps;
    }

    Support::Patch patch_of(VertexId v) const {
        Support::Patch result;
        for (int f : surface_.faces_around(v))
            support_.add(result, surface_.faces[f], area_vector(surface_, f).norm(), points_.of(f).size());
        return result;
    }

    StarPoints points_around(VertexId v) const {
        StarPoints star;
        star.patch = patch_of(v);
        star.step = std::max(1, star.patch.points / kStarPoints);
        int next = 0;
        for (int f : surface_.faces_around(v)) {
            const Span<const PointsByFace::Assignment> of_face = points_.of(f);
            for (; next < of_face.size(); next += star.step) star.points.push_back(&of_face[next]);
            next -= of_face.size();
            star.face_ends.push_back(star.points.size());
        }
        return star;
    }

    /// Rise of the sum of squared distances of the points around \p v when it goes into \p u; a value of at
    /// least \p bound if it is not less, or if surface would stretch over where there are no points.
    float cost_of(const StarPoints& star, VertexId v, VertexId u, float bound) const {
        FewFaces faces;
        for_new_faces(v, u, [&](int i, VertexId a, VertexId b) { faces.add(at(u), at(a), at(b), i); });
        std::array<int, Ring::kMaxValence> counts{};  // points of the new faces, by ring position
        float sum = 0;
        std::size_t next = 0;
        for (const std::size_t end : star.face_ends) {
            for (; next < end; ++next) {
                const PointsByFace::Assignment& point = *star.points[next];
                const FewFaces::Nearest nearest = faces.nearest_to(point.point);
                counts[static_cast<std::size_t>(nearest.label)] += star.step;
                sum += point.influence * (nearest.squared_distance - point.foot.squared_distance) *
                       static_cast<float>(star.step);
            }
            // A heuristic: the points of the remaining faces rarely lower the sum by half.
            if (sum > 2 * bound) return sum;
        }
        const Support::Patch& before = star.patch;
        Support::Patch after;
        for_new_faces(v, u, [&](int i, VertexId a, VertexId b) {
            support_.add(after, {u, a, b}, area_vector(at(u), at(a), at(b)).norm(),
                         counts[static_cast<std::size_t>(i)]);
        });
        float cost = std::max(sum, 0.0F) + support_.cost_of_change(before, after, star.step);
        if (before.twice_area > 0)
            cost += static_cast<float>(before.points) * beyond_boundary(v, u) / (before.twice_area / 2);
        return cost;
    }

    /// If boundary vertex \p v goes into its neighbour \p u along the boundary, the new boundary edge may
    /// span a bay or a corner, where no points are. The squared distance from the faces around \p v,
    /// integrated over the surface there: by length x distance^3 / 3, as over a strip of which one side
    /// touches these faces.
    float beyond_boundary(VertexId v, VertexId u) const {
        const Ring& ring = network_.ring(v);
        const VertexId first = ring[0], last = ring[ring.valence - 1];
        if (ring.open == 0 || (u != first && u != last)) return 0;
        float sum = 0;
        // Evenly along the new edge. Its ends are corners of the faces: their distance is 0.
        for (const float share : {0.25F, 0.5F, 0.75F}) {
            const Vector3 p = at(first) + share * (at(last) - at(first));
            const float least = squared_distance_from(surface_, surface_.faces_around(v), p);
            sum += least * std::sqrt(least) / 3;
        }
        return sum * (at(last) - at(first)).norm() / 3;
    }

    const Network& network_;
    const Surface& surface_;
    const PointsByFace& points_;
    const Support& support_;
};

}  // namespace

std::vector<Collapse> find_collapses(const Network& network, const Surface& surface,
                                     const PointsByFace& points, ThreadTeam& team) {
    const Support support(network, surface, points);
    const CollapseCosts costs(network, surface, points, support);
    PerVertex<float> estimates(network.slot_count());
    parallel_for(estimates.size(), kCostChunk, team, [&](VertexId v) {
        estimates[v] = network.alive(v) ? costs.estimate(v) : Support::kForbidden;
    });
    std::vector<float> sorted = estimates.vector();
    const auto last = sorted.begin() + static_cast<std::ptrdiff_t>(
                                           kExaminedShare * static_cast<float>(network.vertex_count()));
    std::nth_element(sorted.begin(), last, sorted.end());
    std::vector<Collapse> collapses(sorted.size());
    parallel_for(estimates.size(), kCostChunk, team, [&](VertexId v) {
        collapses[static_cast<std::size_t>(v)] =
            estimates[v] <= *last ? costs.cheapest(v) : Collapse{Support::kForbidden, v, -1};
    });
    std::stable_sort(collapses.begin(), collapses.end(),
                     [](const Collapse& x, const Collapse& y) { return x.cost < y.cost; });
    return collapses;
}

}  // namespace neuralmesh
