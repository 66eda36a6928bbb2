// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// An array of numbers that is multiplied by a factor in O(1), without overflow or underflow, and a priority
// queue over indices whose keys change all the time.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "vcg_core/base/indexed.h"
#include "vcg_core/base/platform.h"

namespace neuralmesh {

/// Non-negative numbers with a common scale, which `numbers *= factor` changes in O(1).
///
/// Each number is stored divided by the scale. After a few thousand factors of 0.95 that quotient exceeds
/// every double, so it is stored as a key: one double that holds exponent + (mantissa - 1), with the mantissa
/// in [1, 2). Keys order like the numbers, and a change of the scale does not change them, so a Tournament
/// over the keys finds the largest number.
///
/// Precision: exponent and mantissa share the 52 bits of the key. With factor 0.95 the mantissa keeps about
/// 35 bits after a million factors and 25 after a billion. No logarithm is computed, so the results have the
/// same bits on every machine.
class ScaledNumbers {
public:
    static constexpr double kZero = -1e299;  ///< key of the number 0: below all others

    /// Adds \p amount, at least 0, to number i. O(1).
    void add(int i, double amount) { store(i, unscaled(i) + amount * inverse_scale_); }
    /// Multiplies all numbers by \p factor, in (0, 1]. Amortised O(1).
    void operator*=(double factor) {
        inverse_scale_ /= factor;
        while (inverse_scale_ >= 2) {
            inverse_scale_ /= 2;
            inverse_scale_exponent_ += 1;
        }
    }
    /// Divides number i between i and j: i keeps \p part of it, in [0, 1], j becomes the rest.
    void divide(int i, int j, double part) {
        const double whole = unscaled(i);
        store(i, whole * part);
        store(j, whole * (1 - part));
    }
    /// Number i; 0 if it is below the range of double.
    double value(int i) const { return unscaled(i) / inverse_scale_; }
    /// The key of number i.
    double key(int i) const { return keys_[i]; }

    int size() const { return keys_.size(); }
    /// New numbers are 0.
    void resize(int size) { keys_.resize(size, kZero); }
    void set_zero(int i) { keys_[i] = kZero; }
    /// Number i becomes that of \p order[i], or 0 where that is -1. O(n).
    void renumber(const std::vector<std::int32_t>& order) { keys_ = permuted(keys_, order, kZero); }
    void prefetch(int i) const { prefetch_for_write(&keys_[i]); }

private:
    /// Number i times inverse_scale_.
    double unscaled(int i) const {
        const double key = keys_[i];
        if (key == kZero) return 0;
        constexpr double kBelowAll = -2000;  // exponents of double
        const double exponent = std::floor(key);
        return std::ldexp(1 + (key - exponent),
                          static_cast<int>(std::max(exponent - inverse_scale_exponent_, kBelowAll)));
    }
    void store(int i, double unscaled) {
        int exponent = 0;
        const double mantissa = 2 * std::frexp(unscaled, &exponent);
        keys_[i] = unscaled >= std::numeric_limits<double>::min()
                       ? inverse_scale_exponent_ + (exponent - 1) + (mantissa - 1)
                       : kZero;
    }

    /// 1 / scale = inverse_scale_ x 2^inverse_scale_exponent_, inverse_scale_ in [1, 2).
    double inverse_scale_ = 1;
    double inverse_scale_exponent_ = 0;
    Indexed<double> keys_;
};

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
    /// Index i gets the key of \p order[i]; it does not take part where that is -1. O(n).
    void renumber(const std::vector<std::int32_t>& order) {
        keys_ = permuted(keys_, order, kNone);
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
