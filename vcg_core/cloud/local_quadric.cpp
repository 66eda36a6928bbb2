// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/cloud/local_quadric.h"

#include <algorithm>
#include <cmath>

#include "vcg_core/base/median.h"
#include "vcg_core/base/small_matrices.h"

namespace neuralmesh {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Coefficients = Vector6d;

/// Of 115 points with noise of .01, 15 that are .1 to .4 off draw the quadric by .08 without a pass, by .045
/// with one and by .022 with two.
constexpr int kRobustPasses = 2;
/// The deviation of normally distributed numbers is this many times the median of their magnitudes.
constexpr double kDeviationPerMedian = 1.4826;
/// Points beyond so many deviations weigh less than half (Cauchy).
constexpr double kCauchy = 2.5;

vcg::Point3f in_float(const Vector3d& v) {
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

Coefficients monomials(double u, double v) {
    Coefficients m;
    m << 1, u, v, u * u, u * v, v * v;
    return m;
}

/// The points in the axes of their plane, lengths along it in radii.
struct HeightField {
    Vector3d middle;
    Matrix3d axes;  ///< columns: the normal, then two along the plane
    std::vector<Coefficients> at;
    std::vector<double> heights, gauss;
    double flatness = 0, width = 0;
    bool on_line = false;
};

HeightField height_field(const std::vector<vcg::Point3f>& points, const Vector3d& place, double radius) {
    constexpr double kLine = 1e-6;  // squared spread beside the larger one
    HeightField field;
    double total = 0;
    Vector3d sum = Vector3d::Zero();
    for (const vcg::Point3f& p : points) {
        const Vector3d d = in_double(p) - place;
        const double x = d.squaredNorm() / (radius * radius);
        field.gauss.push_back(1 / (1 + 2 * x * (1 + x)));  // about e^(-2 x)
        total += field.gauss.back();
        sum += field.gauss.back() * d;
    }
    field.middle = place + sum / total;
    Matrix3d scatter = Matrix3d::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vector3d d = in_double(points[i]) - field.middle;
        scatter += field.gauss[i] * d * d.transpose();
    }
    const PrincipalAxes principal = principal_axes(scatter);
    field.axes = principal.axes;
    const Vector3d spread = principal.values.cwiseMax(0);
    field.on_line = spread[1] <= kLine * spread[2];
    field.flatness = field.on_line ? 1 : std::sqrt(spread[0] / spread[1]);
    field.width = std::sqrt(spread[1] / std::max(spread[2], 1e-300));
    for (const vcg::Point3f& p : points) {
        const Vector3d d = field.axes.transpose() * (in_double(p) - field.middle);
        field.heights.push_back(d[0]);
        field.at.push_back(monomials(d[1] / radius, d[2] / radius));
    }
    return field;
}

Coefficients solve(const HeightField& field, const std::vector<double>& weights) {
    constexpr double kRidge = 1e-9;  // a quadric that the points leave open is flat there
    Matrix6d a = Matrix6d::Zero();
    Coefficients b = Coefficients::Zero();
    double total = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        a.selfadjointView<Eigen::Lower>().rankUpdate(field.at[i], weights[i]);
        b += weights[i] * field.heights[i] * field.at[i];
        total += weights[i];
    }
    for (int k = 0; k < 6; ++k) a(k, k) += kRidge * total;
    return neuralmesh::solve(a, b);
}

double robust_deviation(const HeightField& field, const Coefficients& quadric,
                        std::vector<double>& residuals) {
    residuals.clear();
    for (std::size_t i = 0; i < field.heights.size(); ++i)
        residuals.push_back(std::abs(field.heights[i] - quadric.dot(field.at[i])));
    return kDeviationPerMedian * median(residuals);
}

void set_moments(const std::vector<double>& residuals, LocalQuadric& result) {
    double second = 0, fourth = 0;
    for (const double r : residuals) {
        second += r * r / static_cast<double>(residuals.size());
        fourth += r * r * r * r / static_cast<double>(residuals.size());
    }
    result.spread = static_cast<float>(std::sqrt(second));
    if (second > 0) result.kurtosis = static_cast<float>(fourth / (second * second));
}

}  // namespace

LocalQuadric local_quadric(const std::vector<vcg::Point3f>& points, const vcg::Point3f& place, float radius) {
    LocalQuadric result;
    if (points.size() < static_cast<std::size_t>(LocalQuadric::kLeastPoints)) return result;
    const double r = static_cast<double>(radius);
    const Vector3d centre = in_double(place);
    const HeightField field = height_field(points, centre, r);
    result.flatness = static_cast<float>(field.flatness);
    result.width = static_cast<float>(field.width);
    if (field.on_line) return result;
    std::vector<double> weights = field.gauss, residuals;
    Coefficients quadric;
    double deviation = 0;
    for (int pass = 0; pass <= kRobustPasses; ++pass) {
        quadric = solve(field, weights);
        deviation = robust_deviation(field, quadric, residuals);
        const double scale = kCauchy * deviation + 1e-12 * r;
        for (std::size_t i = 0; i < weights.size(); ++i)
            weights[i] = field.gauss[i] / (1 + residuals[i] * residuals[i] / (scale * scale));
    }
    const auto n = static_cast<double>(points.size());
    result.points = static_cast<int>(points.size());
    result.deviation = static_cast<float>(deviation / std::sqrt(std::max(1 - 6 / n, 0.2)));
    set_moments(residuals, result);
    const Vector3d at = field.axes.transpose() * (centre - field.middle);
    const double u = at[1] / r, v = at[2] / r;
    const Vector3d foot(quadric.dot(monomials(u, v)), at[1], at[2]);
    result.foot = in_float(field.middle + field.axes * foot);
    const Vector3d slope(1, -(quadric[1] + 2 * quadric[3] * u + quadric[4] * v) / r,
                         -(quadric[2] + quadric[4] * u + 2 * quadric[5] * v) / r);
    result.normal = in_float(field.axes * slope.normalized());
    return result;
}

}  // namespace neuralmesh
