// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Every edge is judged on the same state of the network; then edges are flipped greedily.
#include "vcg_core/fit/edge_flips.h"

#include <algorithm>
#include <array>

#include "vcg_core/base/parallel_for.h"
#include "vcg_core/fit/face_rules.h"
#include "vcg_core/fit/support.h"

namespace neuralmesh {

namespace {

constexpr int kFlipChunk = 256;
/// Rise of the cosine between the normals of folded neighbours that makes a flip worth while by itself.
constexpr float kUnfolding = 0.3F;
/// Where the quad is flat, by the cosine between its normals, and the distances rise by less than this share
/// of the least gain, a flip is made if it raises the smaller quality by this factor.
constexpr float kFlat = 0.995F;
constexpr float kIndifferent = 0.25F;
constexpr float kBetterShape = 1.2F;

/// An inner edge a-b with its faces f = (a, b, c) and g = (b, a, d). The flip makes them (c, d, b) and
/// (d, c, a).
struct Quad {
    VertexId a, b, c, d;
    int f, g;
};

/// Judges the flips of edges.
class FlipGains {
public:
    FlipGains(const Surface& surface, const PointsByFace& points, const Support& support)
        : surface_(surface), points_(points), support_(support) {}

    /// Drop of the sum of squared distances by the flip of \p q; negative if the flip must not be made.
    float gain(const Quad& q, float least_gain) const {
        least_gain *= points_.mean_weight(q.f, q.g);
        const Shape shape = shape_of(q);
        if (!shape.unfolds && shape.turns_over) return -1;
        if (kFlipRules.folds(shape.old_fold, shape.new_fold)) return -1;
        if (kFlipRules.is_sliver(shape.old_quality, shape.new_quality)) return -1;
        const float drop = distance_drop(q);
        if (drop == -Support::kForbidden) return -1;
        if (shape.unfolds) return std::max(drop, least_gain);
        if (drop > least_gain) return drop;
        const bool indifferent = drop > -kIndifferent * least_gain && shape.flat;
        return indifferent && shape.new_quality > kBetterShape * shape.old_quality ? 0.0F : -1.0F;
    }

private:
    /// A quad before and after the flip. Folds are the smallest cosines between the normals of neighbours.
    struct Shape {
        float old_fold, new_fold;
        float old_quality, new_quality;
        bool turns_over, unfolds, flat;
    };

    Shape shape_of(const Quad& q) const {
        const Vector3& a = at(q.a);
        const Vector3& b = at(q.b);
        const Vector3& c = at(q.c);
        const Vector3& d = at(q.d);
        const Vector3 old_f = unit_normal(a, b, c);
        const Vector3 old_g = unit_normal(b, a, d);
        const Vector3 new_f = unit_normal(c, d, b);
        const Vector3 new_g = unit_normal(d, c, a);
        const Vector3 bc = normal_beyond(surface_, q.b, q.c);
        const Vector3 ca = normal_beyond(surface_, q.c, q.a);
        const Vector3 ad = normal_beyond(surface_, q.a, q.d);
        const Vector3 db = normal_beyond(surface_, q.d, q.b);
        const Vector3 mean = (old_f + old_g).normalized();
        Shape shape;
        shape.old_fold =
            std::min({old_f.dot(bc), old_f.dot(ca), old_g.dot(ad), old_g.dot(db), old_f.dot(old_g)});
        shape.new_fold =
            std::min({new_f.dot(bc), new_g.dot(ca), new_g.dot(ad), new_f.dot(db), new_f.dot(new_g)});
        shape.old_quality = std::min(triangle_quality(a, b, c), triangle_quality(b, a, d));
        shape.new_quality = std::min(triangle_quality(c, d, b), triangle_quality(d, c, a));
        const auto turns = [&](const Vector3& n) {
            return kFlipRules.turns_over(mean, n) ||
                   (surface_.turns_away(old_f, n, a) && surface_.turns_away(old_g, n, a));
        };
        shape.turns_over = turns(new_f) || turns(new_g);
        shape.unfolds = kFlipRules.is_folded(shape.old_fold) && shape.new_fold > shape.old_fold + kUnfolding;
        shape.flat = old_f.dot(old_g) > kFlat && new_f.dot(new_g) > kFlat;
        return shape;
    }

    const Vector3& at(VertexId v) const { return surface_.positions[v]; }

    /// \return -Support::kForbidden for a flip that would stretch surface over where there are no points
    float distance_drop(const Quad& q) const {
        FewFaces faces;  // 0 takes the place of f, 1 that of g; of equally near ones 1 counts
        faces.add(at(q.d), at(q.c), at(q.a), 1);
        faces.add(at(q.c), at(q.d), at(q.b), 0);
        float drop = 0;
        std::array<int, 2> counts{};
        for (int face : {q.f, q.g}) {
            for (const PointsByFace::Assignment& point : points_.of(face)) {
                const FewFaces::Nearest nearest = faces.nearest_to(point.point);
                drop += point.influence * (point.foot.squared_distance - nearest.squared_distance);
                ++counts[static_cast<std::size_t>(nearest.label)];
            }
        }
        Support::Patch before;
        Support::Patch after;
        add(before, {q.a, q.b, q.c}, points_.of(q.f).size());
        add(before, {q.b, q.a, q.d}, points_.of(q.g).size());
        add(after, {q.c, q.d, q.b}, counts[0]);
        add(after, {q.d, q.c, q.a}, counts[1]);
        const float cost = support_.cost_of_change(before, after);
        return cost == Support::kForbidden ? -Support::kForbidden : drop - cost;
    }

    void add(Support::Patch& patch, const Triangle& face, int points) const {
        support_.add(patch, face, area_vector(face, surface_.positions).norm(), points);
    }

    const Surface& surface_;
    const PointsByFace& points_;
    const Support& support_;
};

}  // namespace

std::vector<EdgeFlip> find_flips(const Network& network, const Surface& surface, const PointsByFace& points,
                                 float least_gain, ThreadTeam& team, const PerVertex<float>& variances) {
    const Support support(network, surface, points);
    const FlipGains gains(surface, points, support);
    std::vector<EdgeFlip> flips = parallel_collect<EdgeFlip>(
        network.slot_count(), kFlipChunk, team, [&](VertexId a, std::vector<EdgeFlip>& found) {
            const Ring& ring = network.ring(a);
            for (int i = 0; i < ring.valence; ++i) {
                const VertexId b = ring[i];
                if (b < a || !network.can_flip(a, b)) continue;
                const Quad q{a,
                             b,
                             ring.next(i),
                             ring.previous(i),
                             corner_of_edge(surface, a, b).face,
                             corner_of_edge(surface, b, a).face};
                const float variance =
                    variances.empty() ? 1.0F
                                      : (variances[a] + variances[b] + variances[q.c] + variances[q.d]) / 4;
                const float gain = gains.gain(q, least_gain * variance);
                if (gain >= 0) found.push_back({gain, a, b});
            }
        });
    std::stable_sort(flips.begin(), flips.end(),
                     [](const EdgeFlip& x, const EdgeFlip& y) { return x.gain > y.gain; });
    return flips;
}

int flip_edges(Network& network, const std::vector<EdgeFlip>& found, const PerVertex<char>& barred) {
    PerVertex<char> touched(network.slot_count(), 0);
    int flips = 0;
    for (const EdgeFlip& flip : found) {
        const Ring& ring = network.ring(flip.a);
        const int i = ring.find(flip.b);
        if (i < 0 || !network.can_flip(flip.a, flip.b)) continue;
        const std::array<VertexId, 4> corners{flip.a, flip.b, ring.next(i), ring.previous(i)};
        const auto count_in = [&](const PerVertex<char>& marks) {
            return std::count_if(corners.begin(), corners.end(), [&](VertexId v) { return marks[v] != 0; });
        };
        // Quads with a face in common share three vertices.
        if (count_in(touched) > 2 || count_in(barred) > 0) continue;
        network.flip(flip.a, flip.b);
        for (VertexId v : corners) touched[v] = 1;
        ++flips;
    }
    return flips;
}

}  // namespace neuralmesh
