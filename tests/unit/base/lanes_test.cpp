// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The portable vectors of lanes.h against the ones that simd.h chooses for this compiler, lane by lane and
// bit by bit.
#include "vcg_core/base/lanes.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>

#include "vcg_core/base/random.h"
#include "vcg_core/base/simd.h"

namespace neuralmesh {
namespace {

// Types with attributes lose them as template arguments, hence these.
struct Floats {
    using Number = float;
    using Chosen = Eight;
};
struct Integers {
    using Number = std::int32_t;
    using Chosen = EightInts;
};
struct Words {
    using Number = std::uint32_t;
    using Chosen = EightWords;
};

/// The same random numbers as the vector of simd.h and as Lanes.
template <class Kind>
struct Both {
    explicit Both(Random& random) {
        typename Kind::Number values[8];
        for (auto& value : values) value = static_cast<typename Kind::Number>(random.below(2000)) / 16 - 40;
        std::memcpy(&chosen, values, sizeof chosen);
        std::memcpy(&plain, values, sizeof plain);
    }
    typename Kind::Chosen chosen;
    Lanes<typename Kind::Number, 8> plain;
};

template <class A, class B>
void expect_same(const A& chosen, const B& plain) {
    static_assert(sizeof(A) == sizeof(B));
    EXPECT_EQ(std::memcmp(&chosen, &plain, sizeof chosen), 0);
}

TEST(Lanes, FloatsCalculateLikeTheCompilersVectors) {
    Random random(1);
    for (int i = 0; i < 100; ++i) {
        const Both<Floats> a(random), b(random);
        expect_same(a.chosen + b.chosen, a.plain + b.plain);
        expect_same(a.chosen - 3, a.plain - 3);
        expect_same(a.chosen * b.chosen, a.plain * b.plain);
        expect_same(a.chosen / (b.chosen * b.chosen + 1), a.plain / (b.plain * b.plain + 1));
        expect_same(1 / (a.chosen + 1000), 1 / (a.plain + 1000));
        expect_same(a.chosen < b.chosen, a.plain < b.plain);
        expect_same(a.chosen > 0, a.plain > 0);
        expect_same(a.chosen == a.chosen, a.plain == a.plain);
    }
}

template <class Kind>
void expect_same_integers() {
    Random random(2);
    for (int i = 0; i < 100; ++i) {
        const Both<Kind> a(random), b(random);
        expect_same(a.chosen * b.chosen + 7, a.plain * b.plain + 7);
        expect_same((a.chosen & b.chosen) ^ (a.chosen >> 2), (a.plain & b.plain) ^ (a.plain >> 2));
        expect_same(~a.chosen | b.chosen, ~a.plain | b.plain);
        expect_same((a.chosen & 15) << 4, (a.plain & 15) << 4);
    }
}

TEST(Lanes, IntegersCalculateLikeTheCompilersVectors) {
    expect_same_integers<Integers>();
    expect_same_integers<Words>();
}

TEST(Lanes, AScalarStandsForAllLanes) {
    const Lanes<float, 4> v = 2;
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(v[i], 2);
    const Lanes<float, 4> zero{};
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(zero[i], 0);
}

}  // namespace
}  // namespace neuralmesh
