// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Exact number of vertices, manifold and orientation with settings and clouds chosen to break them, and when
// the run is cancelled.
#include "tests/unit/support/runs.h"

namespace neuralmesh::hostile_runs_test {

TEST(Reconstruct, GivesTheExactCountAsAClosedOutwardSurface) {
    const std::pair<const char*, Cloud> clouds[] = {{"sphere", shapes::sphere_cloud(3000)},
                                                    {"noisy sphere", shapes::sphere_cloud(3000, 0.05)},
                                                    {"torus", shapes::torus_cloud(3000)},
                                                    {"cube", shapes::box_cloud(3000)},
                                                    {"slab", shapes::box_cloud(3000, {1, 0.7, 0.1})},
                                                    {"needle", shapes::box_cloud(3000, {1, 0.05, 0.05})}};
    constexpr int kCounts[] = {4, 17, 100,
                               501};  // all pairs of two of cloud, start mesh and number that fit in
    int run = 0;
    for (const auto& cloud : clouds) {
        for (const int start : {kShell, kTetrahedron}) {
            const int vertices = kCounts[(run + run / 4) % 4];
            ++run;
            SCOPED_TRACE(testing::Message() << cloud.first << ", start " << start << ", " << vertices);
            const NeuralMesh mesh = learn_exactly(cloud.second, with_target(vertices, start));
            EXPECT_GT(enclosed_volume(mesh), 0);
        }
    }
}

TEST(Reconstruct, CanBeCancelledAtAnyTime) {
    // From the shell, the network grows to more than 300 vertices.
    const TargetSpace target = target_of(shapes::sphere_cloud(12000));
    for (const int start : {kShell, kTetrahedron}) {
        Watch all;
        reconstruct(target, with_target(300, start), all);
        for (int patience = 0; patience < all.calls; patience += std::max(1, all.calls / 5)) {
            SCOPED_TRACE(testing::Message()
                         << "start " << start << ", after " << patience << " of " << all.calls);
            Watch watch(patience);
            const NeuralMesh mesh = reconstruct(target, with_target(300, start), watch);
            EXPECT_EQ(mesh.report.stop_reason, StopReason::cancelled);
            EXPECT_LE(watch.calls, patience + 3);
            EXPECT_LE(mesh.report.vertices, 300);
            expect_sound(mesh);
        }
    }
}

struct HostileCloud {
    const char* name;
    Cloud cloud;
    int surface = kAutomatic;
};

/// Curves have a closed surface around them if it is asked for, and else none.
std::vector<HostileCloud> hostile_clouds() {
    Cloud two = shapes::sphere_cloud(1000);
    for (std::size_t i = 0; i < two.size(); ++i)
        two[i] = two[i] * 0.001 + vcg::Point3d(i % 2 == 0 ? 1 : -1, 0, 0);
    Cloud outlier = shapes::sphere_cloud(1000);
    outlier.push_back({1e5, 0, 0});
    Cloud doubled = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
    for (int i = 0; i < 8; ++i) doubled.insert(doubled.end(), doubled.begin(), doubled.end());
    Cloud cross;
    for (int i = -50; i <= 50; ++i)
        for (int axis = 0; axis < 3; ++axis) {
            vcg::Point3d p(0, 0, 0);
            p[axis] = i;
            cross.push_back(p);
        }
    Cloud thin = shapes::box_cloud(1000, {1, 1e-5, 1e-5});
    return {{"four points", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
            {"four points in a plane", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}},
            {"plane", shapes::plane_cloud(1000)},
            {"two small clusters", two},
            {"one far outlier", outlier},
            {"five points, many times", doubled},
            {"three crossing lines", cross, kClosedSurface},
            {"almost a line", thin, kClosedSurface}};
}

TEST(Reconstruct, HostileCloudsStillGiveTheExactCount) {
    int start = kTetrahedron;
    for (const HostileCloud& hostile : hostile_clouds()) {
        start = start == kShell ? kTetrahedron : kShell;
        SCOPED_TRACE(testing::Message() << hostile.name << ", start " << start);
        Settings settings = with_target(200, start);
        settings.surface = hostile.surface;
        expect_exact(learn(hostile.cloud, settings), settings);
    }
}

}  // namespace neuralmesh::hostile_runs_test
