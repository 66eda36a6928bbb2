// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The natural logarithm from correctly rounded operations only: the last bit of std::log depends on the C
// library, and in glibc on whether the processor has fused multiply-add.
#pragma once

#include <cmath>

namespace neuralmesh {

/// ln \p x within 4e-16 of its value or of 1, whichever is larger; the same bits on every machine. \pre x > 0
/// and finite. Source: ln((1 + s) / (1 - s)) = 2 (s + s^3 / 3 + s^5 / 5 + ..).
inline double portable_log(double x) {
    constexpr double kLn2 = 0.69314718055994530942;
    constexpr double kHalfRoot = 0.70710678118654752440;
    constexpr int kLastPower = 21;  // s^2 <= .0295, so the next term is below 2e-18
    int exponent = 0;
    double m = std::frexp(x, &exponent);  // in [.5, 1)
    if (m < kHalfRoot) {
        m *= 2;
        --exponent;
    }
    const double s = (m - 1) / (m + 1);
    double sum = 0;
    for (int power = kLastPower; power > 0; power -= 2) sum = sum * (s * s) + 1.0 / power;
    return exponent * kLn2 + 2 * s * sum;
}

}  // namespace neuralmesh
