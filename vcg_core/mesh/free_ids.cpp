// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/mesh/free_ids.h"

#include <algorithm>

#include "vcg_core/base/platform.h"

namespace neuralmesh {

namespace {

/// Position of the set bit of \p word nearest to \p bit; of two, the higher. \pre word != 0
int nearest(std::uint64_t word, int bit) {
    const std::uint64_t above = word >> bit << bit;
    const std::uint64_t below = word ^ above;
    if (above == 0) return highest_bit(below);
    if (below == 0) return lowest_bit(above);
    return lowest_bit(above) - bit <= bit - highest_bit(below) ? lowest_bit(above) : highest_bit(below);
}

}  // namespace

void FreeIds::add(std::int32_t id) {
    const auto word = static_cast<std::size_t>(id) / 64;
    if (word >= words_.size()) words_.resize(word + 1, 0);
    words_[word] |= std::uint64_t{1} << (id % 64);
    first_ = std::min(first_, word);
    ++count_;
}

std::int32_t FreeIds::take(std::int32_t id) {
    const auto word = static_cast<std::size_t>(id) / 64;
    if (holds_any(word)) return take_bit(word, nearest(words_[word], id % 64));
    for (std::size_t d = 1; d <= kWordsAround; ++d) {
        if (holds_any(word + d)) return take_bit(word + d, lowest_bit(words_[word + d]));
        if (word >= d && holds_any(word - d)) return take_bit(word - d, highest_bit(words_[word - d]));
    }
    while (words_[first_] == 0) ++first_;
    return take_bit(first_, lowest_bit(words_[first_]));
}

std::int32_t FreeIds::take_bit(std::size_t word, int bit) {
    words_[word] &= ~(std::uint64_t{1} << bit);
    --count_;
    return static_cast<std::int32_t>(64 * word) + bit;
}

}  // namespace neuralmesh
