// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Figures, log lines and sentences of the filter, without a host.
#include "filter_neuralmesh/actions.h"

#include "tests/unit/support/prelude.h"

namespace neuralmesh::actions_test {

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

TEST(Actions, TellMessagesALineEach) {
    Report report;
    report.topology_confidence = 0.9;
    report.notes = {"Two\nlines."};
    report.warnings = {"One."};
    const std::string lines = messages_of(report);
    EXPECT_EQ(lines.find("note\tNeural Mesh: 0 vertices"), 0U) << lines;
    EXPECT_NE(lines.find("\nnote\tThe surface was found"), std::string::npos) << lines;
    EXPECT_NE(lines.find("\nnote\tTwo lines.\nwarning\tOne.\n"), std::string::npos) << lines;
    EXPECT_EQ(lines.find("vertices="), std::string::npos) << lines;  // the results
    EXPECT_EQ(message_of_error("Bad."), "error\tBad.\n");
}

TEST(Actions, ReportCountersWithoutFiguresOfAReconstruction) {
    Report report;
    report.vertices = 642;
    report.signals = 60000;
    EXPECT_EQ(log_lines(report, kCounters)[0].find("Neural Normal Counter: 642 vertices"), 0U);
    EXPECT_EQ(log_lines(report, kCounters)[0].find("cancelled"), std::string::npos);
    for (const char* other : {"genus", "faces", "rms_error"})
        EXPECT_THROW(figure(figures(report, kCounters), other), std::out_of_range) << other;
    EXPECT_EQ(figure(figures(report, kCounters), "signals").count(), 60000);
    report.stop_reason = StopReason::cancelled;
    EXPECT_NE(log_lines(report, kCounters)[0].find("it was cancelled."), std::string::npos);
}

TEST(Actions, HaveIdsInOrderAndNamesThatPymeshlabCanCall) {
    for (std::size_t i = 0; i < all_actions().size(); ++i) {
        const Action& action = all_actions()[i];
        EXPECT_EQ(action.id, static_cast<int>(i));
        EXPECT_EQ(&action_of(action.id), &action);
        EXPECT_EQ(std::string(action.python_name).find_first_not_of("abcdefghijklmnopqrstuvwxyz_"),
                  std::string::npos);
    }
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

}  // namespace neuralmesh::actions_test
