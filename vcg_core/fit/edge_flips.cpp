// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Which edges to flip: judged all at once from the same state, then flipped greedily.
#include "vcg_core/fit/edge_flips.h"

#include <algorithm>
#include <limits>

#include "vcg_core/base/parallel_for.h"
#include "vcg_core/fit/points_by_face.h"

namespace neuralmesh {

namespace {

constexpr float kSliver =
    0.1F;  ///< triangle_quality() that a new face must have, unless the old ones were worse
/// Cosine of the largest angle by which the normals of the new faces may differ from the mean of the old.
constexpr float kLeastTurn = 0.5F;
constexpr float kSharpestFold = -0.6F;  ///< cosine between the normals of neighbouring faces
constexpr float kUnfolding = 0.3F;      ///< rise of that cosine that makes a flip worth while for itself
constexpr float kFlat = 0.995F;  ///< cosine between normals from which the shape of the faces may decide

/// With fewer points than this the flip may not enlarge the area by more than kStretch.
constexpr float kFewPoints = 6;
constexpr float kStretch = 1.02F;

/// An inner edge a-b with its faces f = (a, b, c) and g = (b, a, d).
struct Quad {
    VertexId a, b, c, d;
    int f, g;
};

int face_with(const Surface& surface, VertexId a, VertexId b, VertexId c) {
    for (int i = surface.first_face[index(a)]; i < surface.first_face[index(a) + 1]; ++i) {
        const Triangle& face = surface.faces[index(surface.face_of[index(i)])];
        for (std::size_t k = 0; k < 3; ++k)
            if (face[k] == a && face[(k + 1) % 3] == b && face[(k + 2) % 3] == c)
                return surface.face_of[index(i)];
    }
    return -1;
}

Vector3 normal_of(const Vector3& a, const Vector3& b, const Vector3& c) {
    return area_vector(a, b, c).normalized();
}

class Judge {
public:
    Judge(const Surface& surface, const PointsByFace& points, const Support& support)
        : surface_(surface), points_(points), support_(support) {}

    /// Drop of the sum of squared distances by the flip of \p q; negative if the flip is out of the question.
    float gain(const Quad& q, float least_gain) const {
        const Vector3& a = at(q.a);
        const Vector3& b = at(q.b);
        const Vector3& c = at(q.c);
        const Vector3& d = at(q.d);
        const Vector3 old_f = normal_of(a, b, c);
        const Vector3 old_g = normal_of(b, a, d);
        const Vector3 new_f = normal_of(c, d, b);
        const Vector3 new_g = normal_of(d, c, a);
        // The other four edges of the quad, and its diagonal.
        const Vector3 bc = normal_beyond(surface_, q.b, q.c);
        const Vector3 ca = normal_beyond(surface_, q.c, q.a);
        const Vector3 ad = normal_beyond(surface_, q.a, q.d);
        const Vector3 db = normal_beyond(surface_, q.d, q.b);
        const float old_fold =
            std::min({old_f.dot(bc), old_f.dot(ca), old_g.dot(ad), old_g.dot(db), old_f.dot(old_g)});
        const float new_fold =
            std::min({new_f.dot(bc), new_g.dot(ca), new_g.dot(ad), new_f.dot(db), new_f.dot(new_g)});
        const bool unfolds = old_fold < kSharpestFold && new_fold > old_fold + kUnfolding;
        const Vector3 mean = (old_f + old_g).normalized();
        if (!unfolds && !(new_f.dot(mean) > kLeastTurn && new_g.dot(mean) > kLeastTurn)) return -1;
        if (new_fold < std::min(kSharpestFold, old_fold)) return -1;
        const float old_quality = std::min(triangle_quality(a, b, c), triangle_quality(b, a, d));
        const float new_quality = std::min(triangle_quality(c, d, b), triangle_quality(d, c, a));
        if (new_quality < std::min(kSliver, old_quality)) return -1;
        const float drop = distance_drop(q);
        if (unfolds && drop > -std::numeric_limits<float>::max()) return std::max(drop, least_gain);
        if (drop > least_gain) return drop;
        const bool indifferent =
            drop > -0.25F * least_gain && old_f.dot(old_g) > kFlat && new_f.dot(new_g) > kFlat;
        return indifferent && new_quality > 1.2F * old_quality ? 0.0F : -1.0F;
    }

private:
    const Vector3& at(VertexId v) const { return surface_.at[index(v)]; }

    /// \return a negative number for a flip that would stretch surface over where there are no points
    float distance_drop(const Quad& q) const {
        constexpr float kTolerance = 0.5F;  // points
        float drop = 0;
        float count = 0;
        float count_f = 0;
        for (const int face : {q.f, q.g}) {
            for (int i = points_.first[index(face)]; i < points_.first[index(face) + 1]; ++i) {
                const PointsByFace::Tie& tie = points_.ties[index(i)];
                const float f = foot_on_triangle(tie.point, at(q.c), at(q.d), at(q.b)).squared_distance;
                const float g = foot_on_triangle(tie.point, at(q.d), at(q.c), at(q.a)).squared_distance;
                drop += tie.influence * (tie.foot.squared_distance - std::min(f, g));
                count += 1;
                count_f += f < g ? 1.0F : 0.0F;
            }
        }
        const float old_missing =
            missing(q.a, q.b, q.c, points_of(q.f)) + missing(q.b, q.a, q.d, points_of(q.g));
        const float rise =
            missing(q.c, q.d, q.b, count_f) + missing(q.d, q.c, q.a, count - count_f) - old_missing;
        const bool stretched =
            count < kFewPoints && area(q.c, q.d, q.b) + area(q.d, q.c, q.a) >
                                      kStretch * (area(q.a, q.b, q.c) + area(q.b, q.a, q.d));
        if (rise > kTolerance || (stretched && !(rise < 0))) return -std::numeric_limits<float>::max();
        return rise < 0 ? drop - rise * support_.value() : drop;
    }

    float points_of(int face) const {
        return static_cast<float>(points_.first[index(face) + 1] - points_.first[index(face)]);
    }

    float missing(VertexId a, VertexId b, VertexId c, float count) const {
        return support_.missing({a, b, c}, area(a, b, c), count);
    }

    /// Twice it.
    float area(VertexId a, VertexId b, VertexId c) const { return area_vector(at(a), at(b), at(c)).norm(); }

    const Surface& surface_;
    const PointsByFace& points_;
    const Support& support_;
};

}  // namespace

std::vector<EdgeFlip> find_flips(const Network& network, const Surface& surface, const PointsByFace& points,
                                 float least_gain, ThreadTeam& team) {
    constexpr std::size_t kChunk = 256;
    const Support support(network, surface, points);
    const Judge judge(surface, points, support);
    const auto slots = index(network.slot_count());
    std::vector<std::vector<EdgeFlip>> found((slots + kChunk - 1) / kChunk);
    for_chunks(slots, kChunk, team, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            const auto a = static_cast<VertexId>(s);
            const Ring& ring = network.ring(a);
            for (int i = 0; i < ring.valence; ++i) {
                const VertexId b = ring[i];
                if (b < a || !network.can_flip(a, b)) continue;
                Quad q{a, b, ring.next(i), ring.previous(i), 0, 0};
                q.f = face_with(surface, a, b, q.c);
                q.g = face_with(surface, b, a, q.d);
                const float gain = judge.gain(q, least_gain);
                if (gain >= 0) found[chunk].push_back({gain, a, b});
            }
        }
    });
    std::vector<EdgeFlip> all;
    for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
    std::stable_sort(all.begin(), all.end(),
                     [](const EdgeFlip& x, const EdgeFlip& y) { return x.gain > y.gain; });
    return all;
}

int flip_edges(Network& network, const std::vector<EdgeFlip>& found, const std::vector<char>& barred) {
    // Quads with a face in common share three vertices.
    std::vector<char> touched(index(network.slot_count()), 0);
    int flips = 0;
    for (const EdgeFlip& flip : found) {
        const Ring& ring = network.ring(flip.a);
        const int i = ring.find(flip.b);
        if (i < 0 || !network.can_flip(flip.a, flip.b)) continue;
        const std::array<VertexId, 4> corners{flip.a, flip.b, ring.next(i), ring.previous(i)};
        const auto in = [&](const std::vector<char>& marks) {
            return std::count_if(corners.begin(), corners.end(),
                                 [&](VertexId v) { return marks[index(v)] != 0; });
        };
        if (in(touched) > 2 || in(barred) > 0) continue;
        network.flip(flip.a, flip.b);
        for (const VertexId v : corners) touched[index(v)] = 1;
        ++flips;
    }
    return flips;
}

}  // namespace neuralmesh
