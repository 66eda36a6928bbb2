// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Levels are padded to whole nodes, so that a maximum over a node never reads past the end.
#include "vcg_core/engine/tournament.h"

#include <algorithm>

namespace neuralmesh {

void Tournament::resize(int size) {
    std::size_t level = 0;
    for (auto n = static_cast<std::size_t>(size);; n = (n + kWidth - 1) / kWidth) {
        const std::size_t padded = (n + kWidth - 1) / kWidth * kWidth;
        if (level == levels_.size()) {
            levels_.emplace_back(padded, kNone);
            // A level that is added later takes its maxima from the one below.
            if (level > 0)
                for (std::size_t i = 0; i * kWidth < levels_[level - 1].size(); ++i)
                    levels_[level][i] = *std::max_element(&levels_[level - 1][i * kWidth],
                                                          &levels_[level - 1][i * kWidth] + kWidth);
        } else {
            levels_[level].resize(padded, kNone);
        }
        ++level;
        if (n <= kWidth) break;
    }
}

void Tournament::set(int i, double key) {
    const auto leaf = static_cast<std::size_t>(i);
    if (key > levels_[0][leaf]) {
        raise(leaf, key);
    } else {
        lower(leaf, key);
    }
}

/// For a key above the present one: the siblings need not be read.
void Tournament::raise(std::size_t i, double key) {
    for (auto& level : levels_) {
        if (level[i] >= key) return;
        level[i] = key;
        i /= kWidth;
    }
}

void Tournament::lower(std::size_t i, double key) {
    for (std::size_t level = 0;; ++level) {
        if (levels_[level][i] == key) return;
        levels_[level][i] = key;
        if (level + 1 == levels_.size()) return;
        const double* node = &levels_[level][i / kWidth * kWidth];
        key = *std::max_element(node, node + kWidth);
        i /= kWidth;
    }
}

int Tournament::highest() const {
    std::size_t i = 0;
    for (std::size_t level = levels_.size(); level-- > 0;) {
        const double* node = &levels_[level][i * kWidth];
        const double* top = std::max_element(node, node + kWidth);
        if (*top == kNone) return -1;
        i = i * kWidth + static_cast<std::size_t>(top - node);
    }
    return static_cast<int>(i);
}

void Tournament::renumber(const std::vector<std::int32_t>& order) {
    const std::vector<double> before = std::move(levels_[0]);
    levels_.clear();
    resize(static_cast<int>(order.size()));
    for (std::size_t i = 0; i < order.size(); ++i)
        if (order[i] >= 0) set(static_cast<int>(i), before[static_cast<std::size_t>(order[i])]);
}

std::size_t Tournament::bytes() const {
    std::size_t bytes = 0;
    for (const auto& level : levels_) bytes += level.size() * sizeof(double);
    return bytes;
}

}  // namespace neuralmesh
