// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Whether the surface of a cloud is open or closed, if settings.surface leaves it to the points. In order, as
// begin_by_points() of learning_task.cpp asks:
//
// 1. The shell, which is closed, says what it had to close (Enclosure of start/shell.h). may_be_open(): wide
//    openings, or parts that enclose nothing. If neither, the surface is closed.
// 2. Else a mesh of one layer is made through the points (start/open_start.h). is_open(): it has boundaries,
//    and it leaves out no surface; then learning starts from it.
// 3. A layer without boundaries takes the place of a shell that found no space, encloses_more(). In all other
//    cases learning starts from the shell, or from the hull of few points (few_points.h).
#pragma once

#include <string>

#include "vcg_core/cloud/target_space.h"
#include "vcg_core/settings.h"
#include "vcg_core/start/open_start.h"
#include "vcg_core/start/shell.h"

namespace neuralmesh {

/// The widest hole of the open start mesh that is closed. Openings of closed models (places without points on
/// large faces, cavities) are narrower than this share of the diagonal, those of scans and cut models wider.
/// Chosen by open_table.py.
inline constexpr double kWidestClosed = 0.066;

/// Whether the cloud may be open: the shell closed wide openings, or a part of it has no space inside, and is
/// no thin wall.
/// \param radius on which the points are a surface, 0 if it is not known yet
bool may_be_open(const Enclosure& shell, const TargetSpace& target, const Settings& settings, double radius);

/// Whether the open start loses more than the closed one: points that it leaves out are lost, those around
/// which nothing is enclosed are covered on both sides, which is half as bad. Views that do not quite meet
/// look like clutter to the one, and like a sheet to the other.
bool loses_more(const OpenStart& start, const Enclosure& shell);

/// Whether the surface is open: may_be_open(), now that the radius is known, and the start mesh of one layer
/// has boundaries, one of them wider than what is to be closed, and loses neither surface nor more points
/// than the shell, nor one side of a wall.
bool is_open(const OpenStart& start, const Enclosure& shell, const TargetSpace& target,
             const Settings& settings);

/// Whether the start mesh of one layer is closed where the shell found no space: balls that do not get
/// through the widest gap between the points are as wide as the walls there.
bool encloses_more(const OpenStart& start, const Enclosure& shell);

/// A sentence if most points lie on the two sides of walls too thin to tell the sides apart; else empty.
/// \param diagonal of the frame \param outcome what became of them, a sentence
std::string warning_of_thin_walls(const LayerFigures& layers, double diagonal, const char* outcome);

}  // namespace neuralmesh
