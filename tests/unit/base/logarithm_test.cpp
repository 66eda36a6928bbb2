// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/base/logarithm.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace neuralmesh {
namespace {

TEST(Logarithm, AgreesWithTheLibrary) {
    for (double x = 1e-300; x < 1e300; x *= 1.0173) {
        const double expected = std::log(x);
        ASSERT_NEAR(portable_log(x), expected, 4e-16 * std::max(1.0, std::abs(expected))) << x;
    }
    for (double x = 0.7; x < 1.5; x += 1e-4) ASSERT_NEAR(portable_log(x), std::log(x), 4e-16) << x;
}

}  // namespace
}  // namespace neuralmesh
