// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// GoogleTest, what tests use most of the standard library, and arguments that calls need but tests do not.
// A test has what the headers of this folder include, and names the others that it needs.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "vcg_core/base/error.h"
#include "vcg_core/base/progress.h"
#include "vcg_core/base/thread_team.h"

namespace neuralmesh {

inline ThreadTeam& one_thread() {
    static ThreadTeam team(1);
    return team;
}

/// Nobody looks at the progress, or asks to stop.
inline NoProgress& unwatched() {
    static NoProgress progress;
    return progress;
}

/// The whole number in the environment variable \p name, at least \p low, or \p otherwise if it is not set.
/// What is none fails the test.
inline int number_from(const char* name, int otherwise, int low) {
    const char* text = std::getenv(name);
    const int number = text == nullptr ? otherwise : std::stoi(text);
    EXPECT_GE(number, low) << name;
    return number;
}

/// The sentence of the error that \p action throws, or nothing.
template <class Action>
std::string complaint_of(const Action& action) {
    try {
        action();
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).back(), '.') << error.what();
        return error.what();
    }
    return {};
}

/// True if one of \p sentences contains \p words.
inline bool has_one(const std::vector<std::string>& sentences, const std::string& words) {
    return std::any_of(sentences.begin(), sentences.end(),
                       [&](const std::string& each) { return each.find(words) != std::string::npos; });
}

}  // namespace neuralmesh
