// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/point_choice.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

namespace neuralmesh {

PointChoice choose_points(const TargetSpace& target, std::size_t wanted, Random& random) {
    constexpr std::size_t kMaxDrawn = 2000000;
    constexpr std::size_t kHeldOutShare = 8;
    constexpr std::size_t kMaxHeldOut = 10000;
    const auto& positions = target.positions();
    wanted = target.has_faces() ? std::min(wanted, std::max(kMaxDrawn, wanted / 10))
                                : std::min(wanted, positions.size());
    const std::size_t held_out = std::min(wanted / kHeldOutShare, kMaxHeldOut);
    PointChoice choice;
    choice.held_out.reserve(held_out);
    choice.fitted.reserve(wanted - held_out);
    const auto take = [&](const vcg::Point3f& p) {
        (choice.held_out.size() < held_out ? choice.held_out : choice.fitted).push_back(to_eigen(p));
    };
    if (target.has_faces()) {
        for (std::size_t i = 0; i < wanted; ++i) take(target.sample(random));
        return choice;
    }
    // The first steps of a Fisher-Yates shuffle.
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0U);
    for (std::size_t i = 0; i < wanted; ++i) {
        std::swap(order[i], order[i + random.below(static_cast<std::uint32_t>(order.size() - i))]);
        take(positions[order[i]]);
    }
    return choice;
}

}  // namespace neuralmesh
