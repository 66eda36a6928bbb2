// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/noise.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "vcg_core/base/median.h"
#include "vcg_core/base/parallel_for.h"

namespace neuralmesh {

float noise_variance(const Surface& surface, const PointsByFace& points, ThreadTeam& team) {
    constexpr int kMinPoints = 4;
    constexpr int kFacesAtATime = 512;
    const auto find = [&](int f, std::vector<float>& variances) {
        const Span<const PointsByFace::Assignment> of_face = points.of(f);
        if (of_face.size() < kMinPoints) return;
        const Vector3 normal = unit_normal(surface, f);
        float sum = 0;
        float squares = 0;
        for (const PointsByFace::Assignment& a : of_face) {
            const float height = normal.dot(a.point - surface.corner(f, 0));
            sum += height;
            squares += height * height;
        }
        const auto n = static_cast<float>(of_face.size());
        variances.push_back(std::max(0.0F, squares - sum * sum / n) / (n - 1));
    };
    std::vector<float> variances = parallel_collect<float>(surface.face_count(), kFacesAtATime, team, find);
    return variances.empty() ? 0.0F : median(std::move(variances));
}

}  // namespace neuralmesh
