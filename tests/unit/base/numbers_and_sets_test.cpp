// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Numbers that are the same everywhere: random ones, bits, logarithms, vectors and normals in three bytes;
// sets and queues.
#include "tests/unit/support/prelude.h"
#include "tests/unit/support/shapes.h"
#include "vcg_core/base/colors_and_normals.h"
#include "vcg_core/base/disjoint_sets.h"
#include "vcg_core/base/lanes.h"
#include "vcg_core/base/lazy_priority_queue.h"
#include "vcg_core/base/logarithm.h"
#include "vcg_core/base/platform.h"
#include "vcg_core/base/simd.h"

namespace neuralmesh::numbers_and_sets_test {

TEST(Random, GivesTheSameNumbersOnEveryPlatform) {
    Random random(1);
    for (const std::uint32_t expected : {4142164973u, 2600129076u, 2454374945u, 111077108u})
        EXPECT_EQ(random.bits(), expected);
}

TEST(Random, BelowIsUniform) {
    constexpr std::uint32_t kValues = 7;
    constexpr int kDraws = 70000;
    std::array<int, kValues> seen{};
    Random random(3);
    for (int i = 0; i < kDraws; ++i) {
        const std::uint32_t value = random.below(kValues);
        ASSERT_LT(value, kValues);
        ++seen[value];
    }
    // Five standard deviations of a binomial distribution.
    for (const int count : seen) EXPECT_NEAR(count, 10000, 5 * std::sqrt(10000 * 6.0 / 7));
}

TEST(Random, UnitIsAMultipleOfItsStepBelowOne) {
    Random random(4);
    double sum = 0;
    for (int i = 0; i < 100000; ++i) {
        const float value = random.unit();
        ASSERT_TRUE(value >= 0 && value < 1);
        ASSERT_EQ(std::floor(value * 0x1p24F), value * 0x1p24F);
        sum += static_cast<double>(value);
    }
    EXPECT_NEAR(sum / 100000, 0.5, 0.005);
}

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

TEST(Logarithm, AgreesWithTheLibrary) {
    for (double x = 1e-300; x < 1e300; x *= 1.0173) {
        const double expected = std::log(x);
        ASSERT_NEAR(portable_log(x), expected, 4e-16 * std::max(1.0, std::abs(expected))) << x;
    }
    for (double x = 0.7; x < 1.5; x += 1e-4) ASSERT_NEAR(portable_log(x), std::log(x), 4e-16) << x;
}

// The portable vectors of lanes.h against the ones that simd.h chooses for this compiler, lane by lane and
// bit by bit.

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

// Normals in three bytes.

PackedNormal pack(const vcg::Point3d& n) { return packed({n[0], n[1], n[2]}); }

TEST(PackedNormal, KeepsTheDirectionOfAnyLength) {
    Random random(1);
    for (int i = 0; i < 10000; ++i) {
        const vcg::Point3d n = shapes::in_ball(random).Normalize();
        for (const double length : {1.0, 1e-300, 1e300}) {
            const PackedNormal small = pack(n * length);
            EXPECT_EQ(small, pack(n));
            const vcg::Point3d back = vcg::Point3d::Construct(unpacked(small));
            EXPECT_NEAR(back.Norm(), 1, 0.01);
            EXPECT_GT(back * n / back.Norm(), std::cos(0.4 * M_PI / 180));
        }
    }
}

TEST(PackedNormal, IsNoneOfWhatHasNoDirection) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    for (const vcg::Point3d& n : {vcg::Point3d(0, 0, 0), vcg::Point3d(-0.0, 0, 0), vcg::Point3d(1, nan, 0),
                                  vcg::Point3d(infinity, 1, 0)})
        EXPECT_EQ(pack(n), kNoNormal);
    EXPECT_EQ(unpacked(kNoNormal), vcg::Point3f(0, 0, 0));
    EXPECT_EQ(pack({0, 0, -2}), (PackedNormal{0, 0, -127}));
}

// Sets and queues against plain ones.

// Disjoint sets against labels that are rewritten whole.

TEST(DisjointSets, AreThoseOfLabelsRewrittenAtEachJoin) {
    constexpr std::uint32_t kCount = 60;
    Random random(1);
    DisjointSets sets(kCount);
    std::vector<int> least(kCount);  // of the set of each number
    std::iota(least.begin(), least.end(), 0);
    for (int step = 0; step < 100; ++step) {
        const auto a = random.below(kCount), b = random.below(kCount);
        const int low = std::min(least[a], least[b]), high = std::max(least[a], least[b]);
        EXPECT_EQ(sets.join(static_cast<int>(a), static_cast<int>(b)), low != high);
        for (int& label : least) label = label == high ? low : label;
        for (std::uint32_t i = 0; i < kCount; ++i) ASSERT_EQ(sets.find(static_cast<int>(i)), least[i]);
    }
}

/// The cost that something had when it had changed so many times.
struct Entry {
    double cost = 0;
    int id = 0;
    int changes = 0;

    bool operator<(const Entry& other) const { return std::tie(cost, id) < std::tie(other.cost, other.id); }
};

TEST(LazyPriorityQueue, TakesWhatAPlainSetTakes) {
    constexpr int kCount = 5000;
    Random random(1);
    std::vector<int> changes(kCount, 0);
    LazyPriorityQueue<Entry> queue;
    std::set<std::pair<double, int>> plain;
    std::vector<double> cost_of(kCount, 0);
    const auto push = [&](int id, double cost) {
        plain.erase({cost_of[static_cast<std::size_t>(id)], id});
        cost_of[static_cast<std::size_t>(id)] = cost;
        plain.insert({cost, id});
        queue.push({cost, id, ++changes[static_cast<std::size_t>(id)]});
    };
    const auto is_current = [&](const Entry& entry) {
        return changes[static_cast<std::size_t>(entry.id)] == entry.changes;
    };
    for (int id = 0; id < kCount; ++id) push(id, random.below(1000));
    Entry entry;
    int taken = 0;
    while (queue.pop(entry, is_current)) {
        ASSERT_FALSE(plain.empty());
        ASSERT_EQ(*plain.begin(), std::pair(entry.cost, entry.id)) << taken;
        plain.erase(plain.begin());
        ++changes[static_cast<std::size_t>(entry.id)];
        // Others change, or come again, some of them cheaper than what was taken.
        for (int i = 0; ++taken < 20000 && i < 3; ++i)
            push(static_cast<int>(random.below(kCount)), entry.cost - 20 + random.below(200));
    }
    EXPECT_GT(taken, 20000);
    EXPECT_TRUE(plain.empty());
    EXPECT_FALSE(queue.pop(entry, is_current));
    queue.push({0, 1, changes[1]});
    EXPECT_TRUE(queue.pop(entry, is_current));
    EXPECT_EQ(entry.id, 1);
}

}  // namespace neuralmesh::numbers_and_sets_test
