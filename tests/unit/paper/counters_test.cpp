// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Counters, and the turn of normals.
#include "vcg_core/paper/counters.h"
#include "tests/unit/support/prelude.h"
#include "vcg_core/base/random.h"
#include "vcg_core/paper/growth_schedule.h"

namespace neuralmesh::counters_test {

constexpr long double kLogOfZero = -std::numeric_limits<long double>::infinity();

// The counters with a common scale against eager ones, which are multiplied one by one after every signal.

/// Section 3 of the paper to the letter: decays all counters at every win.
struct EagerCounters {
    double decay;
    int maturity;
    std::vector<long double> logs;  ///< log2 of each counter, as its decay leaves the range of numbers
    std::vector<int> wins;

    void resize(std::size_t n) {
        logs.resize(n, kLogOfZero);
        wins.resize(n);
    }
    void win(std::size_t v, double amount) {
        if (amount > 0) logs[v] = std::log2(std::exp2(logs[v]) + amount);
        ++wins[v];
        for (long double& log : logs) log += std::log2(static_cast<long double>(decay));
    }
    void share(std::size_t v, std::size_t u, double of_v, double of_u) {
        const long double sum = static_cast<long double>(of_v) + of_u;
        logs[u] = logs[v] + std::log2(of_u / sum);
        logs[v] += std::log2(of_v / sum);
        wins[v] = wins[u] = 0;
    }
    void remove(std::size_t v) {
        logs[v] = kLogOfZero;
        wins[v] = 0;
    }
    /// log2 of the highest counter among the mature; minus infinity if there is none.
    long double highest() const {
        long double most = kLogOfZero;
        for (std::size_t v = 0; v < logs.size(); ++v)
            if (wins[v] >= maturity) most = std::max(most, logs[v]);
        return most;
    }
};

/// Relative error after some hundred updates. It grows with the exponent, which shares 52 bits with the
/// mantissa.
double tolerance(double decay, int wins) {
    const double exponent = wins * -std::log2(decay) + 2;
    return 200 * exponent * 0x1p-52;
}

void compare(const UtilityCounters& lazy, const EagerCounters& eager, double relative) {
    for (std::size_t v = 0; v < eager.logs.size(); ++v) {
        const double expected = static_cast<double>(std::exp2(eager.logs[v]));
        ASSERT_NEAR(lazy.value(static_cast<VertexId>(v)), expected, relative * expected + 1e-290)
            << "vertex " << v;
        ASSERT_EQ(lazy.wins(static_cast<VertexId>(v)), eager.wins[v]) << "vertex " << v;
    }
    const long double most = eager.highest();
    const VertexId top = lazy.highest();
    if (std::isinf(most)) return;
    ASSERT_GE(top, 0);
    ASSERT_GE(eager.wins[static_cast<std::size_t>(top)], eager.maturity);
    ASSERT_NEAR(static_cast<double>(eager.logs[static_cast<std::size_t>(top)] - most), 0, 2 * relative);
}

struct Run {
    double decay;
    int maturity;
    int wins;
    int vertices;
};

void compare_over_a_run(const Run& run) {
    Random random(11);
    UtilityCounters lazy(run.decay, run.maturity);
    EagerCounters eager{run.decay, run.maturity, {}, {}};
    lazy.resize(run.vertices);
    eager.resize(static_cast<std::size_t>(run.vertices));
    const double relative = tolerance(run.decay, run.wins);
    const auto any = [&] { return random.below(static_cast<std::uint32_t>(eager.logs.size())); };
    for (int i = 0; i < run.wins; ++i) {
        // A few favourites, so that counters of very different size exist.
        const std::uint32_t v = random.below(3) == 0 ? any() : any() / 8;
        const double amount = random.below(10) == 0 ? 0 : static_cast<double>(random.unit()) * 3;
        lazy.win(static_cast<VertexId>(v), amount);
        eager.win(v, amount);
        if (i % 100 == 99) {
            const std::size_t u = eager.logs.size();
            if (u < 300) {
                lazy.resize(static_cast<int>(u) + 1);
                eager.resize(u + 1);
                const double of_v = 0.1 + static_cast<double>(random.unit());
                lazy.share(static_cast<VertexId>(v), static_cast<VertexId>(u), of_v, 0.7);
                eager.share(v, u, of_v, 0.7);
            }
            const std::uint32_t gone = any();
            lazy.remove(static_cast<VertexId>(gone));
            eager.remove(gone);
        }
        if (i % 37 == 0 || i + 1 == run.wins) compare(lazy, eager, relative);
        if (testing::Test::HasFatalFailure()) FAIL() << "at win " << i << " with decay " << run.decay;
    }
}

TEST(UtilityCounters, AreTheEagerOnesWithThePapersDecay) { compare_over_a_run({0.95, 0, 20000, 12}); }
TEST(UtilityCounters, AreTheEagerOnesWithMaturity) { compare_over_a_run({0.95, 30, 20000, 12}); }
TEST(UtilityCounters, AreTheEagerOnesOverALongRun) { compare_over_a_run({0.95, 5, 100000, 9}); }
TEST(UtilityCounters, AreTheEagerOnesWithoutDecay) { compare_over_a_run({1, 3, 20000, 20}); }
TEST(UtilityCounters, AreTheEagerOnesWithHardlyAnyDecay) { compare_over_a_run({0.999999, 0, 20000, 20}); }
TEST(UtilityCounters, AreTheEagerOnesWithTheStrongestDecay) { compare_over_a_run({0.01, 0, 20000, 20}); }

TEST(UtilityCounters, HaveNoHighestBeforeAnyIsMature) {
    UtilityCounters counters(0.95, 3);
    counters.resize(4);
    EXPECT_EQ(counters.highest(), -1);
    counters.win(2, 1);
    counters.win(2, 1);
    EXPECT_EQ(counters.highest(), -1);
    counters.win(2, 1);
    EXPECT_EQ(counters.highest(), 2);
    EXPECT_EQ(counters.wins(2), 3);
    EXPECT_EQ(counters.value(0), 0);
}

TEST(UtilityCounters, TakeTheSmallerIdAmongEquals) {
    UtilityCounters counters(1, 0);
    counters.resize(100);
    for (const VertexId v : {77, 5, 40, 99, 8}) counters.win(v, 2);
    EXPECT_EQ(counters.highest(), 5);
    counters.remove(5);
    EXPECT_EQ(counters.highest(), 8);
    counters.win(99, 1);
    EXPECT_EQ(counters.highest(), 99);
}

TEST(UtilityCounters, DeferLastsUntilTheNextWin) {
    UtilityCounters counters(1, 0);
    counters.resize(10);
    counters.win(3, 5);
    counters.win(6, 4);
    counters.defer(3);
    EXPECT_EQ(counters.highest(), 6);
    counters.win(6, 0.5);
    EXPECT_EQ(counters.highest(), 6);
    counters.win(3, 0);
    EXPECT_EQ(counters.highest(), 3);
    EXPECT_DOUBLE_EQ(counters.value(3), 5);
}

TEST(UtilityCounters, AMatureVertexOfAmountZeroCanBeSplit) {
    // A mesh that no longer turns must still be able to grow.
    UtilityCounters counters(0.95, 2);
    counters.resize(4);
    for (int i = 0; i < 5; ++i) counters.win(1, 0);
    EXPECT_EQ(counters.highest(), 1);
}

TEST(UtilityCounters, ATinyCounterStillRanksAboveNothing) {
    UtilityCounters counters(0.01, 0);
    counters.resize(2);
    counters.win(1, 1);
    for (int i = 0; i < 100000; ++i) counters.win(0, 0);
    EXPECT_EQ(counters.value(1), 0);  // 1e-200000 in a double
    EXPECT_EQ(counters.highest(), 1);
}

TEST(UtilityCounters, RenumberedAreTheSameUnderNewIds) {
    constexpr int kSlots = 700;
    UtilityCounters counters(0.95, 3);
    counters.resize(kSlots);
    Random random(6);
    for (int i = 0; i < 5000; ++i)
        counters.win(static_cast<VertexId>(random.below(kSlots)), static_cast<double>(random.unit()));
    std::vector<VertexId> order;
    for (VertexId v = 0; v < kSlots; ++v)
        if (v % 5 != 2) order.push_back((v * 3) % kSlots);  // 700 and 3 share no factor
    std::sort(order.begin(), order.end(), [](VertexId a, VertexId b) { return a * 37 % 701 < b * 37 % 701; });
    for (const int i : {0, 100, 101, 400}) order.insert(order.begin() + i, -1);
    UtilityCounters renumbered = counters;
    renumbered.renumber(order);
    VertexId best = -1;
    for (std::size_t i = 0; i < order.size(); ++i) {
        const auto v = static_cast<VertexId>(i);
        EXPECT_EQ(renumbered.value(v), order[i] < 0 ? 0 : counters.value(order[i]));
        EXPECT_EQ(renumbered.wins(v), order[i] < 0 ? 0 : counters.wins(order[i]));
        if (renumbered.wins(v) >= 3 && (best < 0 || renumbered.value(v) > renumbered.value(best))) best = v;
    }
    EXPECT_EQ(renumbered.highest(), best);
}

// The stop criterion of eq 8: mean turn of the winner's normal.

constexpr double kOneDegree = 1.523048e-4;  // 1 - cos(1 degree)

TEST(NormalTurn, IsTheAngleOfEqualTurns) {
    NormalTurn turn;
    EXPECT_EQ(turn.degrees(), 0);
    for (int i = 0; i < 100; ++i) turn.add(kOneDegree, 4);
    EXPECT_NEAR(turn.degrees(), 1, 1e-4);
}

TEST(NormalTurn, ForgetsInTenSignalsPerVertex) {
    NormalTurn turn;
    constexpr int kVertices = 3000;
    for (int i = 0; i < 40 * kVertices; ++i) turn.add(kOneDegree, kVertices);
    for (int i = 0; i < 10 * kVertices; ++i) turn.add(0, kVertices);
    EXPECT_NEAR(turn.degrees(), std::sqrt(1 / std::exp(1.0)), 0.01);
}

/// One signal in two hundred contributes nearly all of the sum, as at a sharp tip. A window of 1000 signals
/// would at times hold so few of them that the turn drops to less than half.
TEST(NormalTurn, HasNoDips) {
    NormalTurn turn;
    Random random(5);
    constexpr int kVertices = 4000;
    double least = 1e9;
    for (int i = 0; i < 60 * kVertices; ++i) {
        turn.add(random.below(200) == 0 ? 200 * kOneDegree : 0, kVertices);
        if (i > 20 * kVertices) least = std::min(least, turn.degrees());
    }
    EXPECT_GT(least, 0.9);
}

}  // namespace neuralmesh::counters_test
