// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The search for the number of vertices, on errors that fall as those of meshes do.
#include "vcg_core/error_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace neuralmesh {
namespace {

using ErrorOf = std::function<double(int vertices)>;

/// Runs \p search on \p error. \return the number of trials
int run(ErrorSearch& search, const ErrorOf& error) {
    int trials = 0;
    for (int n = search.next(); n != 0; n = search.next(), ++trials) search.add(n, error(n));
    return trials;
}

ErrorOf power(double at_1000, double exponent) {
    return [=](int n) { return at_1000 * std::pow(n / 1000.0, -exponent); };
}

struct Law {
    double wanted, exponent;
};

class ErrorsThatFall : public testing::TestWithParam<Law> {};

TEST_P(ErrorsThatFall, AreReachedWithFewVerticesAndTrials) {
    const auto [wanted, exponent] = GetParam();
    const double needed = 1000 * std::pow(1 / wanted, 1 / exponent);
    ErrorSearch search(wanted, 4, 10000000);
    EXPECT_LE(run(search, power(1, exponent)), 6);
    EXPECT_TRUE(search.reached());
    EXPECT_LE(search.best().error, 1.05 * wanted);
    EXPECT_LE(search.best().vertices, 1.25 * needed);
}

INSTANTIATE_TEST_SUITE_P(Laws, ErrorsThatFall,
                         testing::Values(Law{1, 1}, Law{0.05, 1}, Law{20, 1}, Law{0.2, 0.5}, Law{5, 0.5},
                                         Law{0.1, 1.4}, Law{3, 1.4}, Law{0.97, 1}, Law{1.08, 1}));

TEST(ErrorSearch, TakesTheMostVerticesIfTheyDoNotSuffice) {
    ErrorSearch search(0.01, 4, 10000);
    run(search, power(1, 1));
    EXPECT_FALSE(search.reached());
    EXPECT_FALSE(search.levels_off());
    EXPECT_EQ(search.best().vertices, 10000);
}

TEST(ErrorSearch, EndsWhereTheErrorLevelsOff) {
    const auto of_noise = [](int n) { return std::hypot(1000.0 / n, 0.5); };
    ErrorSearch search(0.1, 4, 10000000);
    EXPECT_LE(run(search, of_noise), 5);
    EXPECT_FALSE(search.reached());
    EXPECT_TRUE(search.levels_off());
    EXPECT_LE(search.best().vertices, 20000);
    EXPECT_LE(search.best().error, 0.55);
}

TEST(ErrorSearch, KeepsToTheLeastAndTheMost) {
    ErrorSearch coarse(100, 50, 10000), only(0.5, 4, 4), none(1, 5, 4);
    run(coarse, power(1, 1));
    EXPECT_EQ(coarse.best().vertices, 50);
    run(only, power(1, 1));
    EXPECT_EQ(only.best().vertices, 4);
    EXPECT_EQ(none.next(), 0);
}

TEST(ErrorSearch, TriesNoNumberThatWasTooFew) {
    ErrorSearch search(20, 4, 10000);
    int trials = 0;
    for (int n = search.next(); n != 0 && trials < 20; n = search.next(), ++trials) {
        if (n < 300) {
            search.too_few(n);
        } else {
            search.add(n, power(1, 1)(n));
        }
    }
    EXPECT_LT(trials, 10);
    EXPECT_LE(search.best().vertices, 450);
}

TEST(ErrorSearch, StandsErrorsThatJumpAndThoseOfZero) {
    ErrorSearch jumps(0.5, 4, 100000), exact(0.5, 4, 100000);
    EXPECT_LE(run(jumps, [](int n) { return n < 1500 ? 1.0 : 0.01; }), 8);
    EXPECT_TRUE(jumps.reached());
    EXPECT_LE(jumps.best().vertices, 1.25 * 1500);
    EXPECT_LE(run(exact, [](int) { return 0.0; }), 8);
    EXPECT_LE(exact.best().vertices, 8);
}

}  // namespace
}  // namespace neuralmesh
