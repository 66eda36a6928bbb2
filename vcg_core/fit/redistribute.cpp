// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Costs of half-edge collapses, gains of edge splits, and which of them are carried out.
#include "vcg_core/fit/redistribute.h"

#include <algorithm>
#include <limits>

#include "vcg_core/base/parallel_for.h"
#include "vcg_core/fit/points_by_face.h"

namespace neuralmesh {

namespace {

constexpr std::size_t kChunk = 128;
constexpr float kSliver = 0.1F;         ///< triangle_quality() that the faces of a collapse must have
constexpr float kLeastTurn = 0.3F;      ///< cosine between the normals of a face before and after a collapse
constexpr float kSharpestFold = -0.5F;  ///< cosine between the normals of neighbouring faces
/// With fewer points than this in a star its area may not grow by more than kStretch.
constexpr int kFewPoints = 6;
constexpr float kStretch = 1.02F;
constexpr int kStarPoints = 64;         ///< about as many points of a star are enough to judge a collapse by
constexpr float kJudged = 0.4F;         ///< share of the vertices, those whose removal seems cheapest
constexpr int kTries = 3;               ///< neighbours to collapse into, the best by the quadric
constexpr float kLongestOffset = 0.3F;  ///< of a new vertex from its edge, in edge lengths

/// Finds the cheapest collapse of a vertex.
class CollapseJudge {
public:
    CollapseJudge(const Network& network, const Surface& surface, const PointsByFace& points,
                  const Support& support)
        : network_(network), surface_(surface), points_(points), support_(support) {}

    Collapse cheapest(VertexId v) const {
        Collapse best{std::numeric_limits<float>::max(), v, -1};
        const Ring& ring = network_.ring(v);
        std::array<std::pair<float, VertexId>, Ring::kMaxValence> order;
        int count = 0;
        for (int i = 0; i < ring.valence; ++i)
            if (network_.can_collapse(v, ring[i])) order[index(count++)] = {quadric(v, ring[i]), ring[i]};
        std::sort(order.begin(), order.begin() + count);
        int tries = 0;
        for (int i = 0; i < count && tries < kTries; ++i) {
            const VertexId into = order[index(i)].second;
            if (!keeps_shape(v, into)) continue;
            ++tries;
            const float cost = rise(v, into, best.cost);
            if (cost < best.cost) best = {cost, v, into};
        }
        return best;
    }

    /// About what the removal of \p v costs at least: the smallest quadric of its neighbours times the
    /// density of the points. 0 where points are missing, or nothing is covered.
    float estimate(VertexId v) const {
        const Ring& ring = network_.ring(v);
        const Star around = star(v);
        if (around.missing > 0 || ring.valence == 0 || !(around.area > 0)) return 0;
        float least = std::numeric_limits<float>::max();
        for (int i = 0; i < ring.valence; ++i) least = std::min(least, quadric(v, ring[i]));
        return least * static_cast<float>(around.count) / around.area;
    }

private:
    const Vector3& at(VertexId v) const { return surface_.at[index(v)]; }

    /// Squared distances of u from the planes of the faces around v, weighted with their areas.
    float quadric(VertexId v, VertexId u) const {
        float sum = 0;
        for (int i = surface_.first_face[index(v)]; i < surface_.first_face[index(v) + 1]; ++i) {
            const int f = surface_.face_of[index(i)];
            const Vector3 n = area_vector(surface_, f);
            const float norm = n.norm();
            const float height = n.dot(at(u) - at(v));
            if (norm > 0) sum += height * height / norm;
        }
        return sum;
    }

    bool keeps_shape(VertexId v, VertexId u) const {
        const Ring& ring = network_.ring(v);
        for (int i = 0; i < ring.face_count(); ++i) {
            const VertexId a = ring[i];
            const VertexId b = ring.next(i);
            if (a == u || b == u) continue;
            const Vector3 before = area_vector(at(v), at(a), at(b)).normalized();
            const Vector3 after = area_vector(at(u), at(a), at(b)).normalized();
            const Vector3 outside = normal_beyond(surface_, a, b);
            const float fold = before.dot(outside);
            if (!(before.dot(after) > kLeastTurn) && !(fold < kSharpestFold)) return false;
            if (after.dot(outside) < std::min(kSharpestFold, fold)) return false;
            if (triangle_quality(at(u), at(a), at(b)) <
                std::min(kSliver, triangle_quality(at(v), at(a), at(b))))
                return false;
        }
        return true;
    }

    struct Star {
        int count = 0;   ///< of points
        float area = 0;  ///< twice it
        float missing = 0;
    };

    Star star(VertexId v) const {
        Star result;
        for (int i = surface_.first_face[index(v)]; i < surface_.first_face[index(v) + 1]; ++i) {
            const int f = surface_.face_of[index(i)];
            const int count = points_.first[index(f) + 1] - points_.first[index(f)];
            const float area = area_vector(surface_, f).norm();
            result.count += count;
            result.area += area;
            result.missing += support_.missing(surface_.faces[index(f)], area, static_cast<float>(count));
        }
        return result;
    }

    /// Rise of the sum of squared distances of the points around v when it goes into u; some value of at
    /// least \p bound if it is not less, or if a face would stretch over where there are no points.
    float rise(VertexId v, VertexId u, float bound) const {
        const Ring& ring = network_.ring(v);
        const Star old = star(v);
        const int step = std::max(1, old.count / kStarPoints);
        std::array<int, Ring::kMaxValence> counts{};
        float sum = 0;
        int next = 0;
        for (int i = surface_.first_face[index(v)]; i < surface_.first_face[index(v) + 1]; ++i) {
            const auto f = index(surface_.face_of[index(i)]);
            const int begin = points_.first[f];
            const int size = points_.first[f + 1] - begin;
            for (; next < size; next += step) {
                const PointsByFace::Tie& tie = points_.ties[index(begin + next)];
                float least = std::numeric_limits<float>::max();
                int nearest = 0;
                for (int j = 0; j < ring.face_count(); ++j) {
                    const VertexId a = ring[j];
                    const VertexId b = ring.next(j);
                    if (a == u || b == u) continue;
                    const float d = foot_on_triangle(tie.point, at(u), at(a), at(b)).squared_distance;
                    if (d < least) nearest = j;
                    least = std::min(least, d);
                }
                counts[index(nearest)] += step;
                sum += tie.influence * (least - tie.foot.squared_distance) * static_cast<float>(step);
            }
            next -= size;
            if (sum > 2 * bound) return sum;
        }
        return std::max(sum, 0.0F) + rise_of_missing(ring, u, old, counts, step);
    }

    /// Of the points missing from the faces, in their value; without bound if surface would stretch over
    /// where there are no points.
    float rise_of_missing(const Ring& ring, VertexId u, const Star& old,
                          const std::array<int, Ring::kMaxValence>& counts, int step) const {
        constexpr float kTolerance = 0.5F;  // points
        float area = 0;
        float missing = 0;
        for (int j = 0; j < ring.face_count(); ++j) {
            const VertexId a = ring[j];
            const VertexId b = ring.next(j);
            if (a == u || b == u) continue;
            const float of_face = area_vector(at(u), at(a), at(b)).norm();
            area += of_face;
            missing += support_.missing({u, a, b}, of_face, static_cast<float>(counts[index(j)]));
        }
        const float rise = missing - old.missing;
        const bool stretched = old.count < kFewPoints && area > kStretch * old.area;
        if (rise > kTolerance * static_cast<float>(step) || (stretched && !(rise < 0)))
            return std::numeric_limits<float>::max();
        return rise < 0 ? rise * support_.value() : 0.0F;
    }

    const Network& network_;
    const Surface& surface_;
    const PointsByFace& points_;
    const Support& support_;
};

/// Sums for the offset of a new vertex in the middle of a face's edge, whose hat function is phi.
struct HatSums {
    float phi_residual = 0;
    float phi_phi = 0;
};

/// For the edges 0-1, 1-2, 2-0 of a face.
std::array<HatSums, 3> hat_sums(const Surface& surface, const PointsByFace& points, int face) {
    std::array<HatSums, 3> sums;
    const Vector3& a = surface.corner(face, 0);
    const Vector3& b = surface.corner(face, 1);
    const Vector3& c = surface.corner(face, 2);
    const Vector3 normal = area_vector(a, b, c).normalized();
    for (int i = points.first[index(face)]; i < points.first[index(face) + 1]; ++i) {
        const PointsByFace::Tie& tie = points.ties[index(i)];
        const float residual = normal.dot(tie.point - a);
        for (std::size_t k = 0; k < 3; ++k) {
            const float phi = 2 * std::min(tie.foot.weights[k], tie.foot.weights[(k + 1) % 3]);
            sums[k].phi_residual += tie.influence * phi * residual;
            sums[k].phi_phi += tie.influence * phi * phi;
        }
    }
    return sums;
}

/// The inner edges in whose middle a vertex gains at least \p least_gain.
std::vector<EdgeSplit> edge_splits(const Network& network, const Surface& surface, const PointsByFace& points,
                                   float least_gain, ThreadTeam& team) {
    std::vector<std::array<HatSums, 3>> sums(surface.faces.size());
    for_chunks(sums.size(), kChunk, team, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) sums[f] = hat_sums(surface, points, static_cast<int>(f));
    });
    std::vector<EdgeSplit> splits;
    const auto& at = surface.at;
    for (VertexId a = 0; a < network.slot_count(); ++a) {
        const Ring& ring = network.ring(a);
        for (int i = 0; i < ring.valence; ++i) {
            const VertexId b = ring[i];
            if (b < a || (ring.open != 0 && (i == 0 || i + 1 == ring.valence))) continue;
            HatSums both;
            Vector3 normal = Vector3::Zero();
            for (int j = surface.first_face[index(a)]; j < surface.first_face[index(a) + 1]; ++j) {
                const int f = surface.face_of[index(j)];
                const Triangle& face = surface.faces[index(f)];
                for (std::size_t k = 0; k < 3; ++k) {
                    const VertexId x = face[k];
                    const VertexId y = face[(k + 1) % 3];
                    if (!((x == a && y == b) || (x == b && y == a))) continue;
                    both.phi_residual += sums[index(f)][k].phi_residual;
                    both.phi_phi += sums[index(f)][k].phi_phi;
                    normal +=
                        area_vector(at[index(face[0])], at[index(face[1])], at[index(face[2])]).normalized();
                }
            }
            if (!(both.phi_phi > 0)) continue;
            const float bound = kLongestOffset * (at[index(a)] - at[index(b)]).norm();
            const float offset = std::min(std::max(both.phi_residual / both.phi_phi, -bound), bound);
            const float gain = both.phi_residual * both.phi_residual / both.phi_phi;
            if (gain < least_gain) continue;
            splits.push_back(
                {gain, a, b, 0.5F * (at[index(a)] + at[index(b)]) + offset * normal.normalized()});
        }
    }
    return splits;
}

/// The position in a's ring from which a split of the edge a-b takes three neighbours; -1 if it cannot be
/// split.
int split_position(const Network& network, VertexId a, VertexId b) {
    const Ring& ring = network.ring(a);
    const int i = ring.find(b);
    if (i < 0 || (ring.open != 0 && (i == 0 || i + 1 == ring.valence))) return -1;
    const int first = i == 0 ? ring.valence - 1 : i - 1;
    return network.can_split(a, first, 3) ? first : -1;
}

/// Carries out the collapse if it touches nothing that is touched. \return whether it did
bool collapse_untouched(Network& network, const Collapse& merger, std::vector<char>& touched) {
    const Ring ring = network.ring(merger.gone);
    bool free = touched[index(merger.gone)] == 0;
    for (int i = 0; i < ring.valence; ++i) free = free && touched[index(ring[i])] == 0;
    if (!free || !network.can_collapse(merger.gone, merger.into)) return false;
    touched[index(merger.gone)] = 1;
    for (int i = 0; i < ring.valence; ++i) touched[index(ring[i])] = 1;
    network.collapse(merger.gone, merger.into);
    return true;
}

}  // namespace

std::vector<Collapse> plan_reduction(const Network& network, const Surface& surface,
                                     const PointsByFace& points, ThreadTeam& team) {
    const Support support(network, surface, points);
    const CollapseJudge judge(network, surface, points, support);
    std::vector<Collapse> mergers(index(network.slot_count()));
    std::vector<float> estimates(mergers.size());
    for_chunks(estimates.size(), kChunk, team, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v)
            estimates[v] = network.alive(static_cast<VertexId>(v)) ? judge.estimate(static_cast<VertexId>(v))
                                                                   : std::numeric_limits<float>::max();
    });
    std::vector<float> sorted = estimates;
    const auto last = static_cast<std::size_t>(kJudged * static_cast<float>(network.vertex_count()));
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(last), sorted.end());
    for_chunks(mergers.size(), kChunk, team, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            const auto vertex = static_cast<VertexId>(v);
            mergers[v] = estimates[v] <= sorted[last]
                             ? judge.cheapest(vertex)
                             : Collapse{std::numeric_limits<float>::max(), vertex, -1};
        }
    });
    std::stable_sort(mergers.begin(), mergers.end(),
                     [](const auto& x, const auto& y) { return x.cost < y.cost; });
    return mergers;
}

Redistribution plan_redistribution(const Network& network, const Surface& surface, const PointsByFace& points,
                                   float least_gain, ThreadTeam& team) {
    Redistribution plan;
    plan.mergers = plan_reduction(network, surface, points, team);
    plan.splits = edge_splits(network, surface, points, least_gain, team);
    std::stable_sort(plan.splits.begin(), plan.splits.end(),
                     [](const auto& x, const auto& y) { return x.gain > y.gain; });
    return plan;
}

VertexMoves redistribute(Network& network, const Redistribution& plan, int most,
                         const std::vector<char>& barred) {
    // The splits claim their surroundings first: they are what all this is for.
    std::vector<char> touched = barred;
    std::vector<EdgeSplit> chosen;
    for (const EdgeSplit& split : plan.splits) {
        if (static_cast<int>(chosen.size()) >= most) break;
        const Ring& ring = network.ring(split.a);
        const int i = ring.find(split.b);
        const std::array<VertexId, 4> corners{split.a, split.b, ring.next(i), ring.previous(i)};
        if (split_position(network, split.a, split.b) < 0 ||
            std::any_of(corners.begin(), corners.end(), [&](VertexId v) { return touched[index(v)] != 0; }))
            continue;
        for (const VertexId v : corners) touched[index(v)] = 1;
        chosen.push_back(split);
    }
    VertexMoves result;
    for (const Collapse& merger : plan.mergers) {
        if (result.merges.size() >= chosen.size() || merger.into < 0 ||
            merger.cost >= chosen[result.merges.size()].gain)
            break;
        if (collapse_untouched(network, merger, touched)) result.merges.push_back({merger.gone, merger.into});
    }
    for (std::size_t i = 0; i < result.merges.size(); ++i) {
        const EdgeSplit& split = chosen[i];
        const VertexId added =
            network.split(split.a, split_position(network, split.a, split.b), 3, to_vcg(split.where));
        result.insertions.push_back({added, split.a});
    }
    return result;
}

std::vector<VertexMoves::DoneCollapse> reduce(Network& network, const std::vector<Collapse>& mergers,
                                              int most, const std::vector<char>& barred) {
    std::vector<char> touched = barred;
    std::vector<VertexMoves::DoneCollapse> merges;
    for (const Collapse& merger : mergers) {
        if (static_cast<int>(merges.size()) >= most || merger.into < 0) break;
        if (collapse_untouched(network, merger, touched)) merges.push_back({merger.gone, merger.into});
    }
    return merges;
}

}  // namespace neuralmesh
