// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// How the cost grows with vertices, points and threads; and the time of whole runs. The clouds are
// points of a bumpy torus, generated one by one, so that only the core stores them. The largest rows take
// minutes.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <map>

#include "vcg_core/learning/learner.h"
#include "vcg_core/reconstruct.h"

namespace {

using namespace neuralmesh;

constexpr double kTwoPi = 6.283185307179586;

/// Point i of the torus, the same for any number of points.
vcg::Point3d point(std::uint64_t i) {
    Random random(i);
    const double u = kTwoPi * static_cast<double>(random.unit());
    const double v = kTwoPi * static_cast<double>(random.unit());
    const double tube = 0.4 + 0.03 * std::sin(8 * u) * std::cos(5 * v);
    const double ring = 1 + tube * std::cos(v);
    return {ring * std::cos(u), ring * std::sin(u), tube * std::sin(v)};
}

TargetSpace cloud(std::size_t points) {
    return TargetSpace::points(points, [](std::size_t i) { return point(i); });
}

/// A network of \p vertices vertices, learned once for all benchmarks, with few signals per split: its growth
/// is not measured.
const Network& learned(int vertices) {
    static std::map<int, Network> networks;
    const auto known = networks.find(vertices);
    if (known != networks.end()) return known->second;
    LearnerOptions options;
    options.grow_to = vertices;
    options.signals_per_split = 20;
    options.min_wins_per_split = 5;
    options.settling_signals_per_vertex = 0;
    constexpr float kA = 0.1F;
    const TargetSpace target = cloud(1000000);
    Learner learner(target, options,
                    Network({{kA, kA, kA}, {-kA, -kA, kA}, {-kA, kA, -kA}, {kA, -kA, -kA}},
                            {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}));
    NoProgress progress;
    learner.run(0, progress);
    return networks.emplace(vertices, learner.network()).first->second;
}

/// Whole Basic Steps, signals drawn and counters learned, on a mesh that does not grow.
void settle(benchmark::State& state, const TargetSpace& target, int vertices, int threads) {
    LearnerOptions options;
    options.grow_to = vertices;
    options.threads = threads;
    Learner learner(target, options, learned(vertices));
    NoProgress progress;
    learner.settle(1, progress);  // into memory order and into the caches
    const std::int64_t before = learner.signals();
    for (auto _ : state) learner.settle(1, progress);
    const std::int64_t signals = learner.signals() - before;
    state.SetItemsProcessed(signals);
    state.counters["ns_per_signal"] = benchmark::Counter(
        static_cast<double>(signals) * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// Arguments: vertices, threads. A million points.
void signals_by_vertices(benchmark::State& state) {
    static const TargetSpace target = cloud(1000000);
    settle(state, target, static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
}
BENCHMARK(signals_by_vertices)
    ->ArgsProduct({{1000, 10000, 100000, 1000000}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// Argument: points. 10,000 vertices, one thread.
void signals_by_points(benchmark::State& state) {
    const auto points = static_cast<std::size_t>(state.range(0));
    const TargetSpace target = cloud(points);
    state.counters["bytes_per_point"] =
        static_cast<double>(target.positions().capacity() * sizeof(vcg::Point3f)) /
        static_cast<double>(points);
    settle(state, target, 10000, 1);
}
BENCHMARK(signals_by_points)->Arg(100000)->Arg(1000000)->Arg(10000000)->Unit(benchmark::kMillisecond);

class Counting : public Progress {
public:
    bool operator()(double, const char*) override {
        ++calls;
        return true;
    }
    std::int64_t calls = 0;
};

/// Default runs, shell and fit included; arguments: vertices, points.
void whole_run(benchmark::State& state) {
    const TargetSpace target = cloud(static_cast<std::size_t>(state.range(1)));
    Settings settings;
    settings.target_vertices = static_cast<int>(state.range(0));
    Counting progress;
    for (auto _ : state) benchmark::DoNotOptimize(reconstruct(target, settings, progress));
    state.counters["progress_calls"] =
        benchmark::Counter(static_cast<double>(progress.calls), benchmark::Counter::kAvgIterations);
}
BENCHMARK(whole_run)
    ->Args({1000, 200000})
    ->Args({10000, 200000})
    ->Args({100000, 1000000})
    ->Unit(benchmark::kSecond)
    ->UseRealTime();
BENCHMARK(whole_run)->Args({1000000, 10000000})->Unit(benchmark::kSecond)->UseRealTime()->Iterations(1);

}  // namespace
