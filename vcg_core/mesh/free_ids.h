// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The ids of vertices that are gone or have not come yet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace neuralmesh {

/// A set of ids from which one can be taken that is near another: where ids follow places, a new vertex comes
/// to share the cache lines of its surroundings.
class FreeIds {
public:
    /// What take() looks through around an id, in words of 64 ids.
    static constexpr std::size_t kWordsAround = 2;

    int count() const { return count_; }
    /// \p id must not be in it. Amortised O(1).
    void add(std::int32_t id);
    /// Takes out one that shares a word with \p id or lies in a word near it; the smallest, if there is none.
    /// Must not be empty. Amortised O(1).
    std::int32_t take(std::int32_t id);
    std::size_t bytes() const { return words_.size() * sizeof(std::uint64_t); }

private:
    bool holds_any(std::size_t word) const { return word < words_.size() && words_[word] != 0; }
    std::int32_t take_bit(std::size_t word, int bit);

    std::vector<std::uint64_t> words_;
    std::size_t first_ = 0;  ///< words before it are empty
    int count_ = 0;
};

}  // namespace neuralmesh
