// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/open_or_closed.h"

#include <algorithm>
#include <sstream>

#include "vcg_core/base/text.h"

namespace neuralmesh {

namespace {

/// Sparse and noisy points leave openings, and places that enclose nothing, in closed surfaces, too: openings
/// as wide as 2.3 radii and a sheet share of 4.4 times the radius were found with 500 to 15,000 points of
/// five closed models. Of the same models cut by a plane one of the two is above these bounds.
constexpr double kOpeningRadii = 3, kSheetRadii = 5;
/// The sides of walls thicker than this, in spacings of the points, are told apart (opposite_layers.h).
constexpr double kToldSpacings = 4;

}  // namespace

bool may_be_open(const Enclosure& shell, const TargetSpace& target, const Settings& settings, double radius) {
    const bool chosen = settings.close_holes_up_to >= 0;
    const double asked = settings.close_holes_up_to / target.frame().diagonal;
    const double widest = chosen ? asked : std::max(kWidestClosed, kOpeningRadii * radius);
    if (shell.walled) return false;
    return !shell.encloses_space || 2 * shell.widest_opening > widest ||
           shell.sheet_share > std::max(kMostSheet, kSheetRadii * radius);
}

bool loses_more(const OpenStart& start, const Enclosure& shell) {
    constexpr double kFew = 0.025;  // outliers and ragged boundaries
    return shell.encloses_space && start.left_out > std::max(kFew, shell.sheet_share / 2);
}

bool is_open(const OpenStart& start, const Enclosure& shell, const TargetSpace& target,
             const Settings& settings) {
    if (start.loops == 0 || start.layers.two || start.misses_surface || loses_more(start, shell))
        return false;
    const bool wide = settings.close_holes_up_to >= 0 || start.widest_loop > kWidestClosed;
    return wide && may_be_open(shell, target, settings, start.radius);
}

bool encloses_more(const OpenStart& start, const Enclosure& shell) {
    return start.loops == 0 && !start.layers.two && !shell.encloses_space;
}

std::string warning_of_thin_walls(const LayerFigures& layers, double diagonal, const char* outcome) {
    if (!layers.two || layers.thickness > kToldSpacings * layers.spacing) return "";
    std::ostringstream text = stream_with(2);
    text
        << "The points lie on the two sides of walls about " << layers.thickness * diagonal
        << " thick, which cannot be told apart: the points of each side are about "
        << layers.spacing * diagonal << " from each other. " << outcome
        << " For both sides take points a quarter of the thickness from each other; for one, the points of one "
           "side only.";
    return text.str();
}

}  // namespace neuralmesh
