// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Many runs in one process: no block leaks, the process does not grow, and simultaneous runs in two threads
// give the same bytes as single ones.
#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <thread>

#include "tests/memory/allocations.h"
#include "tests/unit/support/soundness.h"

namespace neuralmesh {
namespace {

/// A text that is equal for equal results, and different for different ones.
std::string bytes_of(const NeuralMesh& mesh) {
    const auto raw = [](const auto& numbers) {
        return std::string(reinterpret_cast<const char*>(numbers.data()),
                           numbers.size() * sizeof(numbers[0]));
    };
    return raw(mesh.positions) + raw(mesh.faces) + raw(mesh.counters) + raw(mesh.features) +
           std::to_string(mesh.report.signals) + " " + std::to_string(mesh.report.rms_error);
}

std::string learn(const shapes::Cloud& cloud, const Settings& settings) {
    NoProgress progress;
    return bytes_of(reconstruct(soundness::target_of(cloud), settings, progress));
}

TEST(RepeatedRuns, LeakNothing) {
    const shapes::Cloud cloud = shapes::torus_cloud(500);
    Settings settings;
    settings.target_vertices = 100;
    settings.settling_signals_per_vertex = 0;
    long long before = 0;
    long long living = 0;
    constexpr int kWarmUp = 20;
    constexpr int kRuns = 30;
    for (int i = 0; i < kWarmUp + kRuns; ++i) {
        if (i == kWarmUp) {
            before = allocations::resident_bytes();
            living = allocations::living();
        }
        settings.start_mesh = i % 4 == 0 ? kShell : kTetrahedron;
        settings.random_seed = i;
        settings.threads = 1 + i % 2;
        learn(cloud, settings);
    }
    EXPECT_EQ(allocations::living(), living);
    const long long grown = allocations::resident_bytes() - before;
    RecordProperty("grown_bytes", std::to_string(grown));
    // The heap of the C library may keep ten kilobytes per run. Blocks of our own are counted above; this
    // finds other memory, such as the stacks of threads.
    EXPECT_LT(grown, kRuns * ((1 << 20) / 100)) << "bytes";
}

TEST(RepeatedRuns, TwoAtOnceGiveTheBytesOfOneAlone) {
    const shapes::Cloud clouds[] = {shapes::sphere_cloud(3000, 0.02), shapes::torus_cloud(3000)};
    Settings settings[2];
    settings[0].target_vertices = 300;
    settings[1].target_vertices = 400;
    settings[1].start_mesh = kTetrahedron;
    settings[1].feature_measure = kCreaseMeasure;
    const std::string alone[] = {learn(clouds[0], settings[0]), learn(clouds[1], settings[1])};
    ASSERT_NE(alone[0], alone[1]);
    for (int round = 0; round < 3; ++round) {
        std::string together[2];
        std::thread other([&] { together[0] = learn(clouds[0], settings[0]); });
        together[1] = learn(clouds[1], settings[1]);
        other.join();
        EXPECT_TRUE(together[0] == alone[0]);
        EXPECT_TRUE(together[1] == alone[1]);
    }
}

}  // namespace
}  // namespace neuralmesh
