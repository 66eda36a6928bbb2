// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The same input gives the same bytes, whatever the threads; position and scale of the cloud do not matter.
#include "tests/unit/support/open_shapes.h"
#include "tests/unit/support/runs.h"

namespace neuralmesh::determinism_test {

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

void expect_same(const NeuralMesh& a, const NeuralMesh& b) {
    EXPECT_TRUE(same_bytes(a.positions, b.positions));
    EXPECT_TRUE(same_bytes(a.faces, b.faces));
    EXPECT_TRUE(same_bytes(a.counters, b.counters));
    EXPECT_TRUE(same_bytes(a.features, b.features));
    EXPECT_EQ(a.report.signals, b.report.signals);
    EXPECT_EQ(a.report.rms_error, b.report.rms_error);
    EXPECT_EQ(a.report.mean_counter, b.report.mean_counter);
}

void expect_same_with_threads(const Cloud& cloud, Settings settings) {
    settings.threads = 1;
    const NeuralMesh first = learn(cloud, settings);
    settings.threads = 3;
    expect_same(first, learn(cloud, settings));
}

TEST(Determinism, SameSeedSameBytesWhateverTheThreads) {
    for (const Settings& settings : variants())
        expect_same_with_threads(shapes::sphere_cloud(1500, 0.01), settings);
    expect_same_with_threads(shapes::uneven_sphere_cloud(5000, 20, 0.01), with_target(500));
    const Cloud two = shapes::two_sphere_cloud(10000, 3);
    Settings apart = with_target(1500, kTetrahedron);
    apart.learn_topology = true;
    EXPECT_EQ(learn(two, apart).report.components, 2);
    expect_same_with_threads(two, apart);
}

/// From 3,000 vertices on, each thread has its own region of space.
TEST(Determinism, SameBytesWhereThreadsShareTheNetwork) {
    Settings settings = with_target(5000);
    settings.signals_per_split = 40;
    settings.min_wins_per_split = 10;
    settings.settling_signals_per_vertex = 20;
    settings.fit_to_points = false;
    expect_same_with_threads(shapes::torus_cloud(20000, 0.005), settings);
    settings = with_target(3000);
    settings.surface = kOpenSurface;
    settings.signals_per_split = 40;
    settings.min_wins_per_split = 10;
    settings.settling_signals_per_vertex = 5;
    expect_same_with_threads(open_shapes::cases()[4].cloud, settings);
}

TEST(Determinism, AnotherSeedGivesAnotherMesh) {
    const Cloud cloud = shapes::sphere_cloud(1500);
    for (Settings settings : variants()) {
        const NeuralMesh first = learn(cloud, settings);
        settings.random_seed = 2;
        EXPECT_FALSE(same_bytes(first.positions, learn(cloud, settings).positions));
    }
}

TEST(Determinism, PlaceAndScaleDoNotMatter) {
    // Dyadic coordinates, moved and scaled by powers of two: exact in double.
    Cloud cloud = shapes::box_cloud(1500);
    for (vcg::Point3d& p : cloud)
        for (int k = 0; k < 3; ++k) p[k] = std::round(p[k] * 0x1p20) * 0x1p-20;
    Cloud moved = cloud;
    for (vcg::Point3d& p : moved) p = p * 0x1p10 + vcg::Point3d(0x1p24, -0x1p20, 0x1p22);
    for (const Settings& settings : variants()) {
        const NeuralMesh here = learn(cloud, settings);
        const NeuralMesh there = learn(moved, settings);
        EXPECT_TRUE(same_bytes(here.faces, there.faces));
        EXPECT_TRUE(same_bytes(here.counters, there.counters));
        ASSERT_EQ(here.positions.size(), there.positions.size());
        for (std::size_t i = 0; i < here.positions.size(); ++i) {
            const vcg::Point3d back = (there.positions[i] - vcg::Point3d(0x1p24, -0x1p20, 0x1p22)) * 0x1p-10;
            ASSERT_LT((back - here.positions[i]).Norm(), 1e-11);
        }
    }
}

}  // namespace neuralmesh::determinism_test
