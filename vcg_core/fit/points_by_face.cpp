// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/points_by_face.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

#include "vcg_core/base/parallel_for.h"
#include "vcg_core/cloud/surface_survey.h"
#include "vcg_core/mesh/face_tree.h"

namespace neuralmesh {

namespace {

constexpr std::size_t kPointChunk = 512;

/// Faces have points without end, and each takes memory and time.
constexpr std::size_t kMaxDrawn = 2000000;
/// One point in so many is held out: of few points most have to be fitted.
constexpr std::size_t kHeldOutShare = 8;
/// A root mean square over n normal deviates varies by 1 / sqrt(2 n) of itself by chance: here a 141st.
constexpr std::size_t kMaxHeldOut = 10000;

/// Receives the chosen points in random order.
class Chosen {
public:
    explicit Chosen(std::size_t count) : held_out_(std::min(count / kHeldOutShare, kMaxHeldOut)) {
        choice_.held_out.points.reserve(held_out_);
        choice_.fitted.points.reserve(count - held_out_);
    }
    void take(const vcg::Point3f& p) { next().points.push_back(to_eigen(p)); }
    void take(const vcg::Point3f& p, float weight) {
        next().weights.push_back(weight);
        take(p);
    }
    PointChoice choice() { return std::move(choice_); }

private:
    TrackedPoints& next() {
        return choice_.held_out.points.size() < held_out_ ? choice_.held_out : choice_.fitted;
    }

    PointChoice choice_;
    std::size_t held_out_;
};

/// The first \p count steps of a Fisher-Yates shuffle.
void shuffle(std::vector<std::uint32_t>& order, std::size_t count, Random& random) {
    for (std::size_t i = 0; i < count; ++i)
        std::swap(order[i], order[i + random.below(static_cast<std::uint32_t>(order.size() - i))]);
}

/// The factor f by which min(1, f x weight) sums to \p wanted over the points, by bisection.
double factor_for(const TargetSpace& target, std::size_t wanted) {
    constexpr int kSteps = 50;  ///< to a billionth
    const std::size_t points = target.positions().size();
    double low = 0;
    double high = 1e6;
    for (int step = 0; step < kSteps; ++step) {
        const double middle = (low + high) / 2;
        double sum = 0;
        for (std::size_t i = 0; i < points; i += CloudSurvey::kRun)
            sum += std::min(1.0, middle * static_cast<double>(target.weight(i))) *
                   static_cast<double>(std::min(CloudSurvey::kRun, points - i));
        (sum < static_cast<double>(wanted) ? low : high) = middle;
    }
    return high;
}

/// About \p wanted points, each with a probability in proportion to its area, as far as that is below 1. What
/// is left of the areas are their weights, 1 in the mean.
PointChoice choose_evenly(const TargetSpace& target, std::size_t wanted, Random& random) {
    const auto& positions = target.positions();
    const double factor = wanted < positions.size() ? factor_for(target, wanted) : 1e6;
    const auto probability = [&](std::size_t i) {
        return std::min(1.0, factor * static_cast<double>(target.weight(i)));
    };
    std::vector<std::uint32_t> order;
    for (std::size_t i = 0; i < positions.size(); ++i)
        if (static_cast<double>(random.unit()) < probability(i))
            order.push_back(static_cast<std::uint32_t>(i));
    shuffle(order, order.size(), random);
    const double share = static_cast<double>(order.size()) / static_cast<double>(positions.size());
    Chosen chosen(order.size());
    for (const std::uint32_t i : order)
        chosen.take(positions[i],
                    static_cast<float>(share * static_cast<double>(target.weight(i)) / probability(i)));
    return chosen.choice();
}

}  // namespace

std::vector<Hit> nearest_by_tree(const Surface& surface, const TrackedPoints& tracked, ThreadTeam& team) {
    return FaceTree(surface, team).nearest(tracked.points, team);
}

std::vector<Hit> nearest_by_walk(const Surface& surface, const TrackedPoints& tracked, ThreadTeam& team) {
    std::vector<Hit> hits(tracked.points.size());
    for_chunks(hits.size(), kPointChunk, team, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            hits[i] = walk_to_nearest(surface, tracked.points[i], tracked.last_hit[i]);
    });
    return hits;
}

// A counting sort by face.
PointsByFace::PointsByFace(const Surface& surface, const TrackedPoints& tracked, const std::vector<Hit>& hits)
    : assignments_(hits.size()), weighted_(!tracked.weights.empty()), first_(surface.face_count() + 1, 0) {
    for (const Hit& hit : hits) ++first_[hit.face + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    PerFace<int> next = first_;
    for (std::size_t i = 0; i < hits.size(); ++i)
        assignments_[static_cast<std::size_t>(next[hits[i].face]++)] = {
            tracked.points[i], weighted_ ? tracked.weights[i] : 1.0F, hits[i].foot};
}

PerFace<float> PointsByFace::counts() const {
    PerFace<float> counts;
    for (int f = 0; f + 1 < first_.size(); ++f)
        counts.push_back(static_cast<float>(first_[f + 1] - first_[f]));
    return counts;
}

float PointsByFace::weight(int face) const {
    if (!weighted_) return static_cast<float>(of(face).size());
    float sum = 0;
    for (const Assignment& a : of(face)) sum += a.influence;
    return sum;
}

float PointsByFace::mean_weight(int f, int g) const {
    const int points = of(f).size() + of(g).size();
    return weighted_ && points > 0 ? (weight(f) + weight(g)) / static_cast<float>(points) : 1;
}

void PointsByFace::update_feet(const Surface& surface, ThreadTeam& team) {
    parallel_for(surface.face_count(), kPointChunk, team, [&](int face) {
        for (Assignment& a : of(face))
            a.foot = foot_on_triangle(a.point, surface.corner(face, 0), surface.corner(face, 1),
                                      surface.corner(face, 2));
    });
}

PointsByFace group_by_face(const Surface& surface, TrackedPoints& tracked, const std::vector<Hit>& hits,
                           ThreadTeam& team) {
    PointsByFace result(surface, tracked, hits);
    tracked.last_hit.resize(hits.size());
    parallel_for(surface.face_count(), kPointChunk, team, [&](int face) {
        auto i = static_cast<std::size_t>(result.of(face).begin() - result.all().data());
        for (const PointsByFace::Assignment& a : result.of(face)) {
            tracked.points[i] = a.point;
            if (!tracked.weights.empty()) tracked.weights[i] = a.influence;
            tracked.last_hit[i] = walk_start_of(surface, {face, a.foot});
            ++i;
        }
    });
    return result;
}

PointChoice choose_points(const TargetSpace& target, std::size_t wanted, Random& random) {
    const auto& positions = target.positions();
    wanted = target.has_faces() ? std::min(wanted, std::max(kMaxDrawn, wanted / 10))
                                : std::min(wanted, positions.size());
    if (target.is_weighted()) return choose_evenly(target, wanted, random);
    Chosen chosen(wanted);
    if (target.has_faces()) {
        for (std::size_t i = 0; i < wanted; ++i) chosen.take(target.sample(random));
        return chosen.choice();
    }
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0U);
    shuffle(order, wanted, random);
    for (std::size_t i = 0; i < wanted; ++i) chosen.take(positions[order[i]]);
    return chosen.choice();
}

}  // namespace neuralmesh
