// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// What users are told: errors and warnings.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "vcg_core/base/error.h"

namespace neuralmesh::sentences {

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

}  // namespace neuralmesh::sentences
