// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/rounded_coordinates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <vector>

#include "vcg_core/base/error.h"
#include "vcg_core/base/even_mesh.h"
#include "vcg_core/base/median.h"
#include "vcg_core/base/text.h"
#include "vcg_core/cloud/surface_survey.h"

namespace neuralmesh {

namespace {

/// Shorter steps, in what the points are apart, hide in the distances between them.
constexpr double kLongStep = 0.4;
/// Up to two edges the mesh is sound; beyond, a sphere of 2.5 steps in radius with 500 vertices has
/// coincident ones, and 4 % of its faces are slivers.
constexpr double kMostEdges = 2;
constexpr const char* kWhatToDo =
    "Subtract an offset from the coordinates before they are saved, or save them in double precision and use "
    "pymeshlab, which reads it";

/// In the units of the input; a step of 0 is none that matters.
struct Rounding {
    double step = 0, area = 0;
};

Rounding rounding_of(const TargetSpace& target) {
    const double diagonal = target.frame().diagonal, step = target.rounding();
    if (!(step > 0) || target.is_exact()) return {};
    const std::optional<TargetSpace> once = target.each_place_once();
    const std::vector<vcg::Point3f>& points = (once ? *once : target).positions();
    constexpr double kPi = 3.14159265358979;
    // The circle through the tenth neighbour holds ten points.
    const float squared = median(CloudSurvey(points, 1).squared_spacings);
    const double area = diagonal * diagonal * kPi * static_cast<double>(squared) / CloudSurvey::kNeighbour;
    if (step < kLongStep * std::sqrt(area)) return {};
    return {step, area * static_cast<double>(points.size())};
}

bool is_float(double x) {
    return std::abs(x) <= static_cast<double>(std::numeric_limits<float>::max()) &&
           static_cast<double>(static_cast<float>(x)) == x;
}

/// The step at the median of coordinates \p along an axis, a sample of \p count; 0 if it is short.
double step_along(std::vector<double> along, std::size_t count) {
    std::sort(along.begin(), along.end());
    const double middle = std::abs(along[along.size() / 2]);
    if (!(middle > 0) || along.front() == along.back()) return 0;
    const double step = std::ldexp(1.0, std::ilogb(middle) - (std::numeric_limits<float>::digits - 1));
    // Not those of a few outliers.
    const std::size_t outside = along.size() / 20;
    const double most = along[along.size() - 1 - outside] - along[outside];
    return most < static_cast<double>(count) / 2 * step ? step : 0;
}

std::ostringstream sentence_on(const Rounding& rounding) {
    std::ostringstream text = stream_with(6);
    text << "Single precision has rounded the coordinates to steps of " << rounding.step << ", and ";
    text.precision(2);
    return text;
}

}  // namespace

double float_step(std::size_t count, const std::function<std::array<double, 3>(std::size_t)>& coordinates_at,
                  const std::array<double, 3>& lengths) {
    constexpr std::size_t kSampled = 1000;
    double step = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        std::vector<double> along;
        const std::size_t stride = count / kSampled + 1;
        for (std::size_t i = 0; i < count; i += stride) along.push_back(coordinates_at(i)[k]);
        if (!along.empty()) step = std::max(step, step_along(std::move(along), count) * lengths[k]);
    }
    if (!(step > 0)) return 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::array<double, 3> c = coordinates_at(i);
        if (!std::all_of(c.begin(), c.end(), is_float)) return 0;
    }
    return step;
}

std::string warning_of_rounding(const TargetSpace& target) {
    const Rounding rounding = rounding_of(target);
    if (!(rounding.step > 0)) return {};
    std::ostringstream text = sentence_on(rounding);
    text << "the points are about "
         << std::sqrt(rounding.area / static_cast<double>(target.positions().size()))
         << " apart: finer details are lost. " << kWhatToDo << '.';
    return text.str();
}

void refuse_rounding(const TargetSpace& target, int vertices) {
    const Rounding rounding = rounding_of(target);
    const double edge = std::sqrt(rounding.area / (kAreaPerVertex * vertices));
    if (!(rounding.step > kMostEdges * edge)) return;
    std::ostringstream text = sentence_on(rounding);
    text << "the edges of " << vertices << " vertices would be about " << edge << " long. " << kWhatToDo;
    const auto enough = static_cast<int>(rounding.area / (kAreaPerVertex * rounding.step * rounding.step));
    if (enough >= 4) text << "; or ask for no more than " << enough << " vertices";
    throw InputError(text.str() + ".");
}

}  // namespace neuralmesh
