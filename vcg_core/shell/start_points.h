// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The points that a start mesh is made from.
#pragma once

#include <vcg/space/point3.h>

#include <vector>

#include "vcg_core/base/random.h"
#include "vcg_core/target/target_space.h"

namespace neuralmesh {

/// The points of a cloud, or points drawn from a target with faces. Not copied, so the target must outlive
/// it.
class StartPoints {
public:
    /// Draws \p samples points, from \p random, if \p target has faces.
    StartPoints(const TargetSpace& target, int samples, Random& random)
        : given_(target.has_faces() ? drawn_ : target.positions()) {
        if (!target.has_faces()) return;
        drawn_.reserve(static_cast<std::size_t>(samples));
        for (int i = 0; i < samples; ++i) drawn_.push_back(target.sample(random));
    }
    StartPoints(const StartPoints&) = delete;
    StartPoints& operator=(const StartPoints&) = delete;

    const std::vector<vcg::Point3f>& all() const { return given_; }

private:
    std::vector<vcg::Point3f> drawn_;
    const std::vector<vcg::Point3f>& given_;
};

}  // namespace neuralmesh
