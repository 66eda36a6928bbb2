// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Sheets: points that enclose no space, so that the mesh surrounds them with two layers.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>

#include "tests/unit/support/shapes.h"
#include "tests/unit/support/soundness.h"
#include "vcg_core/reconstruct.h"

namespace neuralmesh {
namespace {

using shapes::Cloud;
using soundness::expect_exact;

/// Points (x, y, height(x, y)) of the unit square where keep(x, y).
Cloud sheet(int count, const std::function<bool(double, double)>& keep,
            const std::function<double(double, double)>& height) {
    Cloud cloud;
    for (const vcg::Point3d& p : shapes::plane_cloud(count))
        if (keep(p[0], p[1])) cloud.emplace_back(p[0], p[1], height(p[0], p[1]));
    return cloud;
}

struct Sheet {
    const char* name;
    Cloud cloud;
    int genus;
};

std::vector<Sheet> sheets() {
    const auto all = [](double, double) { return true; };
    const auto flat = [](double, double) { return 0.0; };
    const auto disc = [](double x, double y) { return x * x + y * y < 0.25; };
    const auto holed = [](double x, double y) {
        const double a = (x + 0.2) * (x + 0.2) + (y + 0.2) * (y + 0.2);
        const double b = (x - 0.2) * (x - 0.2) + (y - 0.15) * (y - 0.15);
        return a > 0.015 && b > 0.022;
    };
    // A wave of a thousandth, by a polynomial, because transcendental functions differ between machines.
    const auto wave = [](double x, double y) { return 0.03 * x * y * (1 - 4 * x * x) * (1 - 4 * y * y); };
    const auto arch = [](double x, double) { return 0.4 * x * x; };
    return {{"square", sheet(8000, all, flat), 0},
            {"disc", sheet(8000, disc, flat), 0},
            {"square with two holes", sheet(8000, holed, flat), 2},
            {"wavy square", sheet(8000, all, wave), 0},
            {"arch", sheet(8000, all, arch), 0}};
}

/// Distance of \p p from the nearest point of \p cloud.
double distance(const vcg::Point3d& p, const Cloud& cloud) {
    double least = 1e30;
    for (const vcg::Point3d& q : cloud) least = std::min(least, (p - q).SquaredNorm());
    return std::sqrt(least);
}

TEST(Sheets, AreClosedOnBothSidesWithEveryVertexOnThem) {
    bool few = false;
    for (const Sheet& sheet : sheets()) {
        few = !few;
        vcg::Box3d box;
        for (const vcg::Point3d& p : sheet.cloud) box.Add(p);
        const int vertices = few ? 250 : 1000;
        SCOPED_TRACE(testing::Message() << sheet.name << ", " << vertices);
        Settings settings;
        settings.target_vertices = vertices;
        settings.surface = kClosedSurface;
        NoProgress progress;
        const NeuralMesh mesh = reconstruct(soundness::target_of(sheet.cloud), settings, progress);
        expect_exact(mesh, settings);
        EXPECT_EQ(mesh.report.components, 1);
        EXPECT_EQ(mesh.report.boundary_loops, 0);
        EXPECT_EQ(mesh.report.genus, sheet.genus);
        EXPECT_TRUE(soundness::has_warning(mesh, "closed around both of their sides"));
        EXPECT_FALSE(soundness::has_warning(mesh, "forced"));
        EXPECT_LT(mesh.report.rms_error, 1);
        double farthest = 0;
        for (const vcg::Point3d& p : mesh.positions) farthest = std::max(farthest, distance(p, sheet.cloud));
        EXPECT_LT(100 * farthest / box.Diag(), 1.5);
    }
}

}  // namespace
}  // namespace neuralmesh
