// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Decisions of a run: its plan, open or closed, and how many vertices an error needs.
#include "tests/unit/support/prelude.h"
#include "tests/unit/support/referee.h"
#include "vcg_core/error_search.h"
#include "vcg_core/open_or_closed.h"
#include "vcg_core/plan.h"

namespace neuralmesh::decisions_test {

using ErrorOf = std::function<double(int vertices)>;

Circumstances circumstances(int vertices, std::size_t points, double noise = 0) {
    Circumstances given;
    given.vertices = vertices;
    given.points = points;
    given.noise = noise;
    given.carried_by_points = points / 2;
    given.closed = true;
    return given;
}

constexpr int kVertices[] = {100, 500, 1000, 1500, 2000, 3000, 5000, 10000, 50000};

TEST(Plan, ChangesLittleWhereTheNoiseDoes) {
    constexpr double kStep = 0.0002;
    for (const int vertices : kVertices)
        for (double noise = 0; noise < 0.5; noise += kStep) {
            const Plan less = plan_for(circumstances(vertices, 1000000, noise));
            const Plan more = plan_for(circumstances(vertices, 1000000, noise + kStep));
            EXPECT_LE(more.grow_to, less.grow_to) << vertices << ' ' << noise;
            EXPECT_NEAR(more.grow_to, less.grow_to, 0.02 * less.grow_to + 80) << vertices << ' ' << noise;
            EXPECT_NEAR(more.growth_share, less.growth_share, 0.02) << vertices << ' ' << noise;
            EXPECT_NEAR(more.settling_share, less.settling_share, 0.02) << vertices << ' ' << noise;
        }
}

TEST(Plan, ChangesLittleWhereTheNumberOfPointsDoes) {
    for (const int vertices : kVertices)
        for (double points = vertices / 16; points < 1e6; points *= 1.01) {
            const Plan fewer = plan_for(circumstances(vertices, static_cast<std::size_t>(points)));
            const Plan more = plan_for(circumstances(vertices, static_cast<std::size_t>(1.01 * points)));
            EXPECT_GE(more.carried, fewer.carried) << vertices << ' ' << points;
            EXPECT_GE(more.grow_to, fewer.grow_to) << vertices << ' ' << points;
            EXPECT_LE(more.grow_to, 1.02 * fewer.grow_to + 1) << vertices << ' ' << points;
        }
}

TEST(Plan, ChangesLittleWhereTheVerticesAskedForDo) {
    for (const double noise : {0.0, 0.07, 0.12, 0.3})
        for (double vertices = 50; vertices < 1e5; vertices *= 1.01) {
            const Plan fewer = plan_for(circumstances(static_cast<int>(vertices), 1000000, noise));
            const Plan more = plan_for(circumstances(static_cast<int>(1.01 * vertices), 1000000, noise));
            EXPECT_NEAR(more.grow_to, fewer.grow_to, 0.05 * fewer.grow_to) << vertices << ' ' << noise;
            EXPECT_NEAR(more.growth_share, fewer.growth_share, 0.02) << vertices << ' ' << noise;
        }
}

TEST(Plan, PointsThatCarryFewerVerticesLeaveTheOthersToTheFit) {
    const Plan plan = plan_for(circumstances(10000, 8000));
    EXPECT_EQ(plan.carried, 4000);
    EXPECT_EQ(plan.grow_to, 4000);
    Circumstances exact = circumstances(10000, 8000);
    exact.exact = true;
    EXPECT_EQ(plan_for(exact).carried, 10000);
}

TEST(Plan, ShapeChoosesOnClosedSurfacesWithLittleNoiseAndFewOutliers) {
    Circumstances given = circumstances(5000, 100000);
    EXPECT_TRUE(plan_for(given).by_volume);
    given.closed = false;
    EXPECT_FALSE(plan_for(given).by_volume);
    given.closed = true;
    given.noise = 0.3;
    EXPECT_FALSE(plan_for(given).by_volume);
    given.noise = 0;
    given.outliers = 0.25;
    EXPECT_FALSE(plan_for(given).by_volume);
}

TEST(Plan, TheMoreIsRemovedAndTheLargerTheNoiseTheFewerSignalsDo) {
    EXPECT_LT(plan_for(circumstances(1000, 100000)).growth_share, 0.6);
    const double calm = plan_for(circumstances(6000, 20000, 0.02)).growth_share;
    EXPECT_LT(plan_for(circumstances(6000, 20000, 0.2)).growth_share, 0.6 * calm);
}

TEST(Plan, VerticesSettleForHalfTheSignalsWhereMostStay) {
    EXPECT_EQ(plan_for(circumstances(50000, 1000000)).settling_share, 0.5);
    EXPECT_LT(plan_for(circumstances(500, 100000)).settling_share, 0.2);
}

TEST(Plan, NothingIsRemovedThatTheFitMayNotRedistribute) {
    Circumstances given = circumstances(500, 100000);
    given.redistributes = false;
    const Plan plan = plan_for(given);
    EXPECT_EQ(plan.grow_to, 500);
    EXPECT_EQ(plan.growth_share, 1);
    EXPECT_EQ(plan.settling_share, 1);
}

/// A shell that closed an opening, of a surface of which a share encloses nothing.
Enclosure shell_with(double widest_opening, double sheet_share) {
    Enclosure shell;
    shell.widest_opening = widest_opening;
    shell.sheet_share = sheet_share;
    return shell;
}

OpenStart start_that_leaves_out(double share) {
    OpenStart start;
    start.left_out = share;
    return start;
}

TEST(OpenOrClosed, WideOpeningsAndSheetsMayBeOpen) {
    const TargetSpace target = target_of(shapes::sphere_cloud(1000));
    const auto may_be = [&](const Enclosure& shell, double radius) {
        return may_be_open(shell, target, Settings(), radius);
    };
    EXPECT_FALSE(may_be(shell_with(0, 0), 0));
    EXPECT_FALSE(may_be(shell_with(0.03, 0.03), 0));
    EXPECT_TRUE(may_be(shell_with(0.05, 0), 0));
    EXPECT_TRUE(may_be(shell_with(0, 0.06), 0));
    // Where the points are sparse such gaps are between them.
    EXPECT_FALSE(may_be(shell_with(0.05, 0.06), 0.04));
    Enclosure walled = shell_with(0.05, 0.06);
    walled.walled = true;
    EXPECT_FALSE(may_be(walled, 0));
    Enclosure sheet;
    sheet.encloses_space = false;
    EXPECT_TRUE(may_be(sheet, 0));
}

TEST(OpenOrClosed, TheStartThatLosesLessIsTaken) {
    // Views that do not quite meet: clutter to the open start, and to the shell not much of a sheet.
    EXPECT_TRUE(loses_more(start_that_leaves_out(0.3), shell_with(0, 0.2)));
    // One layer, a few points of which are clutter.
    EXPECT_FALSE(loses_more(start_that_leaves_out(0.3), shell_with(0, 0.9)));
    EXPECT_FALSE(loses_more(start_that_leaves_out(0.02), shell_with(0, 0)));
    // A shell that encloses nothing loses everything.
    Enclosure sheet;
    sheet.encloses_space = false;
    EXPECT_FALSE(loses_more(start_that_leaves_out(0.3), sheet));
}

TEST(OpenOrClosed, ALayerWithAWideBoundaryThatLosesNothingIsOpen) {
    const TargetSpace target = target_of(shapes::sphere_cloud(1000));
    const Enclosure shell = shell_with(0.05, 0);
    Settings settings;
    const auto is = [&](const OpenStart& start) { return is_open(start, shell, target, settings); };
    OpenStart start;
    start.loops = 1;
    start.widest_loop = 0.1;
    EXPECT_TRUE(is(start));
    OpenStart other = start;
    other.loops = 0;
    EXPECT_FALSE(is(other));
    other = start;
    other.layers.two = true;
    EXPECT_FALSE(is(other));
    other = start;
    other.misses_surface = true;
    EXPECT_FALSE(is(other));
    other = start;
    other.left_out = 0.3;
    EXPECT_FALSE(is(other));
    // Holes so narrow are closed, unless the user says which are.
    start.widest_loop = 0.05;
    EXPECT_FALSE(is(start));
    settings.close_holes_up_to = 0;
    EXPECT_TRUE(is(start));
}

TEST(OpenOrClosed, AClosedLayerEnclosesMoreThanAShellThatFoundNoSpace) {
    Enclosure sheet;
    sheet.encloses_space = false;
    OpenStart start;
    EXPECT_TRUE(encloses_more(start, sheet));
    EXPECT_FALSE(encloses_more(start, Enclosure()));
    start.loops = 1;
    EXPECT_FALSE(encloses_more(start, sheet));
}

// The search for the number of vertices, on errors that fall as those of meshes do.

/// Runs \p search on \p error. \return the number of trials
int run(ErrorSearch& search, const ErrorOf& error) {
    int trials = 0;
    for (int n = search.next(); n != 0; n = search.next(), ++trials) search.add(n, error(n));
    return trials;
}

ErrorOf power(double at_1000, double exponent) {
    return [=](int n) { return at_1000 * std::pow(n / 1000.0, -exponent); };
}

TEST(ErrorSearch, ReachesErrorsThatFallWithFewVerticesAndTrials) {
    using WantedAndExponent = std::pair<double, double>;
    for (const auto& [wanted, exponent] : std::vector<WantedAndExponent>{
             {1, 1}, {0.05, 1}, {20, 1}, {0.2, 0.5}, {5, 0.5}, {0.1, 1.4}, {3, 1.4}, {0.97, 1}, {1.08, 1}}) {
        SCOPED_TRACE(testing::Message() << wanted << " by the exponent " << exponent);
        const double needed = 1000 * std::pow(1 / wanted, 1 / exponent);
        ErrorSearch search(wanted, 4, 10000000);
        EXPECT_LE(run(search, power(1, exponent)), 6);
        EXPECT_TRUE(search.reached());
        EXPECT_LE(search.best().error, 1.05 * wanted);
        EXPECT_LE(search.best().vertices, 1.25 * needed);
    }
}

TEST(ErrorSearch, TakesTheMostVerticesIfTheyDoNotSuffice) {
    ErrorSearch search(0.01, 4, 10000);
    run(search, power(1, 1));
    EXPECT_FALSE(search.reached());
    EXPECT_FALSE(search.levels_off());
    EXPECT_EQ(search.best().vertices, 10000);
}

TEST(ErrorSearch, EndsWhereTheErrorLevelsOff) {
    const auto of_noise = [](int n) { return std::hypot(1000.0 / n, 0.5); };
    ErrorSearch search(0.1, 4, 10000000);
    EXPECT_LE(run(search, of_noise), 5);
    EXPECT_FALSE(search.reached());
    EXPECT_TRUE(search.levels_off());
    EXPECT_LE(search.best().vertices, 20000);
    EXPECT_LE(search.best().error, 0.55);
}

TEST(ErrorSearch, KeepsToTheLeastAndTheMost) {
    ErrorSearch coarse(100, 50, 10000), only(0.5, 4, 4), none(1, 5, 4);
    run(coarse, power(1, 1));
    EXPECT_EQ(coarse.best().vertices, 50);
    run(only, power(1, 1));
    EXPECT_EQ(only.best().vertices, 4);
    EXPECT_EQ(none.next(), 0);
}

TEST(ErrorSearch, TriesNoNumberThatWasTooFew) {
    ErrorSearch search(20, 4, 10000);
    int trials = 0;
    for (int n = search.next(); n != 0 && trials < 20; n = search.next(), ++trials) {
        if (n < 300) {
            search.too_few(n);
        } else {
            search.add(n, power(1, 1)(n));
        }
    }
    EXPECT_LT(trials, 10);
    EXPECT_LE(search.best().vertices, 450);
}

TEST(ErrorSearch, StandsErrorsThatJumpAndThoseOfZero) {
    ErrorSearch jumps(0.5, 4, 100000), exact(0.5, 4, 100000);
    EXPECT_LE(run(jumps, [](int n) { return n < 1500 ? 1.0 : 0.01; }), 8);
    EXPECT_TRUE(jumps.reached());
    EXPECT_LE(jumps.best().vertices, 1.25 * 1500);
    EXPECT_LE(run(exact, [](int) { return 0.0; }), 8);
    EXPECT_LE(exact.best().vertices, 8);
}

}  // namespace neuralmesh::decisions_test
