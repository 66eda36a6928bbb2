// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/open_or_closed.h"

#include <gtest/gtest.h>

#include "tests/unit/support/shapes.h"
#include "tests/unit/support/targets.h"

namespace neuralmesh {
namespace {

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
    const TargetSpace target = targets::target_of(shapes::sphere_cloud(1000));
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

TEST(OpenOrClosed, AClosedLayerEnclosesMoreThanAShellThatFoundNoSpace) {
    Enclosure sheet;
    sheet.encloses_space = false;
    OpenStart start;
    EXPECT_TRUE(encloses_more(start, sheet));
    EXPECT_FALSE(encloses_more(start, Enclosure()));
    start.loops = 1;
    EXPECT_FALSE(encloses_more(start, sheet));
}

}  // namespace
}  // namespace neuralmesh
