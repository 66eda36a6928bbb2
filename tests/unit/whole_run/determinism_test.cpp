// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The same input gives the same bytes, whatever the threads; position and scale of the cloud do not matter.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/unit/support/shapes.h"
#include "tests/unit/support/soundness.h"
#include "vcg_core/reconstruct.h"

namespace neuralmesh {
namespace {

NeuralMesh learn(const shapes::Cloud& cloud, const Settings& settings) {
    NoProgress progress;
    return reconstruct(soundness::target_of(cloud), settings, progress);
}

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

/// Both start meshes, with and without fit, both utility counters; and the defaults.
std::vector<Settings> variants() {
    std::vector<Settings> result;
    for (int i = 0; i < 4; ++i) {
        Settings settings;
        settings.target_vertices = 300;
        settings.start_mesh = (i & 1) != 0 ? kTetrahedron : kShell;
        settings.fit_to_points = (i & 2) != 0;
        settings.utility_counter = i == 1 || i == 2 ? kSignalCount : kNormalVariation;
        result.push_back(settings);
    }
    // Few vertices, so that the network grows to more and the fit removes some.
    result.emplace_back();
    result.back().target_vertices = 60;
    return result;
}

void expect_same_with(const std::vector<int>& numbers_of_threads, const shapes::Cloud& cloud,
                      Settings settings) {
    settings.threads = 1;
    const NeuralMesh first = learn(cloud, settings);
    for (const int threads : numbers_of_threads) {
        SCOPED_TRACE(threads);
        settings.threads = threads;
        expect_same(first, learn(cloud, settings));
    }
}

TEST(Determinism, SameSeedSameBytesWhateverTheThreads) {
    for (const Settings& settings : variants())
        expect_same_with({1, 3, 0}, shapes::sphere_cloud(1500, 0.01), settings);
}

/// From 3,000 vertices on, each thread has its own region of space.
TEST(Determinism, SameBytesWhereThreadsShareTheNetwork) {
    Settings settings;
    settings.target_vertices = 5000;
    settings.signals_per_split = 40;
    settings.min_wins_per_split = 10;
    settings.settling_signals_per_vertex = 20;
    settings.fit_to_points = false;
    expect_same_with({2, 3, 8}, shapes::torus_cloud(20000, 0.005), settings);
}

/// Adds \p values to \p hash by FNV-1a.
template <class T>
void hash_bytes(const std::vector<T>& values, std::uint64_t& hash) {
    const char* bytes = reinterpret_cast<const char*>(values.data());
    for (std::size_t i = 0; i < values.size() * sizeof(T); ++i)
        hash = (hash ^ static_cast<std::uint8_t>(bytes[i])) * 0x100000001b3U;
}

std::string line_for(const std::string& run, const NeuralMesh& mesh) {
    std::uint64_t hash = 0xcbf29ce484222325U;
    hash_bytes(mesh.positions, hash);
    hash_bytes(mesh.faces, hash);
    hash_bytes(mesh.counters, hash);
    hash_bytes(mesh.features, hash);
    std::ostringstream line;
    line << run << ' ' << mesh.report.signals << ' ' << std::hex << hash << '\n';
    return line.str();
}

/// An open surface, and a closed one with stray points.
std::string runs_on_scans() {
    Settings settings;
    settings.target_vertices = 200;
    settings.select_by = kFeatureCounter;
    shapes::Cloud bowl;
    for (const vcg::Point3d& p : shapes::sphere_cloud(4000, 0.01))
        if (p[2] < 0.25) bowl.push_back(p);
    const NeuralMesh open = learn(bowl, settings);
    EXPECT_EQ(open.report.boundary_loops, 1);
    shapes::Cloud dusty = shapes::sphere_cloud(3000, 0.01);
    Random random(2);
    for (int i = 0; i < 60; ++i) dusty.push_back(shapes::in_cube(random) * 2);
    const NeuralMesh cleaned = learn(dusty, settings);
    EXPECT_GT(cleaned.report.outliers, 30);
    return line_for("bowl", open) + line_for("dusty", cleaned);
}

/// One line for each run on noisy, sharp and flat clouds with variants(), and those of runs_on_scans(). The
/// clouds need no function of the mathematics library, whose results may differ between machines.
std::string recorded_runs() {
    std::string lines;
    const std::pair<const char*, shapes::Cloud> clouds[] = {{"sphere", shapes::sphere_cloud(1500, 0.01)},
                                                            {"box", shapes::box_cloud(1500, {1, 0.7, 0.3})},
                                                            {"sheet", shapes::plane_cloud(1500)}};
    for (const auto& [name, cloud] : clouds) {
        int variant = 0;
        for (Settings settings : variants()) {
            settings.feature_measure = variant % 2 == 0 ? kCreaseMeasure : kFeatureCounter;
            settings.select_by = settings.feature_measure;
            lines += line_for(name + (' ' + std::to_string(variant++)), learn(cloud, settings));
        }
    }
    return lines + runs_on_scans();
}

/// For any compiler, optimisation and machine. NEURALMESH_RECORD=1 records the bytes after an intended
/// change.
TEST(Determinism, SameBytesAsRecorded) {
    const std::string runs = recorded_runs();
    if (std::getenv("NEURALMESH_RECORD") != nullptr) std::ofstream(NEURALMESH_RECORDED_BYTES) << runs;
    std::ostringstream recorded;
    recorded << std::ifstream(NEURALMESH_RECORDED_BYTES).rdbuf();
    EXPECT_EQ(runs, recorded.str())
        << "After an intended change of results, record them: see tests/README.md.";
}

TEST(Determinism, AnotherSeedGivesAnotherMesh) {
    const shapes::Cloud cloud = shapes::sphere_cloud(1500);
    for (Settings settings : variants()) {
        const NeuralMesh first = learn(cloud, settings);
        settings.random_seed = 2;
        EXPECT_FALSE(same_bytes(first.positions, learn(cloud, settings).positions));
    }
}

TEST(Determinism, PlaceAndScaleDoNotMatter) {
    // Dyadic coordinates, moved and scaled by powers of two: exact in double.
    shapes::Cloud cloud = shapes::box_cloud(1500);
    for (vcg::Point3d& p : cloud)
        for (int k = 0; k < 3; ++k) p[k] = std::round(p[k] * 0x1p20) * 0x1p-20;
    shapes::Cloud moved = cloud;
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

TEST(Determinism, RandomRepeatsItselfAndStaysInRange) {
    Random a(1);
    Random b(1);
    Random c(2);
    int differ = 0;
    for (int i = 0; i < 1000; ++i) {
        const std::uint32_t x = a.bits();
        EXPECT_EQ(x, b.bits());
        differ += x != c.bits() ? 1 : 0;
    }
    EXPECT_GT(differ, 990);
    for (const std::uint32_t n : {1U, 2U, 3U, 1000U, 0xffffffffU})
        for (int i = 0; i < 1000; ++i) EXPECT_LT(a.below(n), n);
    for (int i = 0; i < 1000; ++i) {
        const float u = a.unit();
        EXPECT_TRUE(u >= 0 && u < 1);
    }
}

}  // namespace
}  // namespace neuralmesh
