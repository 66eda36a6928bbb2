// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// What no step of the fit may do to a face: turn it over, fold it onto its neighbour, make it a sliver.
#pragma once

#include <algorithm>

#include "vcg_core/mesh/triangle.h"

namespace neuralmesh {

/// Limits of one kind of step. A face that breaks a limit already may stay as bad as it is, but not get
/// worse.
struct FaceRules {
    float least_turn;     ///< cosine of the largest angle by which a normal may turn
    float sharpest_fold;  ///< cosine of the largest angle between the normals of neighbouring faces
    float sliver;         ///< least triangle_quality()
    float kept_quality;   ///< a face below that keeps this share of its quality

    bool turns_over(const Vector3& normal_before, const Vector3& normal_after) const {
        return !(normal_before.dot(normal_after) > least_turn);
    }
    bool is_folded(float cosine) const { return cosine < sharpest_fold; }
    /// \param before, after cosines between the normals of neighbouring faces
    bool folds(float before, float after) const { return after < std::min(sharpest_fold, before); }
    /// \param before, after triangle_quality()
    bool is_sliver(float before, float after) const {
        return after < std::min(sliver, kept_quality * before);
    }
};

/// Of moves of the vertices. Slivers may be thinner than flips and collapses may make them: vertices that
/// slide onto a crease make slivers for the time until flips remove them.
constexpr FaceRules kMoveRules{0.3F, -0.6F, 0.06F, 0.9F};
/// Of edge flips. Normals turn from the mean of the old faces, not from one of them, so they may turn less.
constexpr FaceRules kFlipRules{0.5F, -0.6F, 0.1F, 1};
/// Of half-edge collapses. Folds are limited more: no later step may have points that open them.
constexpr FaceRules kCollapseRules{0.3F, -0.5F, 0.1F, 1};

}  // namespace neuralmesh
