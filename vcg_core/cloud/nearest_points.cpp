// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/cloud/nearest_points.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "vcg_core/base/z_order.h"
#include "vcg_core/cloud/percentile_box.h"

namespace neuralmesh {
namespace {

/// Of the \p cells along an axis, that at the fraction \p at of the axis.
std::uint64_t cell_along(float at, std::uint64_t cells) {
    const auto last = static_cast<double>(cells - 1);
    return static_cast<std::uint64_t>(
        std::clamp(static_cast<double>(at) * static_cast<double>(cells), 0.0, last));
}

}  // namespace

NearestPoints::NearestPoints(const std::vector<vcg::Point3f>& points) {
    place_cube(points);
    sort_points(points);
    build_boxes();
}

/// A few points very far away must not make all cells too large for the others.
void NearestPoints::place_cube(const std::vector<vcg::Point3f>& points) {
    constexpr float kSmallPart = 1e-2F;
    constexpr float kMargin = 1.2F;  // leaves border cells empty, so that opposite borders do not touch
    vcg::Box3f whole;
    for (const vcg::Point3f& p : points) whole.Add(p);
    const auto middle = vcg::Box3f::Construct(
        percentile_box(points.size(), [&](std::size_t i) { return vcg::Point3d::Construct(points[i]); }));
    const auto longest = [](const vcg::Box3f& box) { return std::max({box.DimX(), box.DimY(), box.DimZ()}); };
    side_ = 2 * longest(middle);
    vcg::Point3f centre = middle.Center();
    if (side_ > kSmallPart * longest(whole) || !(side_ > 0)) {
        side_ = longest(whole) > 0 ? kMargin * longest(whole) : 1;
        centre = whole.Center();
    }
    corner_ = centre - vcg::Point3f(side_, side_, side_) / 2;
}

void NearestPoints::sort_points(const std::vector<vcg::Point3f>& points) {
    int index_bits = 1;
    while ((std::uint64_t{1} << index_bits) < points.size()) ++index_bits;
    levels_ = std::min(21, (64 - index_bits) / 3);
    index_mask_ = (std::uint64_t{1} << index_bits) - 1;
    keys_.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        std::uint64_t code = 0;
        for (int k = 0; k < 3; ++k) {
            const float at = (points[i][k] - corner_[k]) / side_;
            code |= spread_bits(cell_along(at, std::uint64_t{1} << levels_)) << k;
        }
        keys_[i] = code << (64 - 3 * levels_) | i;
    }
    std::sort(keys_.begin(), keys_.end());
    points_.reserve(points.size());
    for (Place p = 0; p < size(); ++p) points_.push_back(points[index(p)]);
}

void NearestPoints::build_boxes() {
    boxes_.emplace_back((keys_.size() + kLeaf - 1) / kLeaf);
    for (std::size_t i = 0; i < keys_.size(); ++i) boxes_[0][i / kLeaf].Add(point(static_cast<Place>(i)));
    while (boxes_.back().size() > 1) {
        const std::vector<vcg::Box3f>& below = boxes_.back();
        std::vector<vcg::Box3f> above((below.size() + kBranch - 1) / kBranch);
        for (std::size_t i = 0; i < below.size(); ++i) above[i / kBranch].Add(below[i]);
        boxes_.push_back(std::move(above));
    }
}

void NearestPoints::nearest(Place place, int k, std::vector<Neighbour>& result) const {
    const auto wanted = std::min(static_cast<std::size_t>(k), static_cast<std::size_t>(size()) - 1);
    result.clear();
    if (wanted == 0) return;
    // Those among the places around are about as near, so that the search has a bound from the beginning.
    const auto reach = static_cast<Place>(wanted);
    for (Place p = place - std::min(place, reach); p <= std::min(place + reach, size() - 1); ++p)
        if (p != place) result.push_back({(this->point(p) - point(place)).SquaredNorm(), p});
    std::nth_element(result.begin(), result.begin() + reach - 1, result.end());
    float bound = result[wanted - 1].squared_distance;
    result.clear();
    const auto add = [&](Place p, float d) {
        const Neighbour candidate{d, p};
        if (d > bound || p == place || (result.size() == wanted && !(candidate < result.back()))) return;
        result.push_back(candidate);
        auto at = result.end() - 1;
        for (; at != result.begin() && candidate < *(at - 1); --at) *at = *(at - 1);
        *at = candidate;
        if (result.size() > wanted) result.pop_back();
        if (result.size() == wanted) bound = result.back().squared_distance;
    };
    visit_near(point(place), add, [&] { return bound; });
}

void NearestPoints::within(const vcg::Point3f& centre, float radius, std::size_t most,
                           std::vector<vcg::Point3f>& result) const {
    std::vector<Place> places;
    any_within(centre, radius, [&](Place p) {
        places.push_back(p);
        return false;
    });
    std::sort(places.begin(), places.end());
    std::size_t stride = 1;
    while (places.size() / stride > most) stride *= 2;
    result.clear();
    for (std::size_t i = 0; i < places.size(); i += stride) result.push_back(point(places[i]));
}

NearestPoints::Place NearestPoints::nearest_to(const vcg::Point3f& centre) const {
    Neighbour best{std::numeric_limits<float>::infinity(), 0};
    visit_near(
        centre,
        [&](Place p, float d) {
            best = std::min(best, Neighbour{d, p});
        },
        [&] { return best.squared_distance; });
    return best.place;
}

}  // namespace neuralmesh
