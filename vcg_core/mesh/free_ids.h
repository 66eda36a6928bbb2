// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The free vertex ids of a network.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace neuralmesh {

/// A set of ids that can be searched for an id near a given one. If ids follow positions, a new vertex then
/// shares cache lines with its neighbours.
class FreeIds {
public:
    /// Words of 64 ids that take() searches on either side of the word of the given id.
    static constexpr std::size_t kWordsAround = 2;

    int count() const { return count_; }
    /// Inserts \p id. Amortised O(1). \pre the set does not contain id
    void add(std::int32_t id);
    /// Removes and returns the nearest id in the word of \p id, else one from the nearest word within
    /// kWordsAround, else the smallest. Amortised O(1). \pre count() > 0
    std::int32_t take(std::int32_t id);

private:
    bool holds_any(std::size_t word) const { return word < words_.size() && words_[word] != 0; }
    std::int32_t take_bit(std::size_t word, int bit);

    std::vector<std::uint64_t> words_;
    std::size_t first_ = 0;  ///< all words before this one are 0
    int count_ = 0;
};

}  // namespace neuralmesh
