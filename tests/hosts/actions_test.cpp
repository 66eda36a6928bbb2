// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Figures, log lines and sentences of the filter, without a host.
#include "filter_neuralmesh/actions.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace neuralmesh {
namespace {

const Figure& figure(const std::vector<Figure>& all, const std::string& key) {
    for (const Figure& one : all)
        if (key == one.key) return one;
    throw std::out_of_range(key);
}

TEST(Actions, CountsBeyondIntAreTheLargestInt) {
    constexpr int kLargest = std::numeric_limits<int>::max();
    Report report;
    for (const auto& [signals, expected] : {std::pair<long long, int>{0, 0},
                                            {1692506, 1692506},
                                            {kLargest - 1LL, kLargest - 1},
                                            {kLargest, kLargest},
                                            {kLargest + 1LL, kLargest},
                                            {60LL * 20'000'000 * 100, kLargest}}) {
        report.signals = signals;
        EXPECT_EQ(figure(figures(report), "signals").count(), expected) << signals;
        // The log has the exact number.
        EXPECT_NE(log_lines(report)[1].find("signals=" + std::to_string(signals) + " "), std::string::npos);
    }
}

TEST(Actions, CountTheWarningsAndLogThemSeparately) {
    Report report;
    EXPECT_EQ(figure(figures(report), "warnings").count(), 0);
    report.warnings = {"One.", "Two."};
    EXPECT_EQ(figure(figures(report), "warnings").count(), 2);
    for (const std::string& line : log_lines(report)) EXPECT_EQ(line.find("One."), std::string::npos) << line;
}

TEST(Actions, LogWhyLearningEnded) {
    Report report;
    report.stop_reason = StopReason::converged;
    EXPECT_NE(log_lines(report)[0].find("'Stop below mean counter'"), std::string::npos)
        << log_lines(report)[0];
}

TEST(Actions, StateTheOriginOfTheCoordinates) {
    const std::string sentence = sentence_on_origin({1e7, -4999950, 107});
    EXPECT_NE(sentence.find("(10000000, -4999950, 107)"), std::string::npos) << sentence;
}

}  // namespace
}  // namespace neuralmesh
