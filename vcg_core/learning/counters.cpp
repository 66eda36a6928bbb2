// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Lazy decay with an unbounded exponent, and the tournament that finds the highest counter.
#include "vcg_core/learning/counters.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace neuralmesh {

namespace {

constexpr std::int64_t kExponentBias = 1023;
constexpr int kMantissaBits = 52;

std::uint64_t bits_of(double x) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &x, sizeof bits);
    return bits;
}

double double_of(std::uint64_t bits) {
    double x = 0;
    std::memcpy(&x, &bits, sizeof x);
    return x;
}

/// 2^exponent; 0 below the range of normal numbers.
double power_of_two(std::int64_t exponent) {
    return exponent < 1 - kExponentBias
               ? 0
               : double_of(static_cast<std::uint64_t>(exponent + kExponentBias) << kMantissaBits);
}

/// value x 2^exponent as exponent + (mantissa - 1), mantissa in [1, 2): strictly increasing in the number.
/// \p value must be a normal positive number.
double key_of(double value, double exponent) {
    const std::uint64_t bits = bits_of(value);
    const std::int64_t own = static_cast<std::int64_t>(bits >> kMantissaBits) - kExponentBias;
    const std::uint64_t mantissa = bits & ((std::uint64_t{1} << kMantissaBits) - 1);
    return exponent + static_cast<double>(own) +
           (double_of(mantissa | static_cast<std::uint64_t>(kExponentBias) << kMantissaBits) - 1);
}

/// The largest integer not above x, for |x| < 2^62.
std::int64_t floor_of(double x) {
    const auto truncated = static_cast<std::int64_t>(x);
    return truncated - (static_cast<double>(truncated) > x ? 1 : 0);
}

}  // namespace

void WindowMean::add(double value) {
    sum_ += value - values_[next_];
    values_[next_] = value;
    count_ = std::min(count_ + 1, values_.size());
    if (++next_ == values_.size()) {
        next_ = 0;
        // Summed afresh once a round: rounding cannot creep, and a sum of zeros is zero.
        sum_ = 0;
        for (const double v : values_) sum_ += v;
    }
}

void UtilityCounters::resize(int slots) {
    const auto size = static_cast<std::size_t>(slots);
    keys_.resize(size, kZero);
    wins_.resize(size, 0);
    std::size_t level = 0;
    for (std::size_t n = size;; n = (n + kWidth - 1) / kWidth) {
        // Whole lines on every level, so that a node never reads past the end.
        const std::size_t padded = (n + kWidth - 1) / kWidth * kWidth;
        if (level == tournament_.size()) {
            tournament_.emplace_back(padded, kNone);
            // A level that comes into being late must know what the one below already holds.
            if (level > 0)
                for (std::size_t i = 0; i * kWidth < tournament_[level - 1].size(); ++i)
                    tournament_[level][i] = *std::max_element(&tournament_[level - 1][i * kWidth],
                                                              &tournament_[level - 1][i * kWidth] + kWidth);
        } else {
            tournament_[level].resize(padded, kNone);
        }
        ++level;
        if (n <= kWidth) break;
    }
}

void UtilityCounters::enter(VertexId v, double key) {
    auto i = static_cast<std::size_t>(v);
    for (std::size_t level = 0;; ++level) {
        if (tournament_[level][i] == key) return;
        tournament_[level][i] = key;
        if (level + 1 == tournament_.size()) return;
        const double* line = &tournament_[level][i / kWidth * kWidth];
        key = *std::max_element(line, line + kWidth);
        i /= kWidth;
    }
}

/// enter() for a key above the present one: no sibling need be looked at.
void UtilityCounters::raise(VertexId v, double key) {
    auto i = static_cast<std::size_t>(v);
    for (auto& level : tournament_) {
        if (level[i] >= key) return;
        level[i] = key;
        i /= kWidth;
    }
}

double UtilityCounters::scaled(double key) const {
    if (key == kZero) return 0;
    const std::int64_t exponent = floor_of(key);
    const double mantissa = 1 + (key - static_cast<double>(exponent));
    return mantissa * power_of_two(exponent - static_cast<std::int64_t>(unit_exponent_));
}

double UtilityCounters::value(VertexId v) const {
    return scaled(keys_[static_cast<std::size_t>(v)]) / unit_mantissa_;
}

void UtilityCounters::win(VertexId v, double amount) {
    const auto i = static_cast<std::size_t>(v);
    const double now = scaled(keys_[i]) + amount * unit_mantissa_;
    keys_[i] = now >= std::numeric_limits<double>::min() ? key_of(now, unit_exponent_) : kZero;
    if (++wins_[i] >= maturity_) {
        if (keys_[i] > tournament_[0][i]) {
            raise(v, keys_[i]);
        } else {
            enter(v, keys_[i]);  // so old and raised by so little that it has become 0
        }
    }
    unit_mantissa_ /= decay_;
    while (unit_mantissa_ >= 2) {
        unit_mantissa_ /= 2;
        unit_exponent_ += 1;
    }
}

void UtilityCounters::share(VertexId v, VertexId u, double of_v, double of_u) {
    const double whole = scaled(keys_[static_cast<std::size_t>(v)]);
    const double sum = of_v + of_u;
    const double part = sum > 0 ? of_v / sum : 0.5;
    const auto store = [&](VertexId w, double value) {
        keys_[static_cast<std::size_t>(w)] =
            value >= std::numeric_limits<double>::min() ? key_of(value, unit_exponent_) : kZero;
        wins_[static_cast<std::size_t>(w)] = 0;
        enter(w, maturity_ == 0 ? keys_[static_cast<std::size_t>(w)] : kNone);
    };
    store(v, whole * part);
    store(u, whole * (1 - part));
}

void UtilityCounters::remove(VertexId v) {
    keys_[static_cast<std::size_t>(v)] = kZero;
    wins_[static_cast<std::size_t>(v)] = 0;
    enter(v, kNone);
}

void UtilityCounters::renumber(const std::vector<VertexId>& order) {
    keys_ = permuted(keys_, order, kZero);
    wins_ = permuted(wins_, order, 0);
    const std::vector<double> entries = permuted(tournament_[0], order, kNone);
    tournament_.clear();
    resize(static_cast<int>(order.size()));
    for (std::size_t v = 0; v < entries.size(); ++v) enter(static_cast<VertexId>(v), entries[v]);
}

void UtilityCounters::waive_maturity() {
    maturity_ = 0;
    for (std::size_t v = 0; v < keys_.size(); ++v)
        if (keys_[v] != kZero) enter(static_cast<VertexId>(v), keys_[v]);
}

std::size_t UtilityCounters::bytes() const {
    std::size_t bytes = keys_.size() * sizeof(double) + wins_.size() * sizeof(std::int32_t);
    for (const auto& level : tournament_) bytes += level.size() * sizeof(double);
    return bytes;
}

VertexId UtilityCounters::highest() const {
    std::size_t i = 0;
    for (std::size_t level = tournament_.size(); level-- > 0;) {
        const double* line = &tournament_[level][i * kWidth];
        const double* top = std::max_element(line, line + kWidth);
        if (*top == kNone) return -1;
        i = i * kWidth + static_cast<std::size_t>(top - line);
    }
    return static_cast<VertexId>(i);
}

}  // namespace neuralmesh
