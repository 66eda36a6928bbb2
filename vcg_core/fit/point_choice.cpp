// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/point_choice.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

namespace neuralmesh {

namespace {

constexpr std::size_t kMaxDrawn = 2000000;
constexpr std::size_t kHeldOutShare = 8;
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
    constexpr int kSteps = 50;
    const std::size_t points = target.positions().size();
    double low = 0;
    double high = 1e6;
    for (int step = 0; step < kSteps; ++step) {
        const double middle = (low + high) / 2;
        double sum = 0;
        for (std::size_t i = 0; i < points; i += PointAreas::kRun)
            sum += std::min(1.0, middle * static_cast<double>(target.weight(i))) *
                   static_cast<double>(std::min(PointAreas::kRun, points - i));
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
