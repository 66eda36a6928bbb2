// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The normals that came with the points: whether they serve, and what is said about them.
#pragma once

#include <string>
#include <vector>

#include "vcg_core/cloud/surface_survey.h"
#include "vcg_core/cloud/target_space.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// Empty if the normals of \p target are those of its surface, to one side of it or, by parts, to both; else
/// a sentence that says why they are not used. \p surveys are those of target.positions(). \pre
/// target.has_normals()
std::string why_normals_do_not_serve(const TargetSpace& target, Surveys& surveys);

/// Adds to \p notes what the normals of \p target, which serve, were used for, and to \p warnings where they
/// contradict themselves or the closed surface. \param start the oriented start mesh \param parts_oriented
/// the number of its parts with a boundary that were oriented by them
void report_normals(const Network& start, const TargetSpace& target, int parts_oriented,
                    std::vector<std::string>& notes, std::vector<std::string>& warnings);

}  // namespace neuralmesh
