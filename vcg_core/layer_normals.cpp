// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/layer_normals.h"

#include "vcg_core/base/text.h"
#include "vcg_core/cloud/normal_survey.h"
#include "vcg_core/start/orientation.h"

namespace neuralmesh {
namespace {

/// With fewer normals along the closed surface they are flipped. Where the start mesh misses a thin wall,
/// half of the right ones are.
constexpr double kFlipped = 0.2;

void report_open_parts(int parts, int oriented, std::vector<std::string>& notes,
                       std::vector<std::string>& warnings) {
    if (oriented > 0)
        notes.emplace_back("The open surface faces the side to which the normals of the layer point.");
    if (oriented < parts)
        warnings.push_back("The normals of the layer point to both sides of " +
                           std::to_string(parts - oriented) + " of the " + std::to_string(parts) +
                           " parts with a boundary, so they are not used there.");
}

}  // namespace

std::string why_normals_do_not_serve(const TargetSpace& target, Surveys& surveys) {
    const NormalSurvey found = survey_of_normals(surveys, target.normals());
    if (found.places == 0)
        return "The normals of the layer cannot be compared with the points, which show a surface nowhere, "
               "so they are not used.";
    if (!found.fits())
        return "The normals of the layer do not fit the points (" + percent(found.share_fitting()) +
               " within 30 degrees of the local surface), so they are not used.";
    if (!found.has_sides())
        return "The normals of the layer point to either side of the surface (" +
               percent(found.share_opposite()) + " opposite to those of neighbours), so they are not used.";
    return "";
}

void report_normals(const Network& start, const TargetSpace& target, int parts_oriented,
                    std::vector<std::string>& notes, std::vector<std::string>& warnings) {
    int open_parts = 0;
    OrientationVote closed;
    for (const OrientationVote& vote : orientation_votes(start, target)) {
        if (vote.open) {
            ++open_parts;
            continue;
        }
        closed.along += vote.along;
        closed.against += vote.against;
    }
    if (open_parts > 0) report_open_parts(open_parts, parts_oriented, notes, warnings);
    if (closed.along + closed.against == 0) return;
    if (closed.share_along() < kFlipped) {
        warnings.push_back("The normals of the layer point inwards (" + percent(1 - closed.share_along()) +
                           "): they are not used, and the closed surface faces out.");
    } else if (open_parts == 0) {
        notes.emplace_back(
            "The normals of the layer fit the points. A closed surface faces out without them.");
    }
}

}  // namespace neuralmesh
