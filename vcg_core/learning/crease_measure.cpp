// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The feature statistic: mean mesh, bilateral face normals, two planes per vertex.
#include "vcg_core/learning/crease_measure.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace neuralmesh {

namespace {

using vcg::Point3f;

// Found by experiment; the results are flat around all of them.
constexpr int kSweeps = 4;  ///< of bilateral evening
constexpr float kAngleWidth =
    6;  ///< its width, squared, in medians of the squared difference of adjacent normals
constexpr float kWidest = 1;  ///< where creases are so many that the median is one
constexpr float kPlaneWidth =
    0.05F;                      ///< width, squared, of a plane's normals, in squared differences of the two
constexpr float kReach = 1.5F;  ///< at this many edge lengths a face counts half
constexpr int kPlaneRounds = 2;
constexpr float kOpposite = -0.9F;  ///< cosine below which two normals belong to the two sides of a thin part
constexpr float kTiny = 1e-30F;
constexpr float kUnit = 3;        ///< makes 1 the threshold
constexpr float kLeast = 0.125F;  ///< how fast a strength up to 1 falls with the distance

std::size_t at(VertexId i) { return static_cast<std::size_t>(i); }

Point3f unit(const Point3f& n) {
    const float length = n.Norm();
    return length > 0 ? n / length : Point3f(0, 0, 0);
}

float squared(float x) { return x * x; }

/// A weight that falls from 1 with the squared difference \p d of two normals; robust as exp(-d) is not cheap
/// to have in equal bits everywhere.
float similarity(float d, float width) { return 1 / squared(1 + d / width); }

/// 1 - |mean unit normal| of the faces around v: 0 where it is flat.
float normal_spread(const Network& network, VertexId v) {
    const Ring& ring = network.ring(v);
    const Point3f p = network.position(v);
    Point3f sum(0, 0, 0);
    Point3f a = network.position(ring[0]) - p;
    for (int i = 0; i < ring.face_count(); ++i) {
        const Point3f b = network.position(ring.next(i)) - p;
        sum += unit(a ^ b);
        a = b;
    }
    return std::max(0.0F, 1 - sum.Norm() / static_cast<float>(ring.face_count()));
}

float mean_edge(const Network& network, VertexId v) {
    const Ring& ring = network.ring(v);
    float sum = 0;
    for (int i = 0; i < ring.valence; ++i) sum += (network.position(ring[i]) - network.position(v)).Norm();
    return sum / static_cast<float>(ring.valence);
}

std::vector<Point3f> positions_of(const Network& network) {
    std::vector<Point3f> positions(at(network.slot_count()), Point3f(0, 0, 0));
    for (VertexId v = 0; v < network.slot_count(); ++v)
        if (network.alive(v)) positions[at(v)] = network.position(v);
    return positions;
}

/// The faces of a mesh with evened normals, and which of them lie around each vertex.
class MeanFaces {
public:
    MeanFaces(const Network& network, const std::vector<Point3f>& positions) : faces_(network.faces()) {
        starts_.assign(at(network.slot_count()) + 1, 0);
        for (const Triangle& f : faces_)
            for (const VertexId v : f) ++starts_[at(v) + 1];
        for (std::size_t v = 1; v < starts_.size(); ++v) starts_[v] += starts_[v - 1];
        around_.resize(3 * faces_.size());
        std::vector<int> next(starts_.begin(), starts_.end() - 1);
        for (std::size_t f = 0; f < faces_.size(); ++f) {
            const auto [a, b, c] = faces_[f];
            for (const VertexId v : faces_[f]) around_[at(next[at(v)]++)] = static_cast<int>(f);
            const Point3f n = (positions[at(b)] - positions[at(a)]) ^ (positions[at(c)] - positions[at(a)]);
            areas_.push_back(n.Norm() / 2);
            normals_.push_back(unit(n));
            centres_.push_back((positions[at(a)] + positions[at(b)] + positions[at(c)]) / 3);
        }
        even();
    }

    int begin(VertexId v) const { return starts_[at(v)]; }
    int end(VertexId v) const { return starts_[at(v) + 1]; }
    int face_at(int i) const { return around_[at(i)]; }
    std::size_t size() const { return faces_.size(); }
    const Point3f& normal(int f) const { return normals_[at(f)]; }
    const Point3f& centre(int f) const { return centres_[at(f)]; }
    float area(int f) const { return areas_[at(f)]; }

private:
    /// Bilateral filter: each normal becomes the mean of those of the faces around its corners, by area and
    /// similarity; a face across an edge counts twice, itself three times. (Zheng et al., "Bilateral normal
    /// filtering for mesh denoising", 2011.)
    void even() {
        const float width = std::min(kWidest, kAngleWidth * median_difference() + 1e-12F);
        std::vector<Point3f> evened(normals_.size());
        for (int sweep = 0; sweep < kSweeps; ++sweep) {
            for (std::size_t f = 0; f < faces_.size(); ++f) {
                Point3f sum(0, 0, 0);
                for (const VertexId v : faces_[f])
                    for (int i = starts_[at(v)]; i < starts_[at(v) + 1]; ++i) {
                        const std::size_t g = at(around_[at(i)]);
                        const float d = (normals_[g] - normals_[f]).SquaredNorm();
                        sum += normals_[g] * (areas_[g] * similarity(d, width));
                    }
                evened[f] = unit(sum);
            }
            normals_.swap(evened);
        }
    }

    bool holds(std::size_t f, VertexId v) const {
        return faces_[f][0] == v || faces_[f][1] == v || faces_[f][2] == v;
    }

    /// Median over the inner edges of the squared difference of the normals on both sides.
    float median_difference() const {
        std::vector<float> differences;
        for (std::size_t f = 0; f < faces_.size(); ++f)
            for (std::size_t k = 0; k < 3; ++k) {
                const VertexId a = faces_[f][k];
                const VertexId b = faces_[f][(k + 1) % 3];
                for (int i = begin(a); i < end(a); ++i) {
                    const std::size_t g = at(around_[at(i)]);
                    if (g > f && holds(g, b))
                        differences.push_back((normals_[g] - normals_[f]).SquaredNorm());
                }
            }
        if (differences.empty()) return 0;
        const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
        std::nth_element(differences.begin(), middle, differences.end());
        return *middle;
    }

    std::vector<Triangle> faces_;
    std::vector<int> starts_;
    std::vector<int> around_;
    std::vector<Point3f> normals_;
    std::vector<Point3f> centres_;
    std::vector<float> areas_;
};

/// What two planes say of a place.
struct Crease {
    float turn = 0;              ///< 2 - 2 cos(theta), theta the angle between them
    float squared_distance = 0;  ///< of the place from the line where they meet, in its edges
};

/// The two planes around a place.
class TwoPlanes {
public:
    explicit TwoPlanes(const MeanFaces& faces) : faces_(faces), seen_(faces.size(), -1) {}

    /// For a vertex at \p x with edges of \p edge, close to vertex \p v of \p network, where edges have
    /// \p mean_edge.
    Crease crease(const Network& network, VertexId v, const Point3f& x, float edge, float mean_edge) {
        gather(network, v, x, mean_edge);
        if (!seed()) return {};
        for (int round = 0; round < kPlaneRounds; ++round)
            if (!refine()) return {};
        const float e1 = normals_[0] * (x - points_[0]);
        const float e2 = normals_[1] * (x - points_[1]);
        const float cosine = normals_[0] * normals_[1];
        const float squared_sine = std::max(1 - cosine * cosine, cosine < 0 ? 1 - squared(kOpposite) : 1e-9F);
        const float squared_distance =
            std::max(0.0F, e1 * e1 + e2 * e2 - 2 * e1 * e2 * cosine) / squared_sine;
        return {std::max(0.0F, 2 - 2 * cosine), squared_distance / (edge * edge + kTiny)};
    }

private:
    struct Member {
        Point3f normal;
        Point3f centre;
        float weight;
    };

    void add_star(VertexId v, const Point3f& x, float reach) {
        for (int i = faces_.begin(v); i < faces_.end(v); ++i) {
            const int f = faces_.face_at(i);
            if (seen_[at(f)] == stamp_) continue;
            seen_[at(f)] = stamp_;
            const float far = (faces_.centre(f) - x).SquaredNorm() / (reach * reach + kTiny);
            members_.push_back({faces_.normal(f), faces_.centre(f), faces_.area(f) / (1 + far)});
        }
    }

    void gather(const Network& network, VertexId v, const Point3f& x, float mean_edge) {
        ++stamp_;
        members_.clear();
        const Ring& ring = network.ring(v);
        add_star(v, x, kReach * mean_edge);
        for (int i = 0; i < ring.valence; ++i) add_star(ring[i], x, kReach * mean_edge);
    }

    /// The two most different normals, opposite ones only if there is nothing else; false if all are the
    /// same.
    bool seed() { return seed_above(kOpposite) || seed_above(-2); }

    bool seed_above(float bound) {
        float least = 1 - 1e-6F;
        bool found = false;
        for (std::size_t i = 1; i < members_.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) {
                const float cosine = members_[i].normal * members_[j].normal;
                if (cosine >= least || cosine < bound) continue;
                least = cosine;
                normals_[0] = members_[i].normal;
                normals_[1] = members_[j].normal;
                found = true;
            }
        return found;
    }

    /// Each face to the plane whose normal is the more similar; then the planes anew. False if one has none.
    bool refine() {
        const float width = kPlaneWidth * (normals_[0] - normals_[1]).SquaredNorm() + 1e-9F;
        Point3f normals[2] = {{0, 0, 0}, {0, 0, 0}};
        Point3f points[2] = {{0, 0, 0}, {0, 0, 0}};
        float weights[2] = {0, 0};
        for (const Member& m : members_) {
            const float to[2] = {(m.normal - normals_[0]).SquaredNorm(),
                                 (m.normal - normals_[1]).SquaredNorm()};
            const int k = to[0] < to[1] ? 0 : 1;
            const float w = m.weight * similarity(to[k], width);
            normals[k] += m.normal * w;
            points[k] += m.centre * w;
            weights[k] += w;
        }
        for (int k = 0; k < 2; ++k) {
            if (!(weights[k] > 0)) return false;
            normals_[k] = unit(normals[k]);
            points_[k] = points[k] / weights[k];
        }
        return true;
    }

    const MeanFaces& faces_;
    std::vector<int> seen_;
    int stamp_ = 0;
    std::vector<Member> members_;
    Point3f normals_[2];
    Point3f points_[2];
};

VertexId own_or(const std::vector<VertexId>& origin, VertexId v) {
    return origin.empty() ? v : origin[at(v)];
}

/// f of every vertex of \p shown from the planes of \p positions, those of the network \p base, which has the
/// vertex origin[v] close to v. \p spreads are those of the vertices of \p shown.
std::vector<float> crease_strengths(const Network& base, const std::vector<Point3f>& positions,
                                    const Network& shown, const std::vector<VertexId>& origin,
                                    const std::vector<float>& spreads) {
    const MeanFaces faces(base, positions);
    TwoPlanes planes(faces);
    std::vector<float> result(at(shown.slot_count()), 0.0F);
    for (VertexId v = 0; v < shown.slot_count(); ++v) {
        if (!shown.alive(v)) continue;
        const VertexId o = own_or(origin, v);
        const Crease crease =
            planes.crease(base, o, shown.position(v), mean_edge(shown, v), mean_edge(base, o));
        const float strength = kUnit * crease.turn * std::sqrt(std::sqrt(spreads[at(v)]));
        result[at(v)] = strength / (1 + std::max(kLeast, strength - 1) * 4 * crease.squared_distance);
    }
    return result;
}

}  // namespace

void CreaseMeasure::observe(const Network& network) {
    position_sums_.resize(at(network.slot_count()), Point3f(0, 0, 0));
    spread_sums_.resize(at(network.slot_count()), 0.0F);
    for (VertexId v = 0; v < network.slot_count(); ++v) {
        if (!network.alive(v)) continue;
        position_sums_[at(v)] += network.position(v);
        spread_sums_[at(v)] += normal_spread(network, v);
    }
    ++moments_;
}

std::vector<float> CreaseMeasure::values(const Network& learned) const {
    return values(learned, learned, {});
}

std::vector<float> CreaseMeasure::values(const Network& learned, const Network& shown,
                                         const std::vector<VertexId>& origin) const {
    if (moments_ == 0) {
        CreaseMeasure now;
        now.observe(learned);
        return now.values(learned, shown, origin);
    }
    const auto moments = static_cast<float>(moments_);
    std::vector<Point3f> means = position_sums_;
    for (Point3f& p : means) p /= moments;
    std::vector<float> spreads(at(shown.slot_count()), 0.0F);
    for (VertexId v = 0; v < shown.slot_count(); ++v)
        if (shown.alive(v)) spreads[at(v)] = spread_sums_[at(own_or(origin, v))] / moments;

    std::vector<float> result = crease_strengths(learned, means, shown, origin, spreads);
    if (!origin.empty()) {
        const std::vector<float> of_shown = crease_strengths(shown, positions_of(shown), shown, {}, spreads);
        for (std::size_t v = 0; v < result.size(); ++v)
            result[v] = std::sqrt(result[v] * std::sqrt(result[v] * of_shown[v]));
    }
    for (float& value : result) value = std::sqrt(value);
    return result;
}

}  // namespace neuralmesh
