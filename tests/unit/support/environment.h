// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// How much a test is to try, as the environment says.
#pragma once

#include <gtest/gtest.h>

#include <charconv>
#include <cstdlib>
#include <cstring>
#include <system_error>

namespace neuralmesh::environment {

/// The whole number in the variable \p name of the environment, or \p otherwise where there is none; a word
/// or a number below \p low is a failure, for the test would pass having tried nothing.
inline int number_of(const char* name, int otherwise, int low) {
    const char* text = std::getenv(name);
    if (text == nullptr) return otherwise;
    int number = 0;
    const char* end = text + std::strlen(text);
    const auto read = std::from_chars(text, end, number);
    if (read.ec == std::errc() && read.ptr == end && number >= low) return number;
    ADD_FAILURE() << name << " is '" << text << "': a whole number from " << low << " on is expected.";
    return otherwise;
}

}  // namespace neuralmesh::environment
