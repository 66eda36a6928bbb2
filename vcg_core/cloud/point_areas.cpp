// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/cloud/point_areas.h"

#include <algorithm>
#include <numeric>

#include "vcg_core/base/median.h"

namespace neuralmesh {
namespace {

constexpr std::size_t kFewestPoints = 1024;
/// A cloud is uneven if a fifth of its surface has more than kUneven times the area per point that a tenth of
/// its points have. Even random clouds of the models of tests/experiments/accuracy, 2,000 to 100,000 points
/// with and without noise, have 1.3 to 1.6 times; clouds of density 10:1 have 3.6 to 4.5. The vertices of
/// meshes have 1.1 to 11.
constexpr double kLow = 0.1, kHigh = 0.8;
constexpr float kUneven = 2.5F;
/// Bound on the ratio of an area to the median: the few points of the far end of a room must not draw all
/// signals. Room scans have 1000:1 and more between the percentiles.
constexpr float kMostAreaRatio = 100;

struct Spread {
    float low;     ///< the area that kLow of the points fall short of
    float median;  ///< of the points
    float high;    ///< the area per point in kHigh of the surface
};

Spread spread_of(std::vector<float> areas) {
    std::sort(areas.begin(), areas.end());
    const auto at = [&](double share) {
        return areas[static_cast<std::size_t>(share * static_cast<double>(areas.size()))];
    };
    const double whole = std::accumulate(areas.begin(), areas.end(), 0.0);
    double sum = 0;
    std::size_t i = 0;
    while (i + 1 < areas.size() && sum + static_cast<double>(areas[i]) < kHigh * whole)
        sum += static_cast<double>(areas[i++]);
    return {at(kLow), at(0.5), areas[i]};
}

/// Bounds the areas by their \p median and scales them to 1 in the mean over \p points points.
void normalise(std::vector<float>& of_run, float median, std::size_t points) {
    double sum = 0;
    for (std::size_t r = 0; r < of_run.size(); ++r) {
        of_run[r] = std::min(std::max(of_run[r] / median, 1 / kMostAreaRatio), kMostAreaRatio);
        const std::size_t in_run = std::min(PointAreas::kRun, points - r * PointAreas::kRun);
        sum += static_cast<double>(of_run[r]) * static_cast<double>(in_run);
    }
    for (float& area : of_run)
        area = static_cast<float>(static_cast<double>(area) * static_cast<double>(points) / sum);
}

}  // namespace

std::optional<PointAreas> areas_if_uneven(const CloudSurvey& survey) {
    const NearestPoints& cloud = survey.cloud;
    if (cloud.size() < kFewestPoints) return std::nullopt;
    PointAreas result;
    // The area of a point is its squared spacing, up to a factor. The median of five runs takes out most of
    // what it varies by chance, and single outliers.
    result.of_run = running_median(survey.squared_spacings);
    const Spread spread = spread_of(result.of_run);
    if (!(spread.high > kUneven * spread.low) || !(spread.median > 0)) return std::nullopt;
    normalise(result.of_run, spread.median, cloud.size());
    result.points.reserve(cloud.size());
    for (NearestPoints::Place p = 0; p < cloud.size(); ++p) result.points.push_back(cloud.point(p));
    return result;
}

AliasTable::AliasTable(const std::vector<double>& weights) : columns_(weights.size()) {
    const double mean =
        std::accumulate(weights.begin(), weights.end(), 0.0) / static_cast<double>(weights.size());
    std::vector<double> left(weights.size());  // of the probability, in columns
    std::vector<std::uint32_t> small;
    std::vector<std::uint32_t> large;
    for (std::uint32_t i = 0; i < weights.size(); ++i) {
        left[i] = weights[i] / mean;
        columns_[i] = {0xffffffffU, i};
        (left[i] < 1 ? small : large).push_back(i);
    }
    while (!small.empty() && !large.empty()) {
        const std::uint32_t filled = small.back();
        const std::uint32_t giver = large.back();
        small.pop_back();
        columns_[filled] = {static_cast<std::uint32_t>(std::min(left[filled] * 0x1p32, 0x1p32 - 1)), giver};
        left[giver] -= 1 - left[filled];
        if (left[giver] >= 1) continue;
        large.pop_back();
        small.push_back(giver);
    }
}

}  // namespace neuralmesh
