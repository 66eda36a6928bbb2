// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/noise.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "vcg_core/base/median.h"

namespace neuralmesh {

float noise_variance(const Surface& surface, const PointsByFace& points) {
    constexpr int kMinPoints = 4;
    std::vector<float> variances;
    for (int f = 0; f < surface.face_count(); ++f) {
        const Span<const PointsByFace::Assignment> of_face = points.of(f);
        if (of_face.size() < kMinPoints) continue;
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
    }
    return variances.empty() ? 0.0F : median(std::move(variances));
}

}  // namespace neuralmesh
