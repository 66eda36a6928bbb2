// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// How long each part of a whole run takes, over vertices and threads: from one report of progress to the
// next, by the text of the first. The clouds are points of a bumpy torus. The largest rows take minutes.
#include <benchmark/benchmark.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "vcg_core/reconstruct.h"

namespace {

using namespace neuralmesh;

enum Part : std::size_t { start_mesh, landing, growth, settling, untangling, reduction, rounds, end };
constexpr std::array<const char*, end> kNames{"start_mesh", "landing",   "growth", "settling",
                                              "untangling", "reduction", "rounds"};

TargetSpace bumpy_torus(std::size_t points) {
    constexpr double kTwoPi = 6.283185307179586;
    return TargetSpace::points(points, [](std::size_t i) {
        Random random(i);
        const double u = kTwoPi * static_cast<double>(random.unit());
        const double v = kTwoPi * static_cast<double>(random.unit());
        const double tube = 0.4 + 0.03 * std::sin(8 * u) * std::cos(5 * v);
        const double ring = 1 + tube * std::cos(v);
        return vcg::Point3d(ring * std::cos(u), ring * std::sin(u), tube * std::sin(v));
    });
}

/// Sums the time of each part.
class PartTimes : public Progress {
public:
    bool operator()(double /*fraction*/, const char* text) override {
        stop();
        part_ = part_of(text, part_);
        return true;
    }
    /// Ends the part that is under way.
    void stop() {
        const Clock::time_point now = Clock::now();
        seconds[part_] += std::chrono::duration<double>(now - last_).count();
        last_ = now;
    }

    std::array<double, end> seconds{};

private:
    using Clock = std::chrono::steady_clock;

    /// The part that \p text announces, after \p last.
    static Part part_of(std::string_view text, Part last) {
        const auto begins = [&](std::string_view with) { return text.substr(0, with.size()) == with; };
        const auto contains = [&](std::string_view what) { return text.find(what) != text.npos; };
        if (begins("Start mesh: done")) return landing;
        if (begins("Start mesh")) return start_mesh;
        if (begins("Learning")) return growth;
        if (begins("Settling")) return last == landing ? landing : settling;
        if (contains("smoothing where")) return untangling;
        if (contains("vertices left of")) return reduction;
        if (contains("round ")) return rounds;
        return last;
    }

    Part part_ = start_mesh;
    Clock::time_point last_ = Clock::now();
};

/// Arguments: vertices, points, threads. The counters are seconds of the parts.
void run_parts(benchmark::State& state) {
    const TargetSpace target = bumpy_torus(static_cast<std::size_t>(state.range(1)));
    Settings settings;
    settings.target_vertices = static_cast<int>(state.range(0));
    settings.threads = static_cast<int>(state.range(2));
    std::array<double, end> seconds{};
    for (auto _ : state) {
        PartTimes times;
        benchmark::DoNotOptimize(reconstruct(target, settings, times));
        times.stop();
        for (std::size_t i = 0; i < end; ++i) seconds[i] += times.seconds[i];
    }
    for (std::size_t i = 0; i < end; ++i)
        state.counters[kNames[i]] = benchmark::Counter(seconds[i], benchmark::Counter::kAvgIterations);
}
BENCHMARK(run_parts)
    ->ArgsProduct({{500, 1000, 2000, 5000, 10000}, {100000}, {1, 2}})
    ->Args({100000, 1000000, 1})
    ->Args({100000, 1000000, 2})
    ->Unit(benchmark::kSecond)
    ->UseRealTime();
BENCHMARK(run_parts)
    ->Args({1000000, 10000000, 1})
    ->Args({1000000, 10000000, 2})
    ->Unit(benchmark::kSecond)
    ->UseRealTime()
    ->Iterations(1);

}  // namespace
