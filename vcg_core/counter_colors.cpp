// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The ramp and its two ends.
#include "counter_colors.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace neuralmesh {

namespace {

// Every 32nd colour of viridis; between them, straight lines are hard to tell from it.
// vcglib has the ramp from 2025.07 on only.
const std::array<vcg::Color4b, 9> kRamp = {
    vcg::Color4b(68, 1, 84, 255),    vcg::Color4b(71, 45, 123, 255),  vcg::Color4b(59, 82, 139, 255),
    vcg::Color4b(44, 114, 142, 255), vcg::Color4b(33, 145, 140, 255), vcg::Color4b(40, 174, 128, 255),
    vcg::Color4b(94, 201, 98, 255),  vcg::Color4b(173, 220, 48, 255), vcg::Color4b(253, 231, 37, 255)};

float percentile(std::vector<float> values, double fraction) {
    const auto rank = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return values[static_cast<std::size_t>(rank)];
}

vcg::Color4b on_ramp(float t) {
    const float place = t * static_cast<float>(kRamp.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(place), kRamp.size() - 2);
    vcg::Color4b color;
    color.lerp(kRamp[i], kRamp[i + 1], place - static_cast<float>(i));
    color[3] = 255;
    return color;
}

}  // namespace

std::vector<vcg::Color4b> counter_colors(const std::vector<float>& counters) {
    if (counters.empty()) return {};
    const float low = percentile(counters, 0.02);
    const float high = percentile(counters, 0.98);
    std::vector<vcg::Color4b> colors;
    colors.reserve(counters.size());
    for (const float counter : counters) {
        const float t = high > low ? (counter - low) / (high - low) : 0.F;
        colors.push_back(on_ramp(std::clamp(t, 0.F, 1.F)));
    }
    return colors;
}

}  // namespace neuralmesh
