// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Numbers with a common scale against ones that are multiplied one by one.
#include "vcg_core/engine/scaled_numbers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "vcg_core/base/random.h"

namespace neuralmesh {
namespace {

TEST(ScaledNumbers, AreTheNumbersMultipliedOneByOne) {
    constexpr int kCount = 20;
    Random random(3);
    for (const double factor : {1.0, 0.999, 0.95, 0.3}) {
        ScaledNumbers scaled;
        scaled.resize(kCount);
        std::vector<double> plain(kCount, 0.0);
        for (int step = 0; step < 3000; ++step) {
            const std::uint32_t i = random.below(kCount);
            const double amount = static_cast<double>(random.unit());
            scaled.add(static_cast<int>(i), amount);
            scaled *= factor;
            plain[i] += amount;
            for (double& number : plain) number *= factor;
            // The key has 52 bits for exponent and mantissa; the exponent is 2,000 to 6,000 at the end.
            for (std::size_t j = 0; j < plain.size(); ++j)
                ASSERT_NEAR(scaled.value(static_cast<int>(j)), plain[j], 1e-10 * plain[j]) << factor;
        }
    }
}

TEST(ScaledNumbers, HaveKeysInTheirOrderFarBelowTheRangeOfDouble) {
    ScaledNumbers numbers;
    numbers.resize(300);
    for (int i = 0; i < 299; ++i) {
        numbers.add(i, 1);
        for (int j = 0; j < 40; ++j) numbers *= 0.5;
    }
    EXPECT_EQ(numbers.value(0), 0) << "2^-11960";
    EXPECT_DOUBLE_EQ(numbers.value(298), std::ldexp(1.0, -40));
    EXPECT_LT(numbers.key(299), numbers.key(0)) << "the last is 0";
    for (int i = 1; i < 299; ++i) ASSERT_LT(numbers.key(i - 1), numbers.key(i));
}

TEST(ScaledNumbers, KeepTheSumWhenOneIsDivided) {
    ScaledNumbers numbers;
    numbers.resize(2);
    numbers.add(0, 8);
    numbers *= 0.95;
    numbers.divide(0, 1, 0.75);
    EXPECT_NEAR(numbers.value(0), 8 * 0.95 * 0.75, 1e-14);
    EXPECT_NEAR(numbers.value(1), 8 * 0.95 * 0.25, 1e-14);
    numbers.divide(1, 0, 0);
    EXPECT_EQ(numbers.value(1), 0);
    EXPECT_EQ(numbers.key(1), ScaledNumbers::kZero);
}

TEST(ScaledNumbers, RenumberedAreTheSameUnderNewIndices) {
    ScaledNumbers numbers;
    numbers.resize(3);
    for (int i = 0; i < 3; ++i) numbers.add(i, i + 1);
    numbers *= 0.5;
    numbers.renumber({2, -1, 0, 1});
    ASSERT_EQ(numbers.size(), 4);
    const double expected[] = {1.5, 0, 0.5, 1};
    for (int i = 0; i < 4; ++i) EXPECT_DOUBLE_EQ(numbers.value(i), expected[i]);
}

}  // namespace
}  // namespace neuralmesh
