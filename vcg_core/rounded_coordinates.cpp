// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/rounded_coordinates.h"

#include <cmath>
#include <cstddef>
#include <sstream>

#include "vcg_core/base/error.h"
#include "vcg_core/base/even_mesh.h"
#include "vcg_core/base/text.h"
#include "vcg_core/cloud/float_steps.h"

namespace neuralmesh {

namespace {

/// With fewer, the steps are less than .4 of what the points are apart.
constexpr double kPlacesPerCube = 2;
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
    const SteppedCloud cloud = stepped(target.positions(), step / diagonal);
    if (cloud.places_per_cube < kPlacesPerCube) return {};
    return {step, cloud.area * diagonal * diagonal};
}

std::ostringstream sentence_on(const Rounding& rounding) {
    std::ostringstream text = stream_with(6);
    text << "Single precision has rounded the coordinates to steps of " << rounding.step << ", and ";
    text.precision(2);
    return text;
}

}  // namespace

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
