// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A priority queue over indices whose keys change all the time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "vcg_core/base/platform.h"

namespace neuralmesh {

/// A tournament tree: the maximum of keys that are set one by one. Each node has eight children, one cache
/// line of doubles. A binary heap would also have to store where each index lies in it.
class Tournament {
public:
    static constexpr double kNone = -1e300;  ///< key of an index that does not take part

    /// New indices do not take part. O(n).
    void resize(int size);
    /// Sets the key of index i. O(log n) at worst; O(1) where a sibling has a larger key before and after.
    void set(int i, double key);
    double key(int i) const { return levels_[0][static_cast<std::size_t>(i)]; }
    /// The index with the largest key, the smallest index among equals; -1 if none takes part. O(log n).
    int highest() const;
    /// Index i gets the key of \p order[i]; it does not take part where that is -1. O(n).
    void renumber(const std::vector<std::int32_t>& order);
    void prefetch(int i) const { prefetch_for_write(&levels_[0][static_cast<std::size_t>(i)]); }
    std::size_t bytes() const;

private:
    static constexpr std::size_t kWidth = 8;  ///< children per node

    void raise(std::size_t i, double key);
    void lower(std::size_t i, double key);

    std::vector<std::vector<double>> levels_;  ///< [0]: the keys, then maxima of kWidth each
};

}  // namespace neuralmesh
