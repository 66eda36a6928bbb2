// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/base/unset.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace neuralmesh {
namespace {

TEST(Unset, ElementsHaveTheDefaultsOfTheirType) {
    struct WithDefault {
        int value = 3;
    };
    const std::vector<WithDefault, Unset<WithDefault>> many(1000);
    for (const WithDefault& one : many) EXPECT_EQ(one.value, 3);
    const std::vector<std::string, Unset<std::string>> empty(10);
    for (const std::string& text : empty) EXPECT_EQ(text, "");
}

TEST(Unset, ElementsHaveTheValuesThatAreGiven) {
    std::vector<int, Unset<int>> numbers(100, 7);
    numbers.resize(200, 8);
    numbers.push_back(9);
    const auto copy = numbers;
    const auto moved = std::move(numbers);
    EXPECT_EQ(copy, moved);
    ASSERT_EQ(moved.size(), 201U);
    EXPECT_EQ(moved[99], 7);
    EXPECT_EQ(moved[100], 8);
    EXPECT_EQ(moved.back(), 9);
}

/// The memory of a new element is as it was: what an allocator that clears it would have overwritten.
TEST(Unset, ElementsWithoutDefaultsAreNotCleared) {
    alignas(int) unsigned char memory[sizeof(int)];
    for (unsigned char& byte : memory) byte = 0x5a;
    Unset<int> allocator;
    int* const place = reinterpret_cast<int*>(memory);
    std::allocator_traits<Unset<int>>::construct(allocator, place);
    EXPECT_EQ(memory[0], 0x5a);
    std::allocator_traits<Unset<int>>::construct(allocator, place, 4);
    EXPECT_EQ(*place, 4);
}

}  // namespace
}  // namespace neuralmesh
