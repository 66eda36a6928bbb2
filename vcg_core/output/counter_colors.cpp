// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/output/counter_colors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace neuralmesh {

namespace {

// Every 28th of the 256 colours of magma, from the lightest down; linear interpolation between them is hard
// to tell from the original.
const std::array<Color, 7> kRamp = {Color{252, 253, 191}, Color{254, 201, 141}, Color{253, 149, 103},
                                    Color{241, 96, 93},   Color{205, 64, 113},  Color{159, 47, 127},
                                    Color{114, 31, 129}};

float percentile(std::vector<float> values, double fraction) {
    const auto rank = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return values[static_cast<std::size_t>(rank)];
}

Color on_ramp(float t) {
    const float place = t * static_cast<float>(kRamp.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(place), kRamp.size() - 2);
    const float x = place - static_cast<float>(i);
    Color color{};
    for (std::size_t k = 0; k < color.size(); ++k)
        color[k] = static_cast<unsigned char>(std::lround((1 - x) * kRamp[i][k] + x * kRamp[i + 1][k]));
    return color;
}

}  // namespace

std::vector<Color> counter_colors(const std::vector<float>& counters) {
    if (counters.empty()) return {};
    const float low = percentile(counters, 0.02);
    const float high = percentile(counters, 0.98);
    std::vector<Color> colors;
    colors.reserve(counters.size());
    for (const float counter : counters) {
        const float t = high > low ? (counter - low) / (high - low) : 0.F;
        colors.push_back(on_ramp(std::clamp(t, 0.F, 1.F)));
    }
    return colors;
}

}  // namespace neuralmesh
