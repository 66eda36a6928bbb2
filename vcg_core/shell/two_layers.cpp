// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/shell/two_layers.h"

#include "vcg_core/base/median.h"

namespace neuralmesh {

namespace {

using vcg::Point3f;

constexpr double kNormal = 3;  ///< kurtosis of the normal distribution
/// A kurtosis of fewer heights says little.
constexpr std::size_t kLeastHeights = 20;
/// Layers closer than this share of the spacing are rounding.
constexpr double kThin = 0.02;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

std::vector<std::vector<Point3f>> points_by_cell(const std::vector<Point3f>& points,
                                                 const TangentPlanes& planes) {
    std::vector<std::vector<Point3f>> cells(planes.planes.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        if (planes.cell_of[i] >= 0) cells[at(planes.cell_of[i])].push_back(points[i]);
    return cells;
}

double kurtosis(const std::vector<double>& heights, double spacing) {
    if (heights.size() < kLeastHeights) return kNormal;
    const auto count = static_cast<double>(heights.size());
    double mean = 0;
    for (const double h : heights) mean += h / count;
    double second = 0;
    double fourth = 0;
    for (const double h : heights) {
        const double squared = (h - mean) * (h - mean);
        second += squared / count;
        fourth += squared * squared / count;
    }
    const bool thin = second < kThin * kThin * spacing * spacing;
    return thin ? kNormal : fourth / (second * second);
}

}  // namespace

double median_kurtosis(const std::vector<Point3f>& points, const TangentPlanes& planes) {
    const std::vector<std::vector<Point3f>> cells = points_by_cell(points, planes);
    std::vector<double> values(1, kNormal);
    std::vector<double> heights;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const TangentPlane& plane = planes.planes[i];
        heights.clear();
        const auto add = [&](const std::vector<Point3f>& cell) {
            for (const Point3f& p : cell)
                heights.push_back(static_cast<double>((p - plane.centre) * plane.normal));
        };
        add(cells[i]);
        for (const int j : planes.around[i])
            if (j >= 0) add(cells[at(j)]);
        values.push_back(kurtosis(heights, static_cast<double>(plane.spacing)));
    }
    return median(std::move(values));
}

}  // namespace neuralmesh
