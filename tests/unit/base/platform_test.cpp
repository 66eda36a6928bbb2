// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/base/platform.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "vcg_core/base/random.h"

namespace neuralmesh {
namespace {

bool has_bit(std::uint64_t word, int i) { return (word >> i & 1) != 0; }

void expect_as_counted(std::uint64_t word) {
    int count = 0;
    int lowest = -1;
    int highest = -1;
    for (int i = 0; i < 64; ++i) {
        if (!has_bit(word, i)) continue;
        ++count;
        highest = i;
        if (lowest < 0) lowest = i;
    }
    EXPECT_EQ(bit_count(word), count) << word;
    if (word == 0) return;
    EXPECT_EQ(lowest_bit(word), lowest) << word;
    EXPECT_EQ(highest_bit(word), highest) << word;
}

TEST(Platform, FindsBitsAsALoopDoes) {
    expect_as_counted(0);
    Random random(1);
    for (int i = 0; i < 64; ++i) {
        expect_as_counted(std::uint64_t{1} << i);
        expect_as_counted(~std::uint64_t{0} << i);
        expect_as_counted(std::uint64_t{random.bits()} << (i % 33));
    }
}

TEST(Platform, PrefetchesAnyAddress) {
    int value = 7;
    prefetch(&value);
    prefetch_for_write(&value);
    prefetch(nullptr);
    prefetch_for_write(nullptr);
    EXPECT_EQ(value, 7);
}

}  // namespace
}  // namespace neuralmesh
