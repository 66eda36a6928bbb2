// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Numbers of tries from environment variables.
#pragma once

#include <gtest/gtest.h>

#include <charconv>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <vector>

namespace neuralmesh::environment {

/// The integer in the environment variable \p name, or \p otherwise if it is not set. Any other value, or a
/// number below \p low, fails the test: otherwise it would pass without having run anything.
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
