// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Runs the tests of a program.
#include <gtest/gtest.h>

int main(int count, char** words) {
    testing::InitGoogleTest(&count, words);
    return RUN_ALL_TESTS();
}
