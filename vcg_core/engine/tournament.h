// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A priority queue over indices whose keys change all the time.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "vcg_core/base/indexed.h"
#include "vcg_core/base/permuted.h"
#include "vcg_core/base/platform.h"

namespace neuralmesh {

/// The maximum of keys that are set one by one: a tournament of blocks of keys, then of the highest of each
/// block. A binary heap would also have to store where each index lies in it.
class Tournament {
public:
    static constexpr double kNone = -1e300;  ///< key of an index that does not take part

    /// New indices do not take part. O(n).
    void resize(int size) {
        keys_.resize(size, kNone);
        tops_.resize((size + kBlock - 1) / kBlock, kNone);
    }
    /// Sets the key of index i. O(1) if it rises, else O(block).
    void set(int i, double key) {
        double& old = keys_[i];
        double& top = tops_[i / kBlock];
        const bool was_top = old == top;
        old = key;
        if (key >= top) {
            top = key;
        } else if (was_top) {
            top = keys_[highest_of(i / kBlock)];
        }
    }
    double key(int i) const { return keys_[i]; }
    /// The index with the largest key, the smallest index among equals; -1 if none takes part.
    /// O(n / block + block).
    int highest() const {
        const auto top = std::max_element(tops_.begin(), tops_.end());
        if (top == tops_.end() || *top == kNone) return -1;
        return highest_of(static_cast<int>(top - tops_.begin()));
    }
    /// Index i gets the key of \p order[i]. O(n).
    void renumber(const std::vector<std::int32_t>& order) {
        keys_ = permuted(keys_, order);
        tops_.clear();
        resize(keys_.size());
        for (int block = 0; block < tops_.size(); ++block) tops_[block] = keys_[highest_of(block)];
    }
    void prefetch(int i) const { prefetch_for_write(&keys_[i]); }

private:
    static constexpr int kBlock = 64;  ///< keys

    int highest_of(int block) const {
        const auto first = keys_.begin() + block * kBlock;
        const auto end = keys_.begin() + std::min((block + 1) * kBlock, keys_.size());
        return static_cast<int>(std::max_element(first, end) - keys_.begin());
    }

    Indexed<double> keys_;
    Indexed<double> tops_;  ///< the highest key of each block
};

}  // namespace neuralmesh
