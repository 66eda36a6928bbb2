// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// An array of numbers that is multiplied by a factor in O(1), without overflow or underflow.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "vcg_core/base/bits.h"
#include "vcg_core/base/indexed.h"
#include "vcg_core/base/permuted.h"
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

    /// A reference to number i, for numbers[i] += amount.
    class Entry {
    public:
        Entry(ScaledNumbers& numbers, int i) : numbers_(numbers), i_(i) {}
        /// \p amount >= 0. O(1).
        void operator+=(double amount) const {
            numbers_.store(i_, numbers_.unscaled(i_) + amount * numbers_.inverse_scale_);
        }

    private:
        ScaledNumbers& numbers_;
        int i_;
    };
    Entry operator[](int i) { return {*this, i}; }

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
    /// Number i becomes that of \p order[i]. O(n).
    void renumber(const std::vector<std::int32_t>& order) { keys_ = permuted(keys_, order); }
    void prefetch(int i) const { prefetch_for_write(&keys_[i]); }
    std::size_t bytes() const { return keys_.vector().size() * sizeof(double); }

private:
    static constexpr std::int64_t kExponentBias = 1023;
    static constexpr int kMantissaBits = 52;

    /// 2^exponent; 0 below the range of normal numbers.
    static double power_of_two(std::int64_t exponent) {
        return exponent < 1 - kExponentBias
                   ? 0
                   : bit_cast<double>(static_cast<std::uint64_t>(exponent + kExponentBias) << kMantissaBits);
    }
    /// The key of value x 2^exponent. \p value must be a normal positive number.
    static double key_of(double value, double exponent) {
        const auto bits = bit_cast<std::uint64_t>(value);
        const std::int64_t own = static_cast<std::int64_t>(bits >> kMantissaBits) - kExponentBias;
        const std::uint64_t mantissa = bits & ((std::uint64_t{1} << kMantissaBits) - 1);
        return exponent + static_cast<double>(own) +
               (bit_cast<double>(mantissa | static_cast<std::uint64_t>(kExponentBias) << kMantissaBits) - 1);
    }
    /// The largest integer not above x, for |x| < 2^62.
    static std::int64_t floor_of(double x) {
        const auto truncated = static_cast<std::int64_t>(x);
        return truncated - (static_cast<double>(truncated) > x ? 1 : 0);
    }

    /// Number i times inverse_scale_.
    double unscaled(int i) const {
        const double key = keys_[i];
        if (key == kZero) return 0;
        const std::int64_t exponent = floor_of(key);
        const double mantissa = 1 + (key - static_cast<double>(exponent));
        return mantissa * power_of_two(exponent - static_cast<std::int64_t>(inverse_scale_exponent_));
    }
    void store(int i, double unscaled) {
        keys_[i] = unscaled >= std::numeric_limits<double>::min() ? key_of(unscaled, inverse_scale_exponent_)
                                                                  : kZero;
    }

    /// 1 / scale = inverse_scale_ x 2^inverse_scale_exponent_, inverse_scale_ in [1, 2).
    double inverse_scale_ = 1;
    double inverse_scale_exponent_ = 0;
    Indexed<double> keys_;
};

}  // namespace neuralmesh
