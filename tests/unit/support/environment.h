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

/// True in `./run.sh test full`, which sets NEURALMESH_FULL: all that a test can vary is to be tried.
/// Otherwise the variations that find most.
inline bool full() { return std::getenv("NEURALMESH_FULL") != nullptr; }

/// What to try: \p always, and in the second tier \p in_full as well.
template <class T>
std::vector<T> in_tiers(std::vector<T> always, const std::vector<T>& in_full) {
    if (full()) always.insert(always.end(), in_full.begin(), in_full.end());
    return always;
}

/// Whether to try the \p i-th of some cases in the \p j-th of \p count ways: in all ways in the second tier,
/// otherwise each case in one way, by turns.
inline bool tried(std::size_t i, std::size_t j, std::size_t count) { return full() || i % count == j; }

}  // namespace neuralmesh::environment
