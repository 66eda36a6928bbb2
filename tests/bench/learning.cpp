// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Signals per second of the learning loop, on one thread and on two. The cloud is 200,000 points of a bumpy
// torus, made here.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "vcg_core/learning/learner.h"

namespace {

using namespace neuralmesh;

constexpr int kPoints = 200000;

const TargetSpace& cloud() {
    static const TargetSpace target = [] {
        Random random(7);
        std::vector<vcg::Point3d> points;
        for (int i = 0; i < kPoints; ++i) {
            const double u = 6.283185307179586 * random.unit();
            const double v = 6.283185307179586 * random.unit();
            const double tube = 0.4 + 0.03 * std::sin(8 * u) * std::cos(5 * v);
            const double ring = 1 + tube * std::cos(v);
            points.emplace_back(ring * std::cos(u), ring * std::sin(u), tube * std::sin(v));
        }
        return TargetSpace::points(points.size(), [&](std::size_t i) { return points[i]; });
    }();
    return target;
}

Network torus_start() {
    constexpr int kAround = 24, kAcross = 12;
    std::vector<vcg::Point3f> positions;
    std::vector<Triangle> faces;
    const auto id = [](int i, int j) { return (i % kAround) * kAcross + j % kAcross; };
    for (int i = 0; i < kAround; ++i)
        for (int j = 0; j < kAcross; ++j) {
            const double u = 6.283185307179586 * i / kAround, v = 6.283185307179586 * j / kAcross;
            positions.push_back(
                cloud().frame().inside({(1 + 0.4 * std::cos(v)) * std::cos(u),
                                        (1 + 0.4 * std::cos(v)) * std::sin(u), 0.4 * std::sin(v)}));
            faces.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
            faces.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
        }
    return Network(positions, faces);
}

/// A network of \p vertices vertices, learned once for all benchmarks.
const Network& learned(int vertices) {
    static std::map<int, Network> networks;
    auto it = networks.find(vertices);
    if (it == networks.end()) {
        LearnerOptions options;
        options.grow_to = vertices;
        options.settling_signals_per_vertex = 0;
        Learner learner(cloud(), options, torus_start());
        NoProgress progress;
        learner.run(0, progress);
        it = networks.emplace(vertices, learner.network()).first;
    }
    return it->second;
}

void per_signal(benchmark::State& state, std::int64_t signals) {
    state.SetItemsProcessed(signals);
    state.counters["ns_per_signal"] = benchmark::Counter(
        static_cast<double>(signals) * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// Whole Basic Steps on a mesh that does not grow, as it settles: signals drawn, counters learned. Arguments:
/// vertices, C_L, threads.
void basic_steps(benchmark::State& state) {
    LearnerOptions options;
    options.grow_to = static_cast<int>(state.range(0));
    options.smoothing_steps = static_cast<int>(state.range(1));
    options.threads = static_cast<int>(state.range(2));
    Learner learner(cloud(), options, learned(options.grow_to));
    NoProgress progress;
    learner.settle(1, progress);  // into memory order and into the caches
    const std::int64_t before = learner.signals();
    for (auto _ : state) learner.settle(1, progress);
    per_signal(state, learner.signals() - before);
}
BENCHMARK(basic_steps)
    ->ArgsProduct({{1000, 10000, 100000}, {5, 0}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// Growth from the start mesh, splits and collapses included; arguments: vertices, threads.
void growth(benchmark::State& state) {
    LearnerOptions options;
    options.grow_to = static_cast<int>(state.range(0));
    options.settling_signals_per_vertex = 0;
    options.threads = static_cast<int>(state.range(1));
    NoProgress progress;
    std::int64_t count = 0;
    for (auto _ : state) {
        Learner learner(cloud(), options, torus_start());
        learner.run(0, progress);
        count += learner.signals();
    }
    per_signal(state, count);
}
BENCHMARK(growth)->ArgsProduct({{1000, 10000, 100000}, {1, 2}})->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
