// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Runs the tests of a program. With NEURALMESH_TIMES=FILE it adds a line for each test to that file: its
// processor time in seconds, and its name. tests/times.py reads them.
#include <gtest/gtest.h>

#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>

namespace {

class Times : public testing::EmptyTestEventListener {
public:
    explicit Times(const std::string& file) : file_(file, std::ios::app) {}

    void OnTestStart(const testing::TestInfo& /*test*/) override { start_ = std::clock(); }

    void OnTestEnd(const testing::TestInfo& test) override {
        const double seconds = static_cast<double>(std::clock() - start_) / CLOCKS_PER_SEC;
        file_ << seconds << ' ' << test.test_suite_name() << '.' << test.name() << std::endl;
    }

private:
    std::ofstream file_;
    std::clock_t start_ = 0;
};

}  // namespace

int main(int count, char** words) {
    testing::InitGoogleTest(&count, words);
    const char* file = std::getenv("NEURALMESH_TIMES");
    if (file != nullptr) testing::UnitTest::GetInstance()->listeners().Append(new Times(file));
    return RUN_ALL_TESTS();
}
