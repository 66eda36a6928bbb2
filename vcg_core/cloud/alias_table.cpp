// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/cloud/alias_table.h"

#include <algorithm>
#include <numeric>

namespace neuralmesh {

AliasTable::AliasTable(const std::vector<double>& weights) : columns_(weights.size()) {
    const double mean =
        std::accumulate(weights.begin(), weights.end(), 0.0) / static_cast<double>(weights.size());
    std::vector<double> left(weights.size());  // of the probability, in columns
    std::vector<std::uint32_t> small;
    std::vector<std::uint32_t> large;
    for (std::uint32_t i = 0; i < weights.size(); ++i) {
        left[i] = weights[i] / mean;
        columns_[i] = {0xffffffffU, i};
        (left[i] < 1 ? small : large).push_back(i);
    }
    while (!small.empty() && !large.empty()) {
        const std::uint32_t filled = small.back();
        const std::uint32_t giver = large.back();
        small.pop_back();
        columns_[filled] = {static_cast<std::uint32_t>(std::min(left[filled] * 0x1p32, 0x1p32 - 1)), giver};
        left[giver] -= 1 - left[filled];
        if (left[giver] >= 1) continue;
        large.pop_back();
        small.push_back(giver);
    }
}

}  // namespace neuralmesh
