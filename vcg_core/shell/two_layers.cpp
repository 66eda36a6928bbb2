// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/shell/two_layers.h"

#include <algorithm>
#include <cmath>
#include <utility>

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

/// Variance and kurtosis of heights.
struct Moments {
    double variance = 0;
    double kurtosis = kNormal;
};

Moments moments(const std::vector<double>& heights, double spacing) {
    if (heights.size() < kLeastHeights) return {};
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
    return {second, thin ? kNormal : fourth / (second * second)};
}

/// Of points around a plane.
class Spread {
public:
    void add(const Point3f& p) {
        const auto d = vcg::Point3d::Construct(p);
        sum_ += d;
        squares_ += d * d;
        ++count_;
    }
    /// Of the disc that the points fill along the plane, given their variance across it.
    double area(double across) const {
        const vcg::Point3d mean = sum_ / count_;
        constexpr double kTwoPi = 6.283185307179586;  // the variance along a disc is half its squared radius
        return kTwoPi * std::max(0.0, squares_ / count_ - mean * mean - across);
    }

private:
    vcg::Point3d sum_{0, 0, 0};
    double squares_ = 0;
    double count_ = 0;
};

}  // namespace

LayerFigures layer_figures(const std::vector<Point3f>& points, const TangentPlanes& planes) {
    const std::vector<std::vector<Point3f>> cells = points_by_cell(points, planes);
    std::vector<double> kurtoses(1, kNormal), thicknesses(1, 0), spacings(1, 0);
    std::vector<double> heights;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const TangentPlane& plane = planes.planes[i];
        heights.clear();
        Spread spread;
        const auto add = [&](const std::vector<Point3f>& cell) {
            for (const Point3f& p : cell) {
                heights.push_back(static_cast<double>((p - plane.centre) * plane.normal));
                spread.add(p - plane.centre);
            }
        };
        add(cells[i]);
        for (const int j : planes.around[i])
            if (j >= 0) add(cells[at(j)]);
        const Moments found = moments(heights, static_cast<double>(plane.spacing));
        kurtoses.push_back(found.kurtosis);
        if (heights.size() < kLeastHeights) continue;
        thicknesses.push_back(2 * std::sqrt(found.variance));
        spacings.push_back(std::sqrt(2 * spread.area(found.variance) / static_cast<double>(heights.size())));
    }
    return {median(std::move(kurtoses)), median(std::move(thicknesses)), median(std::move(spacings))};
}

}  // namespace neuralmesh
