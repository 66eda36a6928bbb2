// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/cloud/float_steps.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>

namespace neuralmesh {

namespace {

constexpr std::size_t kSampledCoordinates = 1000, kSampledPoints = 100000;
constexpr double kCubeSteps = 4;
/// Cubes that a surface of area 1 meets, if they have edges of 1 and all directions are alike.
constexpr double kCubesPerArea = 1.5;

using Coordinates = std::array<double, 3>;

bool is_float(double x) {
    return std::abs(x) <= static_cast<double>(std::numeric_limits<float>::max()) &&
           static_cast<double>(static_cast<float>(x)) == x;
}

/// The step at the median of coordinates \p along an axis, a sample of \p count; 0 if it is short.
double step_along(std::vector<double> along, std::size_t count) {
    std::sort(along.begin(), along.end());
    const double median = std::abs(along[along.size() / 2]);
    if (!(median > 0) || along.front() == along.back()) return 0;
    const double step = std::ldexp(1.0, std::ilogb(median) - (std::numeric_limits<float>::digits - 1));
    // Not those of a few outliers.
    const std::size_t outside = along.size() / 20;
    const double most = along[along.size() - 1 - outside] - along[outside];
    return most < static_cast<double>(count) / 2 * step ? step : 0;
}

struct InCube {
    std::uint64_t cube;
    vcg::Point3f point;
};

/// Of the cubes, in edges. The origin of the core's frame lies at a place of the steps or half a step beside
/// it, so cubes that began there would end where points are.
constexpr double kShift = 0.25 / kCubeSteps;

std::uint64_t cube_of(const vcg::Point3f& p, double side) {
    std::uint64_t hash = 0;
    for (int k = 0; k < 3; ++k) {
        const auto cell = static_cast<std::int64_t>(std::floor(static_cast<double>(p[k]) / side + kShift));
        hash = (hash ^ static_cast<std::uint64_t>(cell)) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
    }
    return hash;
}

}  // namespace

double float_step(std::size_t count, const std::function<Coordinates(std::size_t)>& coordinates_at,
                  const Coordinates& lengths) {
    double step = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        std::vector<double> along;
        const std::size_t stride = count / kSampledCoordinates + 1;
        for (std::size_t i = 0; i < count; i += stride) along.push_back(coordinates_at(i)[k]);
        if (!along.empty()) step = std::max(step, step_along(std::move(along), count) * lengths[k]);
    }
    if (!(step > 0)) return 0;
    for (std::size_t i = 0; i < count; ++i) {
        const Coordinates c = coordinates_at(i);
        if (!std::all_of(c.begin(), c.end(), is_float)) return 0;
    }
    return step;
}

SteppedCloud stepped(const std::vector<vcg::Point3f>& points, double step) {
    const double side = kCubeSteps * step;
    const std::size_t stride = points.size() / kSampledPoints + 1;
    std::vector<InCube> sample;
    for (const vcg::Point3f& p : points) {
        const std::uint64_t cube = cube_of(p, side);
        if ((cube >> 32) % stride == 0) sample.push_back({cube, p});
    }
    const auto key = [](const InCube& one) {
        return std::tie(one.cube, one.point[0], one.point[1], one.point[2]);
    };
    std::sort(sample.begin(), sample.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
    std::size_t cubes = 0, places = 0;
    for (std::size_t i = 0; i < sample.size(); ++i) {
        cubes += i == 0 || sample[i].cube != sample[i - 1].cube ? 1 : 0;
        places += i == 0 || key(sample[i]) != key(sample[i - 1]) ? 1 : 0;
    }
    SteppedCloud result;
    if (cubes == 0) return result;
    result.places_per_cube = static_cast<double>(places) / static_cast<double>(cubes);
    result.area = static_cast<double>(cubes * stride) * side * side / kCubesPerArea;
    return result;
}

}  // namespace neuralmesh
